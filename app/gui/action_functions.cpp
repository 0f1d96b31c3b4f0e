// Actions that edit the scene or the view, and the questions whether they can be done now.
#include "gui/action_functions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "edit/camera_moves.h"
#include "edit/keyframes.h"
#include "edit/layers.h"
#include "edit/view_camera.h"
#include "scene/animate.h"
#include "scene/describe.h"

namespace astrosplat {
namespace {

const std::string& selected_name(const GuiFrame& f) { return f.document.scene().layers[f.view.layer].name; }

void edit(GuiFrame& f, const std::string& name, const std::function<void(Scene&)>& change) {
    try_edit([&] { f.document.edit(name, change); });
}

void say(GuiFrame& f, std::string text) {
    f.requested.push_back({Command::Kind::say, {}, std::move(text), 0});
}

void go_to(GuiFrame& f, double frame) {
    const FrameRange range = shown_range(f.document.scene());
    f.view.frame = std::clamp(frame, range.first, range.last);
}

Value value_now(const GuiFrame& f, const std::string& key) {
    Scene still = scene_at(f.document.scene(), f.view.frame);
    const Description description = describe(still);
    const Parameter* parameter = find_parameter(description, key);
    return parameter ? parameter->get() : Value();
}

}  // namespace

void undo(GuiFrame& f) {
    say(f, "Undone: " + f.document.undo_name());
    f.document.undo();
}
void redo(GuiFrame& f) {
    say(f, "Redone: " + f.document.redo_name());
    f.document.redo();
}
bool can_undo(const GuiFrame& f) { return f.document.can_undo(); }
bool can_redo(const GuiFrame& f) { return f.document.can_redo(); }
std::string undo_label(const GuiFrame& f) { return can_undo(f) ? "Undo " + f.document.undo_name() : "Undo"; }
std::string redo_label(const GuiFrame& f) { return can_redo(f) ? "Redo " + f.document.redo_name() : "Redo"; }
void take_snapshot(GuiFrame& f) {
    request(f, Command::Kind::take_snapshot);
    f.view.snapshots_open = true;
}

void new_empty_scene(GuiFrame& f) { request(f, Command::Kind::new_scene); }

bool has_file(const GuiFrame& f) { return !f.document.file().empty(); }
bool has_layer(const GuiFrame& f) { return f.view.layer < f.document.scene().layers.size(); }
bool has_box(const GuiFrame& f) { return !f.status.box.empty(); }
bool has_job(const GuiFrame& f) { return running_job(f.status) != nullptr; }
bool has_ffmpeg(const GuiFrame& f) { return f.status.has_ffmpeg; }
std::string movie_label(const GuiFrame& f) { return has_ffmpeg(f) ? "Movie..." : "Movie... (needs ffmpeg)"; }

void three_quarter(GuiFrame& f) {
    const double aspect =
        f.status.viewport_aspect > 0.0 ? f.status.viewport_aspect : aspect_of(f.document.scene().output);
    f.view.free = three_quarter_view(f.view.free, f.status.box, aspect);
    f.view.view = ViewKind::free;
}
void toggle_one_to_one(GuiFrame& f) {
    f.view.size = is_one_to_one(f) ? SizeMode::fit : SizeMode::one_to_one;
    f.view.pan_px = {0.0, 0.0};
    f.view.zoom = 1.0;
}
bool is_one_to_one(const GuiFrame& f) { return f.view.size == SizeMode::one_to_one; }

void set_compare(GuiFrame& f, CompareMode mode) {
    f.view.compare = mode;
    if (!compares(f.view)) return;
    if (f.view.compare_with == CompareWith::reference) {
        if (!has_reference(f)) request(f, Command::Kind::set_reference);
    } else if (f.status.b_snapshot < 0) {
        say(f, "Nothing is stored as B yet: the key B stores the look as it is");
    }
}
void compare_with(GuiFrame& f, CompareWith with) {
    f.view.compare_with = with;
    set_compare(f, f.view.compare);
}
void toggle_compare_with_reference(GuiFrame& f) {
    compare_with(f, compares_with_reference(f) ? CompareWith::b : CompareWith::reference);
}
bool compares_with_reference(const GuiFrame& f) { return f.view.compare_with == CompareWith::reference; }
void toggle_blink(GuiFrame& f) { set_compare(f, blinks(f) ? CompareMode::a : CompareMode::blink); }
bool blinks(const GuiFrame& f) { return f.view.compare == CompareMode::blink; }
bool has_reference(const GuiFrame& f) { return f.status.reference.has_value(); }
void toggle_placing(GuiFrame& f) {
    f.view.placing = !f.view.placing;
    if (f.view.placing) show_reference(f.view);
}
bool is_placing(const GuiFrame& f) { return f.view.placing; }
void toggle_front(GuiFrame& f) { f.view.compare = shows_front(f) ? CompareMode::a : CompareMode::front; }
bool has_front(const GuiFrame& f) { return f.status.front.has_value(); }
bool shows_front(const GuiFrame& f) { return f.view.compare == CompareMode::front; }
void swap_a_b(GuiFrame& f) {
    set_compare(f, f.view.compare == CompareMode::other ? CompareMode::a : CompareMode::other);
}

void duplicate_selected_layer(GuiFrame& f) {
    try_edit([&] { duplicate_layer(f.document, f.view, f.view.layer); });
}
void remove_selected_layer(GuiFrame& f) {
    try_edit([&] { remove_layer(f.document, f.view, f.view.layer); });
}
void hide_layer(GuiFrame& f) {
    try_edit([&] { toggle_visible(f.document, f.view, f.view.layer); });
}
void solo_layer(GuiFrame& f) { toggle_solo(f.view, selected_name(f)); }
bool layer_visible(const GuiFrame& f) {
    return has_layer(f) && is_visible(f.document.scene(), f.view.layer, f.view.frame);
}
bool layer_solo(const GuiFrame& f) { return has_layer(f) && f.view.solo.count(selected_name(f)) > 0; }
void move_layer_up(GuiFrame& f) {
    try_edit([&] { move_layer(f.document, f.view, f.view.layer, f.view.layer - 1); });
}
void move_layer_down(GuiFrame& f) {
    try_edit([&] { move_layer(f.document, f.view, f.view.layer, f.view.layer + 1); });
}
bool can_move_up(const GuiFrame& f) { return has_layer(f) && f.view.layer > 0; }
bool can_move_down(const GuiFrame& f) { return f.view.layer + 1 < f.document.scene().layers.size(); }
bool layer_stale(const GuiFrame& f) {
    return f.view.layer < f.status.layers.size() && f.status.layers[f.view.layer].stale;
}

bool in_free_view(const GuiFrame& f) { return f.view.view == ViewKind::free; }
void make_dome_master(GuiFrame& f, std::int64_t side_px) {
    edit(f, fmt::format("Dome master of {} px", side_px), [&](Scene& scene) {
        scene.output.width = scene.output.height = side_px;
        scene.camera.projection = Projection::fisheye;
        scene.camera.fisheye_fov = 180.0;
    });
    f.view.safe_areas = true;  // a master has its zone to keep titles in
}

void set_camera_keyframe_here(GuiFrame& f) {
    edit(f, "Set camera keyframe",
         [&](Scene& scene) { set_keyframe_of_seen_camera(scene, f.view, f.status); });
}
void camera_from_view(GuiFrame& f) {
    const std::vector<Track>& tracks = f.document.scene().animation;
    const bool animated = std::any_of(tracks.begin(), tracks.end(),
                                      [](const Track& track) { return track.key.is_below("camera"); });
    if (animated) return set_camera_keyframe_here(f);
    edit(f, "Camera from view", [&](Scene& scene) { scene.camera = seen_camera(scene, f.view, f.status); });
}

void next_frame(GuiFrame& f) { go_to(f, std::floor(f.view.frame) + 1.0); }
void previous_frame(GuiFrame& f) { go_to(f, std::ceil(f.view.frame) - 1.0); }
void next_keyframe(GuiFrame& f) { f.view.frame = frame_of_next_keyframe(f.document.scene(), f.view.frame); }
void previous_keyframe(GuiFrame& f) {
    f.view.frame = frame_of_previous_keyframe(f.document.scene(), f.view.frame);
}
void first_frame(GuiFrame& f) { f.view.frame = frame_range(f.document.scene()).first; }
void last_frame(GuiFrame& f) { f.view.frame = frame_range(f.document.scene()).last; }

void set_in_point(GuiFrame& f) {
    f.view.play_first = f.view.frame;
    if (f.view.play_last && *f.view.play_last <= f.view.frame) f.view.play_last.reset();
}
void set_out_point(GuiFrame& f) {
    f.view.play_last = f.view.frame;
    if (f.view.play_first && *f.view.play_first >= f.view.frame) f.view.play_first.reset();
}
void clear_in_and_out(GuiFrame& f) {
    f.view.play_first.reset();
    f.view.play_last.reset();
}

void set_keyframe_here(GuiFrame& f) {
    const std::string key = f.view.hovered_parameter;
    if (key.empty()) return set_camera_keyframe_here(f);
    const Value value = value_now(f, key);
    edit(f, "Set keyframe of " + key, [&](Scene& scene) { set_keyframe(scene, key, f.view.frame, value); });
}
void remove_keyframe_here(GuiFrame& f) {
    const std::string key = f.view.hovered_parameter;
    edit(f, key.empty() ? "Remove camera keyframes" : "Remove keyframe of " + key, [&](Scene& scene) {
        std::vector<std::string> found;
        for (const Track& track : scene.animation)
            if (key.empty() ? track.key.is_below("camera") : track.key == key) found.push_back(track.key);
        for (const std::string& animated : found)
            if (has_keyframe_at(scene, animated, f.view.frame))
                remove_keyframe(scene, animated, f.view.frame);
    });
}
void choose_handles(GuiFrame& f, HandleTool tool) {
    ViewState& view = f.view;
    const bool of_layer = view.handle_target != HandleTarget::camera_target;
    view.tool = view.tool == tool && of_layer ? HandleTool::none : tool;
    if (!of_layer) view.handle_target = HandleTarget::layer;
}
bool moves_camera_target(const GuiFrame& f) {
    return f.view.tool == HandleTool::move && f.view.handle_target == HandleTarget::camera_target;
}
void move_camera_target(GuiFrame& f) {
    const bool was_on = moves_camera_target(f);
    f.view.tool = was_on ? HandleTool::none : HandleTool::move;
    f.view.handle_target = was_on ? HandleTarget::layer : HandleTarget::camera_target;
    const CameraParams& camera = f.document.scene().camera;
    if (was_on || (camera.position && !camera.rotation)) return;
    if (camera.rotation) return say(f, "This camera looks along camera.rotation, which has no target");
    ViewState through_camera;
    through_camera.frame = f.view.frame;
    edit(f, "Place of the camera",
         [&](Scene& scene) { scene.camera = seen_camera(scene, through_camera, f.status); });
}

void cancel(GuiFrame& f) {
    if (f.view.help_open || f.view.log_open) {
        f.view.help_open = f.view.log_open = false;
    } else if (is_placing(f)) {
        toggle_placing(f);
    } else if (f.view.tool != HandleTool::none) {
        f.view.tool = HandleTool::none;
        f.view.handle_target = HandleTarget::layer;
    } else if (f.view.selected_box) {
        f.view.selected_box = false;
    } else if (has_job(f)) {
        request(f, Command::Kind::cancel_render);
    } else {
        for (std::size_t i = 0; i < f.status.layers.size(); ++i)
            if (f.status.layers[i].loading) request(f, Command::Kind::cancel_load, i);
    }
}

}  // namespace astrosplat
