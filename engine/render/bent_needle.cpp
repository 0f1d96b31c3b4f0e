#include "render/bent_needle.h"

#include <cmath>

#include "core/real.h"
#include "render/footprint.h"

namespace astrosplat {
namespace {

/// Second derivative of a coordinate along the needle.
double bend_of(const glm::dvec3& bend, const Ellipse& e) {
    return e.x * e.x * bend.x + 2.0 * e.x * e.y * bend.y + e.y * e.y * bend.z;
}

}  // namespace

BentNeedle::BentNeedle(const SphereAxes& axes, const Ellipse& e, double along_variance,
                       double across_variance)
    : along_(along_variance),
      across_(across_variance),
      along_px_(e.x * axes.first_px + e.y * axes.second_px),
      across_px_(e.x * axes.second_px - e.y * axes.first_px),
      bend_(bend_of(axes.bend_x, e), bend_of(axes.bend_y, e)) {}

double BentNeedle::excess(float x_px, float y_px) const {
    const double turns = 2.0 * real::pi * along_ * (std::fabs(bend_.x) + std::fabs(bend_.y));
    if (across_ > 1.0 || turns < 0.02) return 0.0;  // wide ones have none; short ones do not bend
    const double cx = pixel_cosine(x_px), cy = pixel_cosine(y_px);
    const double sx = pixel_cosine(x_px - 0.25f), sy = pixel_cosine(y_px - 0.25f);
    return 2.0 * (excess_at(1, 0, cx, sx) + excess_at(0, 1, cy, sy) +
                  excess_at(1, 1, cx * cy - sx * sy, sx * cy + cx * sy) +
                  excess_at(1, -1, cx * cy + sx * sy, sx * cy - cx * sy) +
                  excess_at(2, 0, cx * cx - sx * sx, 2.0 * sx * cx) +
                  excess_at(0, 2, cy * cy - sy * sy, 2.0 * sy * cy));
}

/// The part of the frequency (kx, ky) cycles per px, whose phase at the middle has this cosine and sine:
/// the spectrum of a gaussian whose places go with the square of the way is that of one with a complex
/// variance, along_ / (1 + i t).
double BentNeedle::excess_at(double kx, double ky, double cosine, double sine) const {
    const double turn = 2.0 * real::pi * real::pi;
    const double g = kx * along_px_.x + ky * along_px_.y, h = kx * across_px_.x + ky * across_px_.y;
    const double t = 2.0 * real::pi * along_ * (kx * bend_.x + ky * bend_.y), size = 1.0 + t * t;
    const double thin = real::exp(-turn * h * h * across_), exponent = turn * g * g * along_;
    // 1 / sqrt(1 + i t): half the angle, the root of the length.
    const double root = std::sqrt(size), re = std::sqrt(0.5 * (1.0 + 1.0 / root) / root),
                 im = -0.5 * t / (size * re);
    const double phase = exponent * t / size, c = real::cos(phase), s = real::sin(phase);
    const double bent = thin * real::exp(-exponent / size);
    return bent * ((re * c - im * s) * cosine + (re * s + im * c) * sine) -
           thin * real::exp(-exponent) * cosine;
}

}  // namespace astrosplat
