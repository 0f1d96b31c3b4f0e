#include "gui/path_points.h"

#include <fmt/format.h>
#include <imgui.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "camera/keyframe.h"
#include "edit/keyframes.h"
#include "edit/placement.h"
#include "gui/key_codes.h"
#include "gui/theme.h"
#include "gui/widgets.h"
#include "scene/animate.h"

namespace astrosplat {
namespace {

constexpr float path_reach = 8, least_handle = 6;  // px at scale 1
const std::string path_key = "camera.position";

Value list_of(const glm::dvec3& v) { return Value::List{v.x, v.y, v.z}; }

/// The mouse's last move at a point of the world: in the plane of the view, or along its axis.
glm::dvec3 moved_by_mouse(const Camera& camera, const glm::dvec3& point) {
    const ImGuiIO& io = ImGui::GetIO();
    const double unit = units_per_px(camera, point);
    const double dx = static_cast<double>(io.MouseDelta.x), dy = static_cast<double>(io.MouseDelta.y);
    if (io.KeyShift) return camera.world_from_camera[2] * (dy * unit);
    return camera.world_from_camera[0] * (dx * unit) - camera.world_from_camera[1] * (dy * unit);
}

}  // namespace

std::vector<PathPoints::Place> PathPoints::places(const GuiFrame& frame, const Rect& area) {
    std::vector<Place> result;
    const ViewState& view = frame.view;
    const Track* const track = find_track(frame.document.scene(), path_key);
    if (!track || !frame.status.viewport_camera || view.view == ViewKind::camera || !view.camera_path)
        return result;
    const std::vector<Keyframe<glm::dvec3>> keyframes = position_keyframes(*track);
    const auto add = [&](const Grip& grip, const glm::dvec3& point, const glm::dvec3& from) {
        const auto at = project_point(*frame.status.viewport_camera, point);
        const auto start = project_point(*frame.status.viewport_camera, from);
        const glm::vec2 corner(area.x, area.y);
        if (!at || !start) return;
        if (grip.side && glm::distance(*at, *start) < px(least_handle)) return;  // it lies on its keyframe
        result.push_back({grip, point, corner + *at, corner + *start});
    };
    for (std::size_t i = 0; i < keyframes.size(); ++i) {
        const Keyframe<glm::dvec3>& k = keyframes[i];
        add({k.frame, {}}, k.value, k.value);
        for (const HandleSide side : {HandleSide::in, HandleSide::out}) {
            if (!has_handle(*track, i, side)) continue;
            const Handle<glm::dvec3> h = side == HandleSide::in
                                             ? handle_before(std::span(keyframes), i, track->ends)
                                             : handle_after(std::span(keyframes), i, track->ends);
            add({k.frame, side}, k.value + h.value, k.value);
        }
    }
    return result;
}

const PathPoints::Place* PathPoints::nearest(const std::vector<Place>& places) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const Place* found = nullptr;
    float reach = px(path_reach);
    for (const Place& place : places) {
        const float distance = glm::distance(place.px, glm::vec2(mouse.x, mouse.y));
        if (distance > reach) continue;
        reach = distance;
        found = &place;
    }
    return found;
}

bool PathPoints::press(GuiFrame& frame, const Rect& area) {
    const std::vector<Place> all = places(frame, area);
    const Place* const found = nearest(all);
    if (!found) return false;
    held_ = found->grip;
    pressed_at_ = found->point;
    moved_ = glm::dvec3(0.0);
    gesture_ = new_gesture();
    edited_ = false;
    frame.view.graph_parameter = path_key;
    if (!held_->side) return true;
    const Track& track = *find_track(frame.document.scene(), path_key);
    const std::vector<Keyframe<glm::dvec3>> keyframes = position_keyframes(track);
    for (std::size_t i = 0; i < keyframes.size(); ++i)
        if (keyframes[i].frame == held_->frame)
            frames_ = *held_->side == HandleSide::in
                          ? handle_before(std::span(keyframes), i, track.ends).frames
                          : handle_after(std::span(keyframes), i, track.ends).frames;
    return true;
}

void PathPoints::drag(GuiFrame& frame) {
    if (!held_) return;
    if (key_pressed(key_code::escape)) {
        held_.reset();
        if (std::exchange(edited_, false)) frame.document.undo();
        return;
    }
    if (!frame.status.viewport_camera) return;
    const glm::dvec3 step = moved_by_mouse(*frame.status.viewport_camera, pressed_at_ + moved_);
    if (step == glm::dvec3(0.0)) return;
    moved_ += step;
    const glm::dvec3 at = pressed_at_ + moved_;
    try_edit([&] {
        frame.document.edit(
            held_->side ? "Bend camera path" : "Move camera keyframe",
            [&](Scene& scene) {
                if (!held_->side) return set_keyframe(scene, path_key, held_->frame, list_of(at));
                for (const auto& k : position_keyframes(*find_track(scene, path_key))) {
                    if (k.frame != held_->frame) continue;
                    const glm::dvec3 v = at - k.value;
                    set_handle(scene, path_key, k.frame, *held_->side, frames_, {v.x, v.y, v.z});
                }
            },
            gesture_);
    });
    edited_ = true;
}

void PathPoints::release(GuiFrame& frame) {
    if (held_ && !held_->side && !edited_) frame.view.frame = held_->frame;
    held_.reset();
}

void PathPoints::draw(GuiFrame& frame, const Rect& area) const {
    const std::vector<Place> all = places(frame, area);
    const Place* const under = held_ ? nullptr : nearest(all);
    ImDrawList* const list = ImGui::GetWindowDrawList();
    for (const Place& place : all) {
        const ImVec2 at{place.px.x, place.px.y};
        const bool lit = held_ ? *held_ == place.grip : under == &place;
        const char* const side = !place.grip.side                     ? "point"
                                 : *place.grip.side == HandleSide::in ? "in"
                                                                      : "out";
        note_item(frame, fmt::format("path {} {:g}", side, place.grip.frame), place.px);
        if (place.grip.side) {
            list->AddLine({place.from.x, place.from.y}, at, color::with_opacity(color::text, 0.6f), px(1));
            list->AddCircleFilled(at, px(lit ? 5 : 3.5f), color::text, 16);
            continue;
        }
        const bool now = place.grip.frame == frame.view.frame;
        const float half = px(lit ? 6 : 4.5f), edge = half + px(1);
        list->AddRectFilled({at.x - edge, at.y - edge}, {at.x + edge, at.y + edge}, color::line);
        list->AddRectFilled({at.x - half, at.y - half}, {at.x + half, at.y + half},
                            now || lit ? color::text : color::attention);
    }
    if (under && !ImGui::IsAnyItemActive() && !under->grip.side)
        tooltip(fmt::format("Frame {:g}. Drag moves it in the plane of the view, Shift along its axis",
                            under->grip.frame)
                    .c_str());
}

}  // namespace astrosplat
