// The table of actions and the loop that finds the one a key means.
#include "gui/actions.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "edit/camera_moves.h"
#include "edit/layers.h"
#include "gui/action_functions.h"
#include "gui/key_codes.h"

namespace astrosplat {
namespace {

using Kind = Command::Kind;
using F = GuiFrame&;
using C = const GuiFrame&;
using List = std::vector<Action>;

template <Kind kind, std::size_t index = 0>
void ask(F f) {
    request(f, kind, index);
}
template <Kind kind>
void ask_for_layer(F f) {
    request(f, kind, f.view.layer);
}
template <bool ViewState::*flag>
void flip(F f) {
    f.view.*flag = !(f.view.*flag);
}
template <bool ViewState::*flag>
bool is_on(C f) {
    return f.view.*flag;
}
template <ViewKind kind>
void look_from(F f) {
    f.view.view = kind;
}
template <ViewKind kind>
bool looks_from(C f) {
    return f.view.view == kind;
}
template <CompareMode mode>
void compare(F f) {
    set_compare(f, mode);
}
template <CompareMode mode>
bool compares(C f) {
    return f.view.compare == mode;
}

constexpr Shortcut plain(int key) { return {key, false, false}; }
constexpr Shortcut shift(int key) { return {key, false, true}; }
constexpr Shortcut ctrl(int key) { return {key, true, false}; }
constexpr Shortcut ctrl_shift(int key) { return {key, true, true}; }

void add_file(List& list) {
    list.push_back({"File", "New from picture...", {}, ask<Kind::new_from_file>});
    list.push_back({"File", "Open...", ctrl('O'), ask<Kind::open>});
    list.push_back({"File", "Open the demo", {}, ask<Kind::open_demo>});
    list.push_back({"File", "Save", ctrl('S'), ask<Kind::save>, nullptr, nullptr, nullptr, true});
    list.push_back({"File", "Save as...", ctrl_shift('S'), ask<Kind::save_as>});
    list.push_back({"File", "Reload", {}, ask<Kind::reload>, has_file});
    list.push_back(
        {"File", "Import as a layer...", {}, ask<Kind::import_file>, nullptr, nullptr, nullptr, true});
    list.push_back({"File", "Export look...", {}, ask<Kind::save_look>, has_layer});
    list.push_back({"File", "Apply look...", {}, ask<Kind::apply_look>, has_layer});
    list.push_back({"File", "Screenshot...", plain(key_code::f12), ask<Kind::screenshot>, nullptr, nullptr,
                    nullptr, true});
    list.push_back({"File", "Quit", ctrl('Q'), ask<Kind::quit>, nullptr, nullptr, nullptr, true});
}

void add_edit(List& list) {
    list.push_back({"Edit", "Undo", ctrl('Z'), undo, can_undo, nullptr, undo_label, false, true});
    list.push_back({"Edit", "Redo", ctrl_shift('Z'), redo, can_redo, nullptr, redo_label, false, true});
    list.push_back({"Edit", "Store as B", plain('B'), ask<Kind::store_b>, nullptr, nullptr, nullptr, true});
    list.push_back({"Edit", "Take snapshot", {}, take_snapshot});
}

void add_view(List& list) {
    list.push_back({"View", "Camera", plain(key_code::n0), look_from<ViewKind::camera>, nullptr,
                    looks_from<ViewKind::camera>});
    list.push_back({"View", "Free", {}, look_from<ViewKind::free>, nullptr, looks_from<ViewKind::free>});
    list.push_back({"View", "Front", plain(key_code::n1), look_from<ViewKind::front>, nullptr,
                    looks_from<ViewKind::front>});
    list.push_back({"View", "Side", plain(key_code::n3), look_from<ViewKind::side>, nullptr,
                    looks_from<ViewKind::side>});
    list.push_back(
        {"View", "Top", plain(key_code::n7), look_from<ViewKind::top>, nullptr, looks_from<ViewKind::top>});
    list.push_back({"View", "Three-quarter", plain(key_code::n9), three_quarter, has_box});
    list.push_back({"View", "Frame layer", plain('F'), ask_for_layer<Kind::frame_layer>, has_layer, nullptr,
                    nullptr, true});
    list.push_back({"View", "Frame all", plain(key_code::home), ask<Kind::frame_all>});
    list.push_back({"View", "Output pixels 1:1", plain('Z'), toggle_one_to_one, nullptr, is_one_to_one});
    list.push_back({"View", "Swap A and B", plain(key_code::tab), swap_a_b, nullptr, nullptr, nullptr, true});
    list.push_back(
        {"View", "Wipe A | B", {}, compare<CompareMode::wipe>, nullptr, compares<CompareMode::wipe>});
    list.push_back({"View",
                    "Reference",
                    {},
                    compare<CompareMode::reference>,
                    nullptr,
                    compares<CompareMode::reference>});
    list.push_back({"View",
                    "Difference",
                    {},
                    compare<CompareMode::difference>,
                    nullptr,
                    compares<CompareMode::difference>});
    list.push_back({"View", "Load reference...", {}, ask<Kind::set_reference>});
    list.push_back({"View", "Gate", plain('G'), flip<&ViewState::gate>, nullptr, is_on<&ViewState::gate>,
                    nullptr, true});
    list.push_back(
        {"View", "Safe areas", {}, flip<&ViewState::safe_areas>, nullptr, is_on<&ViewState::safe_areas>});
    list.push_back(
        {"View", "Camera path", {}, flip<&ViewState::camera_path>, nullptr, is_on<&ViewState::camera_path>});
    list.push_back({"View",
                    "Settle to the final picture",
                    {},
                    flip<&ViewState::settle>,
                    nullptr,
                    is_on<&ViewState::settle>});
    list.push_back({"View",
                    "Timeline",
                    {},
                    flip<&ViewState::timeline_open>,
                    nullptr,
                    is_on<&ViewState::timeline_open>,
                    nullptr,
                    true});
    list.push_back({"View",
                    "Snapshots",
                    {},
                    flip<&ViewState::snapshots_open>,
                    nullptr,
                    is_on<&ViewState::snapshots_open>});
    list.push_back({"View", "Panels", plain(key_code::f11), flip<&ViewState::panels>, nullptr,
                    is_on<&ViewState::panels>});
}

void add_layer_menu(List& list) {
    list.push_back({"Layer", "Add...", {}, ask<Kind::import_file>});
    list.push_back({"Layer", "Duplicate", {}, duplicate_selected_layer, has_layer});
    list.push_back({"Layer", "Remove", {}, remove_selected_layer, has_layer});
    list.push_back({"Layer", "Visible", plain('H'), hide_layer, has_layer, layer_visible, nullptr, true});
    list.push_back({"Layer", "Solo", plain('S'), solo_layer, has_layer, layer_solo});
    list.push_back({"Layer", "Move up", {}, move_layer_up, can_move_up, nullptr, nullptr, true});
    list.push_back({"Layer", "Move down", {}, move_layer_down, can_move_down});
    list.push_back(
        {"Layer", "Regenerate", {}, ask_for_layer<Kind::regenerate>, layer_stale, nullptr, nullptr, true});
}

template <CameraMove move>
void add_move(List& list) {
    constexpr auto index = static_cast<std::size_t>(move);
    list.push_back({"Camera/Add move", camera_move_names[index], {}, ask<Kind::add_move, index>, has_box});
}

void add_camera(List& list) {
    list.push_back({"Camera", "Key camera here", {}, key_camera_here});
    list.push_back({"Camera", "Camera from this view", {}, camera_from_view, in_free_view});
    add_move<CameraMove::orbit>(list);
    add_move<CameraMove::fly_in>(list);
    add_move<CameraMove::face_on_to_edge_on>(list);
    list.push_back({"Camera",
                    "Lock to camera",
                    {},
                    flip<&ViewState::lock_to_camera>,
                    nullptr,
                    is_on<&ViewState::lock_to_camera>,
                    nullptr,
                    true});
}

void add_render(List& list) {
    list.push_back({"Render", "This frame...", ctrl('R'), ask<Kind::render_frame>});
    list.push_back(
        {"Render", "Range", ctrl_shift('R'), ask<Kind::render_range>, nullptr, nullptr, range_label});
    list.push_back({"Render", "Movie...", {}, ask<Kind::render_movie>, has_ffmpeg, nullptr, movie_label});
    list.push_back({"Render", "Cancel", {}, ask<Kind::cancel_render>, has_job});
    list.push_back(
        {"Render", "Copy batch command", {}, ask<Kind::copy_batch_command>, nullptr, nullptr, nullptr, true});
}

void add_help(List& list) {
    list.push_back({"Help", "Keys", plain(key_code::f1), flip<&ViewState::help_open>, nullptr,
                    is_on<&ViewState::help_open>});
    list.push_back({"Help", "Log", {}, flip<&ViewState::log_open>, nullptr, is_on<&ViewState::log_open>});
}

void add_keys(List& list) {
    list.push_back({"", "Play or pause", plain(key_code::space), flip<&ViewState::playing>});
    list.push_back(
        {"", "Next frame", plain(key_code::right), next_frame, nullptr, nullptr, nullptr, false, true});
    list.push_back({"", "Previous frame", plain(key_code::left), previous_frame, nullptr, nullptr, nullptr,
                    false, true});
    list.push_back({"", "Next key", plain(key_code::up), next_key, nullptr, nullptr, nullptr, false, true});
    list.push_back(
        {"", "Previous key", plain(key_code::down), previous_key, nullptr, nullptr, nullptr, false, true});
    list.push_back({"", "First frame", ctrl(key_code::left), first_frame});
    list.push_back({"", "Last frame", ctrl(key_code::right), last_frame});
    list.push_back({"", "Key the row under the mouse, or the camera", plain('K'), key_here});
    list.push_back({"", "Remove that key", shift('K'), remove_key_here});
    list.push_back({"", "Cancel what runs, close what is open", plain(key_code::escape), cancel});
}

List make_actions() {
    List list;
    add_file(list);
    add_edit(list);
    add_view(list);
    add_layer_menu(list);
    add_camera(list);
    add_render(list);
    add_help(list);
    add_keys(list);
    return list;
}

bool pressed(const Action& action) {
    const ImGuiIO& io = ImGui::GetIO();
    const Shortcut& s = action.shortcut;
    if (s.key == 0 || io.KeyAlt || io.KeyCtrl != s.ctrl || io.KeyShift != s.shift) return false;
    return ImGui::IsKeyPressed(s.key, action.repeats);
}

}  // namespace

std::span<const Action> actions() {
    static const List list = make_actions();
    return list;
}

std::string shortcut_text(const Shortcut& s) {
    return std::string(s.ctrl ? "Ctrl+" : "") + (s.shift ? "Shift+" : "") + key_name(s.key);
}

void run_shortcuts(GuiFrame& frame) {
    for (const Action& action : actions())
        if (pressed(action) && (!action.enabled || action.enabled(frame))) action.run(frame);
}

}  // namespace astrosplat
