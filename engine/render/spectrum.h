// Spectra of footprints that the frame shows stretched: what their sum over pixels has in excess of their
// light. In: a footprint table, a radius, and how the frame stretches it. Out: the excess.
#pragma once

#include "render/footprint.h"

namespace astrosplat {

/// Beyond this radius a table has no spectrum: footprint.cpp's ripple_limit_px and a node more.
constexpr double spectrum_end_px = 33.0;
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

}  // namespace astrosplat
