#include "render/spectrum.h"

#include <cmath>

#include "core/real.h"

namespace astrosplat {

Spectrum::Spectrum(const FootprintTable& table, double radius_px, const PixelStretch& stretch)
    : table_(table),
      radius_(radius_px),
      stretch_(stretch),
      filter_(2.0 * real::pi * real::pi * double(table.pixel_filter_px) * table.pixel_filter_px) {}

double Spectrum::ripple(bool of_edge, float x_px, float y_px) const {
    const double cx = pixel_cosine(x_px), cy = pixel_cosine(y_px);
    const double sx = pixel_cosine(x_px - 0.25f), sy = pixel_cosine(y_px - 0.25f);
    const auto at = [&](double kx, double ky) { return value(of_edge, kx, ky); };
    return 2.0 *
           (at(1, 0) * cx + at(0, 1) * cy + at(1, 1) * (cx * cy - sx * sy) + at(1, -1) * (cx * cy + sx * sy) +
            at(2, 0) * (2.0 * cx * cx - 1.0) + at(0, 2) * (2.0 * cy * cy - 1.0));
}

/// At (kx, ky) cycles per px. That of the edge is not the same shape at all radii: only the filter's part is.
double Spectrum::value(bool of_edge, double kx, double ky) const {
    const double squared = kx * kx * stretch_.xx + 2.0 * kx * ky * stretch_.xy + ky * ky * stretch_.yy;
    const double exponent = filter_ * (1.0 - squared);
    if (exponent < -16.0) return 0.0;  // 1e-7
    const double radius = of_edge ? radius_ : radius_ * std::sqrt(squared);
    if (radius > spectrum_end_px) return 0.0;
    const FootprintNodes nodes = footprint_nodes(table_, static_cast<float>(radius));
    const auto spectrum = [&](const FootprintNode* node) {
        return double(of_edge ? node->moments.edge_ripple[0] : node->moments.ripple[0]);
    };
    const double a = spectrum(nodes.a), b = spectrum(nodes.b);
    return (a + (b - a) * double(nodes.t)) * real::exp(exponent);
}

}  // namespace astrosplat
