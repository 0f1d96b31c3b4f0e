// Handles by which things of the world are moved, turned and scaled in a view: which one lies under the
// mouse, and what dragging it means. In: a camera in px of the viewport, what stands in the world, the mouse.
// Out: movements in the world. Draws nothing.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "camera/camera.h"
#include "edit/view_state.h"

namespace astrosplat {

/// What handles act on.
struct Handled {
    glm::dvec3 origin{0.0};  // world space
    glm::dmat3 axes{1.0};    // unit vectors along which it is moved and scaled, about which it is turned
    bool uniform = false;    // it is scaled as a whole only
};

enum class Grip { x, y, z, middle, none };

/// Sizes on the screen, px.
struct HandleSizes {
    double length = 90.0;  // of an axis, and the radius of rings
    double reach = 9.0;    // of the mouse
};

/// The line of an axis' handle: straight for moving and scaling, a ring for turning. World space.
std::vector<glm::dvec3> handle_line(const Camera& camera, const Handled& handled, HandleTool tool, int axis,
                                    const HandleSizes& sizes);

/// The handle under the mouse, the nearest of several. An axis that points at the eye has none.
Grip grip_at(const Camera& camera, const Handled& handled, HandleTool tool, const glm::dvec2& mouse_px,
             const HandleSizes& sizes);

/// A drag from one place of the mouse to another, px.
struct HandleDrag {
    Grip grip = Grip::none;
    glm::dvec2 from_px{0.0}, to_px{0.0};
};

/// How far it is moved: along the axis, or by the middle in the plane that the view faces. Scene units.
glm::dvec3 moved_by(const Camera& camera, const Handled& handled, const HandleDrag& drag);

/// How it is turned, about the axis or by the middle about the line of sight: a rotation of the world.
glm::dmat3 turned_by(const Camera& camera, const Handled& handled, const HandleDrag& drag);

/// By what each axis is multiplied; never 0 or less.
glm::dvec3 scaled_by(const Camera& camera, const Handled& handled, const HandleDrag& drag);

}  // namespace astrosplat
