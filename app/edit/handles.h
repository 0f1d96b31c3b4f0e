// Handles by which the placement of the selected layer, one of its crops or the camera's target is moved,
// turned and scaled in a view. In: the scene at a frame, what was chosen, a camera in px of the viewport, the
// mouse. Out: which handle lies under the mouse, and the parameter that dragging it changes. Draws nothing.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "edit/view_state.h"
#include "scene/parameter.h"
#include "scene/scene.h"

namespace astrosplat {

/// The object that handles act on.
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

/// In the world; none where there is nothing that the tool could do: the camera's target has no size, a
/// sphere no direction.
std::optional<Handled> handled_in(const Scene& now, const ViewState& view);

struct NewValue {
    std::string key;  // full: "layer.stars.transform.translate"
    Value value;
};

/// The value after a drag that began with `pressed`, the scene at the frame, seen by `camera`. Rounded to
/// what a pixel can tell. `view` chooses a thing that handled_in() finds.
NewValue dragged_value(const Scene& pressed, const ViewState& view, const Camera& camera,
                       const HandleDrag& drag);

/// Boxes and spheres of the crops of a layer, as lines in the world.
std::vector<std::vector<glm::dvec3>> crop_outline(const LayerParams& layer, std::size_t crop);

}  // namespace astrosplat
