// Footprints on the sphere that are not round there. In: an ellipsoid or an ellipse of the frame, and the
// place where it appears. Out: its outline on Lambert's equal-area map around its direction, and the round
// footprint with the way from that map to the footprint's plane.
//
// On the map an ellipse is one of the plane, and light that is right there is right as solid angle; a circle
// of the map is a circle of chords, so round shapes are drawn as round splats are. Footprints are small
// against what they are seen from, as for EWA (Zwicker et al. 2001); poles and seams are places as others.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "camera/lens.h"
#include "render/shape.h"

namespace astrosplat {

/// The map's axes at a place of the frame, unit vectors in camera space across `toward`, which is seen there;
/// and what the frame makes of a px of the sphere along each, px, y down. Along a fisheye's radius and around
/// it; to the east and the north of a panorama. bend_x, bend_y: how great circles bend on the frame, the
/// second derivatives of its coordinates along both axes, mixed and along the second, per px.
struct SphereAxes {
    glm::dvec3 toward, first, second;
    glm::dvec2 first_px, second_px;
    glm::dvec3 bend_x, bend_y;
};
SphereAxes sphere_axes(const Lens& lens, double x_px, double y_px);
/// The same to about six digits from nothing but where directions appear, with `first` to the right on the
/// frame: for projections that have no formulas here.
SphereAxes sphere_axes_by_differences(const Lens& lens, double x_px, double y_px);

/// The outline of an ellipsoid on the map: the unit ball under `ellipsoid` (columns in camera space, scene
/// units), of which px_per_unit are px of the sphere. Axes are those of its own direction.
Shape project_onto_sphere(const SphereAxes& axes, const glm::mat3& ellipsoid, float px_per_unit);

/// The outline on the map of what the frame shows as `on_frame`.
Shape onto_sphere(const SphereAxes& axes, const Shape& on_frame);
/// How many px of the frame the place has for one of the sphere.
double frame_area(const SphereAxes& axes);

/// A footprint over places on the map, px, which are mapped by two rows first: unit vectors in camera space
/// but for the stretch.
struct SphereFootprint {
    Footprint round;
    glm::vec3 rows[2];
};
/// As shaped_footprint_at; the sum over all pixels is one of solid angles, px of the sphere. The table needs
/// the nodes up to sphere_spectrum_px.
SphereFootprint shaped_sphere_footprint_at(const FootprintTable& table, const Lens& lens, const Shape& shape,
                                           float x_px, float y_px);

}  // namespace astrosplat
