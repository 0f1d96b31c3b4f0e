// The table of actions and the loop that finds the one a shortcut means.
#include "gui/actions.h"

#include <imgui.h>

#include "edit/camera_moves.h"
#include "edit/new_from_file.h"
#include "gui/action_functions.h"
#include "gui/key_codes.h"
#include "gui/move_dialog.h"
#include "gui/render_dialog.h"

namespace astrosplat {
namespace {

using Kind = Command::Kind;
using F = GuiFrame&;
using C = const GuiFrame&;

template <Kind kind>
void ask(F f) {
    request(f, kind);
}
template <Kind kind>
void ask_for_layer(F f) {
    request(f, kind, f.view.layer);
}

constexpr Shortcut plain(int code) { return {code, false, false}; }
constexpr Shortcut shift(int code) { return {code, false, true}; }
constexpr Shortcut ctrl(int code) { return {code, true, false}; }
constexpr Shortcut ctrl_shift(int code) { return {code, true, true}; }

/// The first of a group of a menu.
Action below_line(Action action) {
    action.line_above = true;
    return action;
}

/// Only the shortcut does it; again and again while it is held.
Action repeated(const char* label, int code, void (*run)(F)) {
    return {.menu = "", .label = label, .shortcut = plain(code), .run = run, .repeats = true};
}

/// Turns a flag of the view on and off.
template <auto flag>
Action flip(const char* menu, const char* label, Shortcut shortcut = {}) {
    return {.menu = menu,
            .label = label,
            .shortcut = shortcut,
            .run = [](F f) { f.view.*flag = !(f.view.*flag); },
            .checked = [](C f) { return f.view.*flag; }};
}

template <ViewKind kind>
Action view_from(const char* label, Shortcut shortcut = {}) {
    return {.menu = "View",
            .label = label,
            .shortcut = shortcut,
            .run = [](F f) { f.view.view = kind; },
            .checked = [](C f) { return f.view.view == kind; }};
}

template <RenderKind kind>
void render(F f) {
    open_render_dialog(f.document, f.view, kind);
}

template <CompareMode mode>
Action compare(const char* label) {
    return {.menu = "View",
            .label = label,
            .run = [](F f) { set_compare(f, mode); },
            .checked = [](C f) { return f.view.compare == mode; }};
}

/// A built-in shape, by its place in shape_labels.
template <Kind kind, std::size_t index>
Action shape(const char* menu) {
    return {menu, shape_labels[index], {}, [](F f) {
                f.requested.push_back({kind, {}, shape_names[index], 0});
            }};
}

template <std::int64_t side_px>
Action dome_master(const char* label) {
    return {"Camera/Dome master", label, {}, [](F f) { make_dome_master(f, side_px); }};
}

template <HandleTool tool>
Action handles(const char* label, int code) {
    return {.menu = "Layer",
            .label = label,
            .shortcut = plain(code),
            .run = toggle_handles<tool>,
            .enabled = has_layer,
            .checked = has_handles<tool>};
}

template <CameraMove move>
Action add_move() {
    return {"Camera/Add move",
            camera_move_names[static_cast<std::size_t>(move)],
            {},
            [](F f) { begin_move(f, move); },
            has_box};
}

const Action table[] = {
    {"File/New", "Empty scene", {}, new_empty_scene},
    shape<Kind::new_scene, 0>("File/New"),
    shape<Kind::new_scene, 1>("File/New"),
    shape<Kind::new_scene, 2>("File/New"),
    shape<Kind::new_scene, 3>("File/New"),
    shape<Kind::new_scene, 4>("File/New"),
    shape<Kind::new_scene, 5>("File/New"),
    shape<Kind::new_scene, 6>("File/New"),
    shape<Kind::new_scene, 7>("File/New"),
    {"File", "New from picture...", {}, ask<Kind::new_from_file>},
    {"File", "Open...", ctrl('O'), ask<Kind::open>},
    {"File", "Open the demo", {}, ask<Kind::open_demo>},
    below_line({"File", "Save", ctrl('S'), ask<Kind::save>}),
    {"File", "Save as...", ctrl_shift('S'), ask<Kind::save_as>},
    {"File", "Reload", {}, ask<Kind::reload>, has_file},
    below_line({"File", "Import as a layer...", {}, ask<Kind::import_file>}),
    {"File", "Import camera...", {}, ask<Kind::import_camera>},
    {"File", "Export camera...", {}, ask<Kind::export_camera>},
    {"File", "Export look...", {}, ask<Kind::save_look>, has_layer},
    {"File", "Apply look...", {}, ask<Kind::apply_look>, has_layer},
    below_line({"File", "Save the frame as seen...", {}, ask<Kind::save_view>}),
    {"File", "Screenshot of the window...", plain(key_code::f12), ask<Kind::screenshot>},
    below_line({"File", "Quit", ctrl('Q'), ask<Kind::quit>}),

    {"Edit", "Undo", ctrl('Z'), undo, can_undo, nullptr, undo_label, false, true},
    {"Edit", "Redo", ctrl_shift('Z'), redo, can_redo, nullptr, redo_label, false, true, ctrl('Y')},
    below_line({"Edit", "Store as B", plain('B'), ask<Kind::store_b>}),
    {"Edit", "Take snapshot", {}, take_snapshot},
    below_line(flip<&ViewState::settings_open>("Edit", "Settings...")),

    view_from<ViewKind::camera>("Camera", plain(key_code::n0)),
    view_from<ViewKind::free>("Free"),
    view_from<ViewKind::front>("Front", plain(key_code::n1)),
    view_from<ViewKind::side>("Side", plain(key_code::n3)),
    view_from<ViewKind::top>("Top", plain(key_code::n7)),
    {"View", "Three-quarter", plain(key_code::n9), three_quarter, has_box},
    below_line({"View", "Frame layer", plain('F'), ask_for_layer<Kind::frame_layer>, has_layer}),
    {"View", "Frame all", plain(key_code::home), ask<Kind::frame_all>},
    {"View", "Output pixels 1:1", plain('Z'), toggle_one_to_one, nullptr, is_one_to_one},
    below_line({"View", "Swap A and B", plain(key_code::tab), swap_a_b}),
    compare<CompareMode::wipe>("Wipe A | B"),
    {"View", "Blink", plain('X'), toggle_blink, nullptr, blinks},
    compare<CompareMode::difference>("Difference"),
    {"View", "Compare with the reference, not B", shift('B'), toggle_compare_with_reference, nullptr,
     compares_with_reference},
    {"View", "Front against its picture", plain('D'), toggle_front, has_front, shows_front},
    below_line({"View", "Load reference...", {}, ask<Kind::set_reference>}),
    {"View", "Place reference", plain('P'), toggle_placing, has_reference, is_placing},
    {"View", "Align reference to this view", {}, ask<Kind::align_reference>, has_reference},
    below_line(flip<&ViewState::gate>("View", "Gate", plain('G'))),
    flip<&ViewState::safe_areas>("View", "Safe areas"),
    flip<&ViewState::camera_path>("View", "Camera path"),
    flip<&ViewState::selected_box>("View/Guides", "Box of the selected layer"),
    flip<&ViewState::all_boxes>("View/Guides", "Boxes of all layers"),
    flip<&ViewState::grid>("View/Guides", "Grid"),
    flip<&ViewState::axes>("View/Guides", "Axes"),
    flip<&ViewState::settle>("View", "Settle to the final frame"),
    below_line(flip<&ViewState::timeline_open>("View", "Timeline")),
    flip<&ViewState::snapshots_open>("View", "Snapshots"),
    flip<&ViewState::panels>("View", "Panels", plain(key_code::f11)),

    {"Layer", "Add...", {}, ask<Kind::import_file>},
    shape<Kind::add_shape, 0>("Layer/Add shape"),
    shape<Kind::add_shape, 1>("Layer/Add shape"),
    shape<Kind::add_shape, 2>("Layer/Add shape"),
    shape<Kind::add_shape, 3>("Layer/Add shape"),
    shape<Kind::add_shape, 4>("Layer/Add shape"),
    shape<Kind::add_shape, 5>("Layer/Add shape"),
    shape<Kind::add_shape, 6>("Layer/Add shape"),
    shape<Kind::add_shape, 7>("Layer/Add shape"),
    {"Layer", "Duplicate", {}, duplicate_selected_layer, has_layer},
    {"Layer", "Remove", {}, remove_selected_layer, has_layer},
    below_line({"Layer", "Visible", plain('H'), hide_layer, has_layer, layer_visible}),
    {"Layer", "Solo", plain('S'), solo_layer, has_layer, layer_solo},
    below_line({"Layer", "Move up", {}, move_layer_up, can_move_up}),
    {"Layer", "Move down", {}, move_layer_down, can_move_down},
    below_line(handles<HandleTool::move>("Move in the view", 'W')),
    handles<HandleTool::rotate>("Rotate in the view", 'E'),
    handles<HandleTool::scale>("Scale in the view", 'R'),
    below_line({"Layer", "Regenerate", {}, ask_for_layer<Kind::regenerate>, layer_stale}),

    {"Camera", "Key camera here", {}, set_camera_keyframe_here},
    {"Camera", "Camera from this view", {}, camera_from_view, in_free_view},
    {"Camera", "Move the target in the view", {}, move_camera_target, nullptr, moves_camera_target},
    add_move<CameraMove::orbit>(),
    add_move<CameraMove::fly_in>(),
    add_move<CameraMove::face_on_to_edge_on>(),
    dome_master<1024>("1024 px"),
    dome_master<2048>("2048 px"),
    dome_master<4096>("4096 px"),
    dome_master<8192>("8192 px"),
    below_line(flip<&ViewState::lock_to_camera>("Camera", "Lock to camera")),

    {"Render", "Frame...", ctrl('R'), render<RenderKind::frame>},
    {"Render", "Frames...", ctrl_shift('R'), render<RenderKind::range>},
    {"Render", "Movie...", {}, render<RenderKind::movie>, has_ffmpeg, nullptr, movie_label},
    below_line(flip<&ViewState::queue_open>("Render", "Queue...")),
    {"Render", "Cancel", {}, ask<Kind::cancel_render>, has_job},
    below_line({"Render", "Copy batch command", {}, ask<Kind::copy_batch_command>}),

    flip<&ViewState::help_open>("Help", "Shortcuts", plain(key_code::f1)),
    flip<&ViewState::log_open>("Help", "Log"),

    flip<&ViewState::playing>("", "Play or pause", plain(key_code::space)),
    repeated("Next frame", key_code::right, next_frame),
    repeated("Previous frame", key_code::left, previous_frame),
    repeated("Next keyframe", key_code::up, next_keyframe),
    repeated("Previous keyframe", key_code::down, previous_keyframe),
    {"", "Play from this frame on", plain('I'), set_in_point},
    {"", "Play up to this frame", plain('O'), set_out_point},
    {"", "Play all frames", shift('I'), clear_in_and_out},
    {"", "First frame", ctrl(key_code::left), first_frame},
    {"", "Last frame", ctrl(key_code::right), last_frame},
    {"", "Keyframe of the hovered row, or the camera", plain('K'), set_keyframe_here},
    {"", "Remove that keyframe", shift('K'), remove_keyframe_here},
    {"", "Cancel what runs, close what is open", plain(key_code::escape), cancel},
};

bool pressed(const Shortcut& s, bool repeats) {
    const ImGuiIO& io = ImGui::GetIO();
    if (s.code == 0 || io.KeyAlt || io.KeyCtrl != s.ctrl || io.KeyShift != s.shift) return false;
    return key_pressed(s.code, repeats);
}

bool pressed(const Action& action) {
    return pressed(action.shortcut, action.repeats) || pressed(action.also, action.repeats);
}

}  // namespace

std::span<const Action> actions() { return table; }

std::string shortcut_text(const Shortcut& s) {
    return std::string(s.ctrl ? "Ctrl+" : "") + (s.shift ? "Shift+" : "") + key_name(s.code);
}

void run_shortcuts(GuiFrame& frame) {
    for (const Action& action : actions())
        if (pressed(action) && (!action.enabled || action.enabled(frame))) action.run(frame);
}

}  // namespace astrosplat
