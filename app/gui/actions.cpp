// The table of actions, in the end, and what they do; the loop that finds the one a shortcut means.
#include "gui/parts.h"

#include <fmt/format.h>

#include "edit/edits.h"
#include "edit/layer_steps.h"
#include "edit/layers.h"
#include "edit/lying.h"
#include "edit/selection.h"
#include "edit/view_camera.h"
#include "scene/animate.h"
#include "scene/describe.h"

namespace astrosplat {

void copy_part(GuiFrame& f, CopiedKind kind, std::size_t layer) {
    ImGui::SetClipboardText(copied_text(f.document.scene(), kind, layer).c_str());
    constexpr std::array said{"The layer is copied, with its keyframes",
                              "The look is copied, with its keyframes",
                              "The camera is copied, with its keyframes"};
    request_text(f, Command::Kind::say, said[std::size_t(kind)]);
}

void paste_part(GuiFrame& f) {
    const char* const text = ImGui::GetClipboardText();
    const std::string copied = text ? text : "";
    constexpr std::array names{"Paste layer", "Paste look", "Paste camera"};
    const std::optional<CopiedKind> kind = copied_kind(copied);
    try_edit([&] {
        std::size_t layer = f.view.layer;
        f.document.edit(kind ? names[std::size_t(*kind)] : "Paste",
                        [&](Scene& scene) { layer = paste_text(scene, copied, layer); });
        f.view.layer = layer;
    });
}

void toggle_one_to_one(GuiFrame& f) {
    f.view.size = f.view.size == SizeMode::one_to_one ? SizeMode::fit : SizeMode::one_to_one;
    f.view.pan_px = {0.0, 0.0};
    f.view.zoom = 1.0;
}

void set_compare(GuiFrame& f, CompareMode mode) {
    f.view.compare = mode;
    if (!compares(f.view)) return;
    if (f.view.compare_with == CompareWith::reference) {
        if (!has_reference(f)) request(f, Command::Kind::set_reference);
    } else if (f.status.b_snapshot < 0) {
        request_text(f, Command::Kind::say, "Nothing is stored as B yet: the key B stores the look as it is");
    }
}

void compare_with(GuiFrame& f, CompareWith with) {
    f.view.compare_with = with;
    set_compare(f, f.view.compare);
}

bool compares_with_reference(const GuiFrame& f) { return f.view.compare_with == CompareWith::reference; }
bool has_reference(const GuiFrame& f) { return f.status.reference.has_value(); }

void toggle_placing(GuiFrame& f) {
    f.view.placing = !f.view.placing;
    if (f.view.placing) show_reference(f.view);
}

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

const std::string& selected_name(C f) { return f.document.scene().layers[f.view.layer].name; }

void edit(F f, const std::string& name, const std::function<void(Scene&)>& change) {
    try_edit([&] { f.document.edit(name, change); });
}

void go_to(F f, double frame) {
    const FrameRange range = shown_range(f.document.scene());
    f.view.frame = std::clamp(frame, range.first, range.last);
}

void undo(F f) {
    request_text(f, Kind::say, "Undone: " + f.document.undo_name());
    f.document.undo();
}
void redo(F f) {
    request_text(f, Kind::say, "Redone: " + f.document.redo_name());
    f.document.redo();
}
bool can_undo(C f) { return f.document.can_undo(); }
bool can_redo(C f) { return f.document.can_redo(); }
std::string undo_label(C f) { return can_undo(f) ? "Undo " + f.document.undo_name() : "Undo"; }
std::string redo_label(C f) { return can_redo(f) ? "Redo " + f.document.redo_name() : "Redo"; }
void take_snapshot(F f) {
    request(f, Kind::take_snapshot);
    f.view.snapshots_open = true;
}

bool has_file(C f) { return !f.document.file().empty(); }
bool has_layer(C f) { return f.view.layer < f.document.scene().layers.size(); }
template <CopiedKind kind>
void copy(F f) {
    copy_part(f, kind, f.view.layer);
}
void paste(F f) { paste_part(f); }
bool has_box(C f) { return !f.status.box.empty(); }
bool has_job(C f) { return running_job(f.status) != nullptr; }
bool has_ffmpeg(C f) { return f.status.has_ffmpeg; }
std::string movie_label(C f) { return has_ffmpeg(f) ? "Movie..." : "Movie... (needs ffmpeg)"; }

void three_quarter(F f) {
    const double aspect =
        f.status.viewport_aspect > 0.0 ? f.status.viewport_aspect : aspect_of(f.document.scene().output);
    f.view.free = three_quarter_view(f.view.free, f.status.box, aspect);
    f.view.view = ViewKind::free;
}
bool is_one_to_one(C f) { return f.view.size == SizeMode::one_to_one; }
void toggle_compare_with_reference(F f) {
    compare_with(f, compares_with_reference(f) ? CompareWith::b : CompareWith::reference);
}
template <CompareMode mode>
bool compares_by(C f) {
    return f.view.compare == mode;
}
template <CompareMode mode>
void toggle_compare(F f) {
    set_compare(f, compares_by<mode>(f) ? CompareMode::a : mode);
}
bool is_placing(C f) { return f.view.placing; }
bool has_front(C f) { return f.status.front.has_value(); }

template <void (*change)(Document&, ViewState&, std::size_t)>
void edit_selected(F f) {
    try_edit([&] { change(f.document, f.view, f.view.layer); });
}
template <int by>
void move_selected(F f) {
    try_edit([&] { move_layer(f.document, f.view, f.view.layer, f.view.layer + by); });
}
void hide_layer(F f) {
    try_edit([&] { toggle_visible(f.document, f.view, f.view.layer); });
}
void solo_layer(F f) { toggle_solo(f.view, selected_name(f)); }
bool layer_visible(C f) { return has_layer(f) && is_visible(f.document.scene(), f.view.layer, f.view.frame); }
bool layer_solo(C f) { return has_layer(f) && f.view.solo.count(selected_name(f)) > 0; }
bool can_move_up(C f) { return has_layer(f) && f.view.layer > 0; }
bool can_move_down(C f) { return f.view.layer + 1 < f.document.scene().layers.size(); }
bool layer_stale(C f) { return f.view.layer < f.status.layers.size() && f.status.layers[f.view.layer].stale; }

bool in_free_view(C f) { return f.view.view == ViewKind::free; }
/// A square fisheye of half the sphere: what planetariums project.
template <std::int64_t side_px>
void make_dome_master(F f) {
    edit(f, fmt::format("Dome master of {} px", side_px), [](Scene& scene) {
        scene.output.width = scene.output.height = side_px;
        scene.camera.projection = Projection::fisheye;
        scene.camera.fisheye_fov = 180.0;
    });
    f.view.safe_areas = true;  // a master has its zone to keep titles in
}

/// Keys the camera that is seen, as the panel's button does.
void set_camera_keyframe_here(F f) {
    edit(f, "Set camera keyframe",
         [&](Scene& scene) { set_keyframe_of_seen_camera(scene, f.view, f.status); });
}
void camera_from_view(F f) {
    const auto is_cameras = [](const Track& track) { return track.key.is_below("camera"); };
    if (std::ranges::any_of(f.document.scene().animation, is_cameras)) return set_camera_keyframe_here(f);
    edit(f, "Camera from view", [&](Scene& scene) { scene.camera = seen_camera(scene, f.view, f.status); });
}

void next_frame(F f) { go_to(f, std::floor(f.view.frame) + 1.0); }
void previous_frame(F f) { go_to(f, std::ceil(f.view.frame) - 1.0); }
void next_keyframe(F f) { f.view.frame = frame_of_next_keyframe(f.document.scene(), f.view.frame); }
void previous_keyframe(F f) { f.view.frame = frame_of_previous_keyframe(f.document.scene(), f.view.frame); }
void first_frame(F f) { f.view.frame = frame_range(f.document.scene().output).first; }
void last_frame(F f) { f.view.frame = frame_range(f.document.scene().output).last; }

void set_in_point(F f) {
    f.view.play_first = f.view.frame;
    if (f.view.play_last && *f.view.play_last <= f.view.frame) f.view.play_last.reset();
}
void set_out_point(F f) {
    f.view.play_last = f.view.frame;
    if (f.view.play_first && *f.view.play_first >= f.view.frame) f.view.play_first.reset();
}
void clear_in_and_out(F f) {
    f.view.play_first.reset();
    f.view.play_last.reset();
}

void set_keyframe_here(F f) {
    const std::string key = f.view.hovered_parameter;
    if (key.empty()) return set_camera_keyframe_here(f);
    Scene still = scene_at(f.document.scene(), f.view.frame);
    const Description description = describe(still);
    const Parameter* parameter = find_parameter(description, key);
    const Value value = parameter ? parameter->get() : Value();
    edit(f, "Set keyframe of " + key, [&](Scene& scene) { set_keyframe(scene, key, f.view.frame, value); });
}
void remove_keyframe_here(F f) {
    const std::string key = f.view.hovered_parameter;
    edit(f, key.empty() ? "Remove camera keyframes" : "Remove keyframe of " + key, [&](Scene& scene) {
        const std::vector<Track> tracks = scene.animation;  // one that becomes empty goes
        for (const Track& track : tracks)
            if (key.empty() ? track.key.is_below("camera") : track.key == key)
                remove_keyframe(scene, track.key, f.view.frame);
    });
}

/// Handles in the view: on for this tool, or off where it is at work.
void choose_handles(F f, HandleTool tool) {
    ViewState& view = f.view;
    const bool of_layer = view.handle_target != HandleTarget::camera_target;
    view.tool = view.tool == tool && of_layer ? HandleTool::none : tool;
    if (!of_layer) view.handle_target = HandleTarget::layer;
}

bool moves_camera_target(C f) {
    return f.view.tool == HandleTool::move && f.view.handle_target == HandleTarget::camera_target;
}
/// Of the scene's camera, which gets a place of its own where it has none.
void move_camera_target(F f) {
    const bool was_on = moves_camera_target(f);
    f.view.tool = was_on ? HandleTool::none : HandleTool::move;
    f.view.handle_target = was_on ? HandleTarget::layer : HandleTarget::camera_target;
    const CameraParams& camera = f.document.scene().camera;
    if (was_on || (camera.position && !camera.rotation)) return;
    if (camera.rotation)
        return request_text(f, Kind::say, "This camera looks along camera.rotation, which has no target");
    ViewState through_camera;
    through_camera.frame = f.view.frame;
    edit(f, "Place of the camera",
         [&](Scene& scene) { scene.camera = seen_camera(scene, through_camera, f.status); });
}

/// The camera has a focus.
bool focuses(C f) {
    const CameraParams camera = scene_at(f.document.scene(), f.view.frame).camera;
    return camera.projection == Projection::perspective && camera.f_number > 0.0;
}
std::string focus_label(C f) {
    return focuses(f) ? "Pick the focus in the view" : "Pick the focus in the view (needs an f-number)";
}

void cancel(F f) {
    if (!f.view.movie.empty()) {
        f.view.movie.clear();
    } else if (f.view.help_open || f.view.log_open) {
        f.view.help_open = f.view.log_open = false;
    } else if (is_placing(f)) {
        toggle_placing(f);
    } else if (f.view.picking_focus) {
        f.view.picking_focus = false;
    } else if (f.view.select != SelectTool::none) {
        f.view.select = SelectTool::none;
    } else if (f.view.tool != HandleTool::none) {
        f.view.tool = HandleTool::none;
        f.view.handle_target = HandleTarget::layer;
    } else if (f.view.lying) {
        f.view.lying = false;
    } else if (f.view.selected_box) {
        f.view.selected_box = false;
    } else if (f.status.starting) {
        request(f, Kind::cancel_start);
    } else if (has_job(f)) {
        request(f, Kind::cancel_render);
    } else {
        for (std::size_t i = 0; i < f.status.layers.size(); ++i)
            if (f.status.layers[i].loading) request(f, Kind::cancel_load, i);
    }
}

// Rows of the table.

constexpr Shortcut plain(int code) { return {code, false, false}; }
constexpr Shortcut shift(int code) { return {code, false, true}; }
constexpr Shortcut ctrl(int code) { return {code, true, false}; }
constexpr Shortcut ctrl_shift(int code) { return {code, true, true}; }

/// The first of a group of a menu.
Action below_line(Action action) {
    action.line_above = true;
    return action;
}

/// Of two shortcuts.
Action also(Action action, Shortcut other) {
    action.also = other;
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

template <Inspection::Channel channel>
Action look_at(const char* label, Shortcut shortcut = {}) {
    return {.menu = "View/Channels and scopes",
            .label = label,
            .shortcut = shortcut,
            .run =
                [](F f) {
                    Inspection::Channel& seen = f.view.inspection.channel;
                    seen = seen == channel ? Inspection::Channel::color : channel;
                },
            .checked = [](C f) { return f.view.inspection.channel == channel; }};
}

template <Scope scope>
Action see_scope() {
    constexpr auto i = static_cast<std::size_t>(scope);
    return {.menu = "View/Channels and scopes",
            .label = scope_names[i],
            .run =
                [](F f) {
                    f.view.scopes[i] = !(f.view.scopes_open && f.view.scopes[i]);
                    f.view.scopes_open = f.view.scopes != std::array<bool, scope_count>{};
                },
            .checked = [](C f) { return f.view.scopes_open && f.view.scopes[i]; }};
}
/// Those that were open last.
void toggle_scopes(F f) {
    f.view.scopes_open = !f.view.scopes_open;
    if (f.view.scopes == std::array<bool, scope_count>{}) f.view.scopes.fill(true);
}

template <CompareMode mode>
Action compare(const char* label) {
    return {.menu = "View",
            .label = label,
            .run = [](F f) { set_compare(f, mode); },
            .checked = compares_by<mode>};
}

/// A built-in shape, by its place in shape_labels.
template <Kind kind, std::size_t index>
Action shape(const char* menu) {
    return {menu, shape_labels[index], {}, [](F f) { request_text(f, kind, shape_names[index]); }};
}

template <HandleTool tool>
Action handles(const char* label, int code) {
    return {
        .menu = "Layer",
        .label = label,
        .shortcut = plain(code),
        .run = [](F f) { choose_handles(f, tool); },
        .enabled = has_layer,
        .checked =
            [](C f) { return f.view.tool == tool && f.view.handle_target != HandleTarget::camera_target; }};
}

template <SelectTool tool>
Action select_by(const char* label, int code) {
    return {.menu = "Layer/Select",
            .label = label,
            .shortcut = plain(code),
            .run = [](F f) { f.view.select = f.view.select == tool ? SelectTool::none : tool; },
            .enabled = has_layer,
            .checked = [](C f) { return f.view.select == tool; }};
}

template <SelectionFate fate>
Action selected_parts(const char* label) {
    return {.menu = "Layer/Select",
            .label = label,
            .run = [](F f) { f.view.selection = fate; },
            .checked = [](C f) { return f.view.selection == fate; }};
}

void scale_brush(F f, float by) { f.view.brush_px = std::clamp(f.view.brush_px * by, 2.0f, 400.0f); }
bool brushes(C f) { return f.view.select == SelectTool::brush; }
bool has_outlines(C f) {
    return has_layer(f) && std::ranges::any_of(f.document.scene().layers[f.view.layer].look.crop,
                                               [](const Crop& c) { return c.shape == Crop::Shape::outline; });
}

/// Of how the bodies of its picture lie.
Action incline_in_view() {
    Action action = flip<&ViewState::lying>("Layer", "Incline in the view");
    action.enabled = [](C f) {
        return !lying_rings(scene_at(f.document.scene(), f.view.frame), f.view.layer).empty();
    };
    return action;
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
    {"File/New", "Empty scene", {}, ask<Kind::new_scene>},
    shape<Kind::new_scene, 0>("File/New"),
    shape<Kind::new_scene, 1>("File/New"),
    shape<Kind::new_scene, 2>("File/New"),
    shape<Kind::new_scene, 3>("File/New"),
    shape<Kind::new_scene, 4>("File/New"),
    shape<Kind::new_scene, 5>("File/New"),
    shape<Kind::new_scene, 6>("File/New"),
    shape<Kind::new_scene, 7>("File/New"),
    {"File", "Open...", ctrl('O'), ask<Kind::open>},
    {"File", "Open the demo", {}, ask<Kind::open_demo>},
    below_line({"File", "Save", ctrl('S'), ask<Kind::save>}),
    {"File", "Save as...", ctrl_shift('S'), ask<Kind::save_as>},
    {"File", "Reload", {}, ask<Kind::reload>, has_file},
    below_line({"File", "Import as a layer...", {}, ask<Kind::import_file>}),
    {"File", "Import camera...", {}, ask<Kind::import_camera>},
    {"File", "Export camera...", {}, ask<Kind::export_camera>},
    {"File", "Export splats...", {}, render<RenderKind::splats>, has_layer},
    {"File", "Export look...", {}, ask<Kind::save_look>, has_layer},
    {"File", "Apply look...", {}, ask<Kind::apply_look>, has_layer},
    below_line({"File", "Save the frame as seen...", {}, ask<Kind::save_view>}),
    {"File", "Screenshot of the window...", plain(key_code::f12), ask<Kind::screenshot>},
    below_line({"File", "Quit", ctrl('Q'), ask<Kind::quit>}),

    {"Edit", "Undo", ctrl('Z'), undo, can_undo, nullptr, undo_label, false, true},
    {"Edit", "Redo", ctrl_shift('Z'), redo, can_redo, nullptr, redo_label, false, true, ctrl('Y')},
    below_line({"Edit", "Copy layer", ctrl('C'), copy<CopiedKind::layer>, has_layer}),
    {"Edit", "Copy look", {}, copy<CopiedKind::look>, has_layer},
    {"Edit", "Copy camera", {}, copy<CopiedKind::camera>},
    {"Edit", "Paste", ctrl('V'), paste},
    below_line({"Edit", "Store as B", plain('B'), ask<Kind::store_b>}),
    {"Edit", "Take snapshot", {}, take_snapshot},
    below_line(flip<&ViewState::settings_open>("Edit", "Settings...")),

    view_from<ViewKind::camera>("Camera", plain(key_code::n0)),
    view_from<ViewKind::free>("Free"),
    view_from<ViewKind::front>("Front", plain(key_code::n1)),
    view_from<ViewKind::side>("Side", plain(key_code::n3)),
    view_from<ViewKind::top>("Top", plain(key_code::n7)),
    {"View", "Three-quarter", plain(key_code::n9), three_quarter, has_box},
    below_line({"View", "Frame all", plain('F'), ask<Kind::frame_all>}),
    {"View", "Frame layer", shift('F'), ask_for_layer<Kind::frame_layer>, has_layer},
    {"View", "Output pixels 1:1", plain('Z'), toggle_one_to_one, nullptr, is_one_to_one},
    below_line({"View", "Swap A and B", plain('A'), toggle_compare<CompareMode::other>}),
    compare<CompareMode::wipe>("Wipe A | B"),
    {"View", "Blink", plain('X'), toggle_compare<CompareMode::blink>, nullptr,
     compares_by<CompareMode::blink>},
    compare<CompareMode::difference>("Difference"),
    {"View", "Compare with the reference, not B", ctrl('B'), toggle_compare_with_reference, nullptr,
     compares_with_reference},
    {"View", "Front against its picture", plain('D'), toggle_compare<CompareMode::front>, has_front,
     compares_by<CompareMode::front>},
    look_at<Inspection::Channel::color>("All colours"),
    look_at<Inspection::Channel::red>("Red", shift('R')),
    look_at<Inspection::Channel::green>("Green", shift('G')),
    look_at<Inspection::Channel::blue>("Blue", shift('B')),
    look_at<Inspection::Channel::alpha>("Alpha", shift('A')),
    look_at<Inspection::Channel::luminance>("Luminance", shift('L')),
    look_at<Inspection::Channel::stops>("Stops, in false colours", shift('E')),
    below_line({"View/Channels and scopes", "Neutral exposure and colours", shift('N'),
                [](F f) { f.view.inspection = {}; }}),
    below_line({"View/Channels and scopes", "Scopes", plain('V'), toggle_scopes, nullptr,
                [](C f) { return f.view.scopes_open; }}),
    see_scope<Scope::histogram>(),
    see_scope<Scope::waveform>(),
    see_scope<Scope::vectorscope>(),
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
    flip<&ViewState::scale_bar>("View/Guides", "Scale bar"),
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
    {"Layer", "Duplicate", {}, edit_selected<duplicate_layer>, has_layer},
    {"Layer", "Remove", {}, edit_selected<remove_layer>, has_layer},
    below_line({"Layer", "Visible", plain('H'), hide_layer, has_layer, layer_visible}),
    {"Layer", "Solo", plain('S'), solo_layer, has_layer, layer_solo},
    below_line({"Layer", "Move up", {}, move_selected<-1>, can_move_up}),
    {"Layer", "Move down", {}, move_selected<1>, can_move_down},
    below_line(handles<HandleTool::move>("Move in the view", 'W')),
    handles<HandleTool::rotate>("Rotate in the view", 'E'),
    handles<HandleTool::scale>("Scale in the view", 'R'),
    incline_in_view(),
    select_by<SelectTool::lasso>("Lasso", 'L'),
    select_by<SelectTool::box>("Box", 'M'),
    select_by<SelectTool::brush>("Brush", 'Q'),
    below_line(selected_parts<SelectionFate::erase>("Erases")),
    selected_parts<SelectionFate::keep>("Keeps alone"),
    selected_parts<SelectionFate::part>("Makes a layer"),
    below_line({"Layer/Select", "Smaller brush", plain('['), [](F f) { scale_brush(f, 0.8f); }, brushes}),
    {"Layer/Select", "Larger brush", plain(']'), [](F f) { scale_brush(f, 1.25f); }, brushes},
    below_line(
        {"Layer/Select",
         "Forget what was drawn",
         {},
         [](F f) { edit(f, "Forget outlines", [&](Scene& scene) { forget_outlines(scene, f.view.layer); }); },
         has_outlines}),
    below_line({"Layer", "Regenerate", {}, ask_for_layer<Kind::regenerate>, layer_stale}),

    {"Camera", "Key camera here", {}, set_camera_keyframe_here},
    {"Camera", "Camera from this view", {}, camera_from_view, in_free_view},
    {"Camera", "Move the target in the view", {}, move_camera_target, nullptr, moves_camera_target},
    {"Camera",
     "Pick the focus in the view",
     {},
     [](F f) { f.view.picking_focus = !f.view.picking_focus; },
     focuses,
     [](C f) { return f.view.picking_focus; },
     focus_label},
    add_move<CameraMove::orbit>(),
    add_move<CameraMove::fly_in>(),
    add_move<CameraMove::face_on_to_edge_on>(),
    {"Camera/Dome master", "1024 px", {}, make_dome_master<1024>},
    {"Camera/Dome master", "2048 px", {}, make_dome_master<2048>},
    {"Camera/Dome master", "4096 px", {}, make_dome_master<4096>},
    {"Camera/Dome master", "8192 px", {}, make_dome_master<8192>},
    below_line(flip<&ViewState::lock_to_camera>("Camera", "Lock to camera")),

    {"Render", "Frame...", ctrl('R'), render<RenderKind::frame>},
    {"Render", "Frames...", ctrl_shift('R'), render<RenderKind::range>},
    {"Render", "Movie...", {}, render<RenderKind::movie>, has_ffmpeg, nullptr, movie_label},
    below_line(flip<&ViewState::queue_open>("Render", "Queue...")),
    {"Render", "Cancel", {}, ask<Kind::cancel_render>, has_job},
    below_line({"Render", "Copy batch command", {}, ask<Kind::copy_batch_command>}),

    flip<&ViewState::find_open>("Help", "Find a command or a value...", ctrl('K')),
    flip<&ViewState::help_open>("Help", "Shortcuts", plain(key_code::f1)),
    flip<&ViewState::log_open>("Help", "Log"),

    flip<&ViewState::playing>("", "Play or pause", plain(key_code::space)),
    flip<&ViewState::play_final>("", "Play final frames"),
    repeated("Next frame", key_code::right, next_frame),
    repeated("Previous frame", key_code::left, previous_frame),
    repeated("Next keyframe", key_code::up, next_keyframe),
    repeated("Previous keyframe", key_code::down, previous_keyframe),
    {"", "Play from this frame on", plain('I'), set_in_point},
    {"", "Play up to this frame", plain('O'), set_out_point},
    {"", "Play all frames", shift('I'), clear_in_and_out},
    also({"", "First frame", plain(key_code::home), first_frame}, ctrl(key_code::left)),
    also({"", "Last frame", plain(key_code::end), last_frame}, ctrl(key_code::right)),
    {"", "Keyframe of the hovered row, or the camera", plain('K'), set_keyframe_here},
    {"", "Remove that keyframe", shift('K'), remove_keyframe_here},
    {"", "Cancel what runs, close what is open", plain(key_code::escape), cancel},
};

bool pressed(const Action& action) {
    const auto is_pressed = [&](const Shortcut& shortcut) {
        return shortcut_pressed(shortcut, action.repeats) && (shortcut.ctrl || !takes_key(shortcut.code));
    };
    return is_pressed(action.shortcut) || is_pressed(action.also);
}

}  // namespace

std::span<const Action> actions() { return table; }

void run_shortcuts(GuiFrame& frame) {
    for (const Action& action : actions())
        if (pressed(action) && (!action.enabled || action.enabled(frame))) action.run(frame);
}

}  // namespace astrosplat
