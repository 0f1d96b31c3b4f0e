#include "gui/reference_placing.h"

#include <imgui.h>

#include <array>
#include <cmath>
#include <glm/common.hpp>

#include "gui/theme.h"

namespace astrosplat {
namespace {

constexpr float corner_reach = 12, corner_half = 4;  // px at scale 1

const ReferenceParams& placed(const GuiFrame& frame) {
    return *seen_reference(frame.document.scene(), frame.status);
}

PicturePlace place_now(const GuiFrame& frame, const FrameOnScreen& frame_px) {
    return place_of(placed(frame), frame.status.reference->aspect, frame_px);
}

glm::dvec2 mouse_px() {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    return {mouse.x, mouse.y};
}

void set_place(GuiFrame& frame, const ReferenceParams& reference, Gesture gesture) {
    try_edit([&] {
        const std::size_t index = frame.status.reference->index;
        frame.document.edit(
            "Place reference", [&](Scene& scene) { scene.references[index] = rounded_place(reference); },
            gesture);
    });
}

}  // namespace

bool places_reference(const GuiFrame& frame) {
    const ViewState& view = frame.view;
    return view.placing && compares(view) && view.compare_with == CompareWith::reference &&
           seen_reference(frame.document.scene(), frame.status) && frame.status.reference->aspect > 0.0;
}

void ReferencePlacing::press(const GuiFrame& frame, const FrameOnScreen& frame_px, bool turn) {
    pressed_ = placed(frame);
    pressed_px_ = mouse_px();
    grip_ = turn ? PlaceGrip::turn : grip_at(place_now(frame, frame_px), pressed_px_, px(corner_reach));
    gesture_ = new_gesture();
}

void ReferencePlacing::read(GuiFrame& frame, const FrameOnScreen& frame_px, ViewportInput& input) {
    constexpr double wheel_pause_s = 0.5, notch = 1.05;  // notches in a row are one gesture
    if (input.drag == ViewportInput::Drag::place && !input.drag_begins)
        set_place(frame, dragged(pressed_, grip_, pressed_px_, mouse_px(), frame_px), gesture_);
    if (input.wheel == 0.0f || !input.hovered) return;
    const double now = ImGui::GetTime();
    if (now - wheeled_at_ > wheel_pause_s) wheel_gesture_ = new_gesture();
    wheeled_at_ = now;
    const double factor = std::pow(notch, static_cast<double>(input.wheel));
    set_place(frame, scaled_about(placed(frame), factor, mouse_px(), frame_px), wheel_gesture_);
    input.wheel = 0.0f;
}

void draw_placing(const GuiFrame& frame, const FrameOnScreen& frame_px) {
    const PicturePlace place = place_now(frame, frame_px);
    const glm::dvec2 end = place.corner + place.right + place.down;
    const std::array corners{place.corner, place.corner + place.right, end, place.corner + place.down};
    ImDrawList* list = ImGui::GetWindowDrawList();
    for (const glm::dvec2& c : corners) list->PathLineTo({static_cast<float>(c.x), static_cast<float>(c.y)});
    list->PathStroke(color::attention, ImDrawFlags_Closed, px(1.5f));
    for (const glm::dvec2& c : corners) {
        const auto x = static_cast<float>(c.x), y = static_cast<float>(c.y), half = px(corner_half);
        list->AddRectFilled({x - half, y - half}, {x + half, y + half}, color::attention);
    }
}

}  // namespace astrosplat
