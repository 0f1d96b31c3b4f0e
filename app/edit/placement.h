// Places of layers in the world, and of points and lines of the world in a frame.
// world = rotation * (scale * p) + translate, as LayerTransform says it in degrees; px of a frame, y down.
// And handles by which a layer, one of its crops or the camera's target is moved, turned and scaled in a
// view: which one lies under the mouse, and the parameter that dragging it changes. Draws nothing.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "camera/camera.h"
#include "core/bounds.h"
#include "edit/view_state.h"
#include "scene/parameter.h"
#include "scene/scene.h"

namespace astrosplat {

struct LayerPlacement {
    glm::dmat3 rotation{1.0};  // world from layer
    double scale = 1.0;
    glm::dvec3 translate{0.0};  // scene units
    bool operator==(const LayerPlacement&) const = default;
};

LayerPlacement placement_of(const LayerTransform& transform);
glm::dvec3 to_world(const LayerPlacement& placement, const glm::dvec3& in_layer);
glm::dvec3 to_layer(const LayerPlacement& placement, const glm::dvec3& in_world);

/// Degrees about x, then y, then z of a rotation: those nearest to `near`, which say it as well.
glm::dvec3 degrees_of(const glm::dmat3& rotation, const glm::dvec3& near);

/// By the right-hand rule; `axis` of length 1.
glm::dmat3 rotation_about(const glm::dvec3& axis, double radians);

/// The camera of a frame that is shown `scale` times as large with its upper left at `corner`, px: what it
/// projects are px of where it is shown.
Camera camera_on_screen(const Camera& camera, const glm::dvec2& corner, double scale);

/// Along the view axis, scene units; below 0 behind the eye.
double view_depth(const Camera& camera, const glm::dvec3& point);

/// None where the point does not lie in front of the eye.
std::optional<glm::vec2> project_point(const Camera& camera, const glm::dvec3& point);

/// A line of several points, cut where it passes behind the eye.
std::vector<std::vector<glm::vec2>> project_line(const Camera& camera, const std::vector<glm::dvec3>& line);

/// The ray through a pixel: from the eye, or where rays are parallel from the plane through it.
struct ViewRay {
    glm::dvec3 origin, direction;  // of length 1
};
ViewRay ray_through(const Camera& camera, const glm::dvec2& px);

/// Scene units that a pixel covers at a point.
double units_per_px(const Camera& camera, const glm::dvec3& point);

struct MarkLine {
    glm::dvec3 from, to;  // world space
};

/// The twelve edges of a box of layer space, placed as the layer is.
std::vector<MarkLine> box_edges(const Bounds& box, const LayerTransform& transform);

/// Lines around the scene's box at whole multiples of `spacing`, which is 1, 2 or 5 times a power of ten: in
/// the plane that the view faces, for others in the horizontal one. The plane goes through the origin, or
/// where the box does not reach it along the nearest side of the box.
struct Grid {
    double spacing = 1.0;  // scene units
    std::vector<MarkLine> lines;
};
Grid grid_around(const Bounds& box, ViewKind view);

/// A length to measure with: 1, 2 or 5 times a power of ten light years, or of scene units where none knows
/// how long these are (0), and at most `most_px` long on the screen.
struct ScaleBar {
    double length_px = 0.0;
    std::string text;  // "5 kly", "0.2 scene units"
};
ScaleBar scale_bar(double units_per_px, double light_years_per_unit, double most_px);

/// "2.5 scene units", and how many light years these are where that is known: "2.5 scene units, 7.3 kly".
std::string length_text(double units, double light_years_per_unit);

/// From the origin along x, y and z, half as long as the box's longest side.
std::array<MarkLine, 3> axis_lines(const Bounds& box);

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

/// Boxes, spheres and outlines of the crops of a layer, as lines in the world.
std::vector<std::vector<glm::dvec3>> crop_outline(const LayerParams& layer, std::size_t crop);

}  // namespace astrosplat
