// Light as a sum of Gaussians that share their centre and angle, in two families of one axis ratio each (a
// multi-Gaussian expansion, Cappellari 2002, MNRAS 333, 400). In: a small image. Out: amplitudes, none below
// 0, and the light of the sum.
#pragma once

#include "core/image.h"

namespace astrosplat {

/// Two families of ellipses. Lengths in px, the first pixel's middle at (0, 0).
struct Ellipses {
    double x = 0.0, y = 0.0;
    double angle = 0.0;                 // of the major axis, radians from right towards down
    double disk = 0.5, spheroid = 0.8;  // axis ratios as seen
};

/// A place along the major axis and across it, px.
struct AlongEllipses {
    double u, v;
};
AlongEllipses along(const Ellipses& e, double x, double y);

/// Standard deviations along the major axis, each `(to / from)^(1 / (count - 1))` times the one before.
std::vector<double> geometric(double from, double to, int count);

/// Values of the disk's Gaussians, the spheroid's and a constant at every pixel, those of one pixel side by
/// side: 2 sigmas + 1 of them.
struct GaussianBasis {
    int count = 0;
    std::vector<float> values;
    std::span<const float> of(std::size_t pixel) const {
        return {values.data() + pixel * std::size_t(count), std::size_t(count)};
    }
};
GaussianBasis basis_of(const Ellipses& e, const Image& light, const std::vector<double>& sigmas);

/// Amplitudes, as many as the basis has, whose sum is nearest to `light` (one channel) in weighted squares,
/// with none below 0 and those 0 that are not `allowed`. The same bits with any number of threads.
std::vector<double> nonnegative_amplitudes(const GaussianBasis& basis, const Image& light,
                                           const std::vector<double>& weights,
                                           const std::vector<bool>& allowed);

/// The light of the sum at every pixel.
std::vector<double> sum_of(const GaussianBasis& basis, const std::vector<double>& amplitudes);

}  // namespace astrosplat
