// Footprints on the sphere, for projections onto it. In: the lens, places on the frame, and for those that
// are not round an ellipsoid or an ellipse of the frame. Out: directions, outlines, and footprints with the
// right light whatever the projection makes of their pixels.
//
// Round ones are round on the sphere, in px of the middle of the frame along the chords between directions.
// The others are ellipses on Lambert's equal-area map around their direction, and light that is right there
// is right as solid angle; a circle of the map is a circle of chords, so round shapes are drawn as round
// splats are. Footprints are small against what they are seen from, as for EWA (Zwicker et al. 2001); poles
// and seams are places as others.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "camera/lens.h"
#include "render/fold.h"
#include "render/footprint.h"
#include "render/shape.h"

namespace astrosplat {

/// Sets planes.toward: of each pixel the direction through its middle, camera space, of length focal_px; far
/// away from everything where the frame shows nothing.
void set_directions(const Lens& lens, TilePlanes& planes);

/// The footprint of a splat whose place on the frame is (x_px, y_px), snapped to 1/256 px; its radius is in
/// px of the middle of the frame. The sum of its weights times the solid angles of their pixels, in the same
/// unit, is the falloff's integral * radius_px^2. The table needs the nodes up to sphere_spectrum_px.
Footprint sphere_footprint_at(const FootprintTable& table, const Lens& lens, float radius_px, float x_px,
                              float y_px);

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
