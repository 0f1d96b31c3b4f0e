// The keyframes of the camera's position as points on its path, in views beside the camera, with the handles
// of Bezier ones: dragged in the plane of the view, with Shift along its axis. In: the scene, the mouse. Out:
// edits, one undo step a drag.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "edit/keyframes.h"
#include "gui/gui_frame.h"

namespace astrosplat {

class PathPoints {
  public:
    /// Takes the point or handle under the mouse, if there is one. `area` is the viewport's.
    bool press(GuiFrame& frame, const Rect& area);
    /// While the button is held; Escape takes the drag back.
    void drag(GuiFrame& frame);
    /// A point that was not moved shows its frame.
    void release(GuiFrame& frame);
    void draw(GuiFrame& frame, const Rect& area) const;

  private:
    struct Grip {
        double frame = 0.0;
        std::optional<HandleSide> side;  // none: the point itself
        bool operator==(const Grip&) const = default;
    };
    struct Place {
        Grip grip;
        glm::dvec3 point;    // world
        glm::vec2 px, from;  // on the screen, with its keyframe's
    };
    static std::vector<Place> places(const GuiFrame& frame, const Rect& area);
    static const Place* nearest(const std::vector<Place>& places);

    std::optional<Grip> held_;
    glm::dvec3 pressed_at_{0.0}, moved_{0.0};  // world
    double frames_ = 0.0;                      // of the held handle
    Gesture gesture_ = 0;
    bool edited_ = false;
};

}  // namespace astrosplat
