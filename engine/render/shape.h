// Footprints that are not round: an ellipsoid seen through a camera is an ellipse, drawn with the profile
// of a round footprint. In: the ellipse in px. Out: the round footprint, and how its plane is reached from
// the frame's.
//
// The profile is that of the ellipse's smaller radius, stretched along the larger one so that its variance is
// the falloff's and the pixel filter's together: exact for a gaussian, as EWA (Zwicker et al. 2001). Of other
// falloffs the edge is softer at the tips, and a needle thinner than the filter is a gaussian along its
// length. The light over all pixels is right by the closed form that round footprints have: the spectrum of
// the stretched profile says what its sum over pixels has in excess.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "camera/lens.h"
#include "render/footprint.h"
#include "render/screen_splat.h"

namespace astrosplat {

/// Footprints on the sphere are normalised up to this radius, with the nodes up to it.
constexpr float sphere_spectrum_px = 33.0f;

/// A symmetric matrix: the frame's px per px of the profile's own plane, times its transpose.
struct PixelStretch {
    double xx = 1.0, xy = 0.0, yy = 1.0;
};

/// Spectra of a stretched profile and of its P (1 - P), relative to their masses. A table's spectrum of a
/// radius at one cycle per px is the falloff's at that many cycles per radius times the filter's at 1: so it
/// serves all frequencies.
class Spectrum {
  public:
    Spectrum(const FootprintTable& table, double radius_px, const PixelStretch& stretch);
    /// Relative excess over all pixels; the centre's phases are those of pixel_cosine.
    double ripple(bool of_edge, float x_px, float y_px) const;

  private:
    double value(bool of_edge, double kx, double ky) const;

    const FootprintTable& table_;
    double radius_;
    PixelStretch stretch_;
    double filter_;
};

/// The outline that rows of a matrix give, which say how far the unit ball's axes reach across and down.
Shape outline_of(const glm::dvec3& across, const glm::dvec3& down);

/// The footprint of an ellipsoid: the unit ball under `ellipsoid` (columns in camera space, scene units) at
/// p. What px_per_unit makes of a ball's radius it makes of the ellipsoid's outline as seen along the ray.
Shape project_ellipsoid(const Lens& lens, const glm::vec3& p, const glm::mat3& ellipsoid, float px_per_unit);

/// The footprint of an ellipsoid under the affine approximation of the frame at p (EWA: Zwicker et al. 2001),
/// in perspective; `slope` is where p / depth counts as being: outside the frame, what would come out is far
/// too long.
Shape project_affine(const glm::vec2& slope, const glm::mat3& ellipsoid, float px_per_unit);

/// A shape by its radii, px, and the direction of the larger one.
struct Ellipse {
    double larger, smaller, x, y;
};
Ellipse ellipse_of(const Shape& shape);

/// How much longer the profile of the smaller radius is made along the larger one;
/// `variance` as in FootprintTable.
double stretch_of(const Ellipse& e, double variance, double filter_px);

/// Values that the reach of a footprint depends on, besides its shape: as in FootprintTable.
struct FootprintExtent {
    float reach, margin_px, variance;
};
/// Distance from the centre beyond which all weights are 0.
float shape_support_px(const Shape& shape, const FootprintExtent& extent);

/// A footprint over offsets from the centre that are mapped by a symmetric matrix first; `xx` and `yy` are 1
/// and `xy` 0 where it is round.
struct ShapedFootprint {
    Footprint round;
    float xx = 1.0f, xy = 0.0f, yy = 1.0f;
};
/// x_px, y_px: the centre, snapped to 1/256 px. The table needs the nodes for the radii of node_range.
ShapedFootprint shaped_footprint_at(const FootprintTable& table, const Shape& shape, float x_px, float y_px);

/// The gains that bring a stretched profile to the light `wanted`, square px; all its pixels add up to
/// `profile`, those of P (1 - P) to `edge`.
struct StretchedSums {
    double profile, edge;
};
void set_gains(const FootprintTable& table, double wanted, const StretchedSums& found, Footprint& f);

/// Least and largest radius whose nodes a shape's footprint asks for, px.
struct NodeRange {
    float least_px, largest_px;
};
NodeRange node_range(const Shape& shape);

}  // namespace astrosplat
