// How the bodies of a picture lie: the plane of a galaxy's disk, or the equator of a nebula about an axis, as
// a ring in the picture with handles. In: a layer whose picture lies on the built-in plane, before its own
// camera. Out: lines in the world, and what dragging a handle changes. Draws nothing.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "camera/camera.h"
#include "edit/placement.h"
#include "scene/scene.h"

namespace astrosplat {

/// A ring around a body, one of its layer's.
struct LyingRing {
    std::string key;          // what its values are below: "layer.m77.source.structure"
    bool about_axis = false;  // it is an equator
    /// Degrees from the picture's plane, 0..90; of an equator 90 less its axis' tilt, 10..170.
    double inclination = 0.0;
    double near_deg = 90.0;  // direction in the picture of what is nearer, counter-clockwise from right
    glm::dvec2 center{0.0};  // scene units of the layer from the picture's middle, right and up
    double radius = 1.0;     // scene units of the layer
    double distance = 10.0;  // of the picture's camera from the picture
    LayerPlacement placement;
    bool operator==(const LyingRing&) const = default;
};

/// Of a ring, below its key.
inline constexpr std::array lying_keys{"inclination", "position_angle", "center",
                                       "near_side",   "axis_angle",     "tilt"};

/// Those of a layer that say how they lie; empty where its picture lies otherwise.
std::vector<LyingRing> lying_rings(const Scene& now, std::size_t layer);

/// A point of the ring, degrees from its major axis towards what is nearer; from the picture's camera it is
/// seen where the ellipse in the picture has it.
glm::dvec3 point_on(const LyingRing& ring, double degrees);
/// Where its axis, as long as the radius, ends: of an equator the end that the scene says of it.
glm::dvec3 axis_end(const LyingRing& ring);
/// What a ring is taken by: marks beside the minor axis' ends, which say what is nearer, and both axes' ends.
struct LyingGrip {
    enum class Of { none, near, far, minor, minor_far, major, major_other } of = Of::none;
    std::size_t ring = 0;
    bool operator==(const LyingGrip&) const = default;
    bool is_mark() const { return of == Of::near || of == Of::far; }
};
/// By Of: its name, where it is on the ring, what it does to a disk and to an equator, which has no marks:
/// its tilt says that.
struct LyingGripKind {
    const char* name;
    double degrees;
    const char *of_disk, *of_equator;
};
inline constexpr LyingGripKind lying_grips[] = {
    {"", 0.0, "", nullptr},
    {"near", 90.0, "The nearer side. Click, or drag across: the other one is", nullptr},
    {"far", 270.0, "Click: this side is the nearer one", nullptr},
    {"minor", 90.0, "Drag: inclination", "Drag: tilt of the axis"},
    {"minor far", 270.0, "Drag: inclination", "Drag: tilt of the axis"},
    {"major", 0.0, "Drag: position angle", "Drag: direction of the axis"},
    {"major other", 180.0, "Drag: position angle", "Drag: direction of the axis"}};

/// Those that a ring has, in px; none of what the camera does not see.
struct SeenGrip {
    LyingGrip::Of of;
    glm::dvec2 px;
};
std::vector<SeenGrip> grips_of(const Camera& camera, const LyingRing& ring);
LyingGrip grip_at(const Camera& camera, std::span<const LyingRing> rings, const glm::dvec2& mouse_px,
                  double reach_px);

/// The ring as a drag leaves it, from one place of the mouse to another, px: the minor axis' ends turn it
/// from the picture's plane, those of the major axis in there, and the mark goes to the nearer of both sides.
LyingRing dragged(const LyingRing& pressed, LyingGrip::Of of, const Camera& camera, const glm::dvec2& from_px,
                  const glm::dvec2& to_px);
/// With what was nearer farther away.
LyingRing turned_over(LyingRing ring);

/// The parameters that differ, rounded to a tenth of a degree.
std::vector<NewValue> changed_values(const LyingRing& before, const LyingRing& after);
/// "Inclination 62.0 degrees, position angle 30.0".
std::string lying_in_words(const LyingRing& ring);

}  // namespace astrosplat
