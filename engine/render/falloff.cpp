#include "render/falloff.h"

#include <array>

#include "core/quadrature.h"
#include "core/real.h"
#include "render/shared_render.h"

namespace astrosplat {

double falloff_value(const Falloff& falloff, double t) {
    return shared::falloff_weight(static_cast<int>(falloff.shape), falloff.core, falloff.sharpness,
                                  static_cast<float>(t));
}

namespace {

/// Integral of w(t) f(t) from 0 to 1. Panels shrink towards the centre, where sharp exponentials have all
/// their light; the core's end is a kink.
template <class F>
double integrate_falloff(const Falloff& falloff, F&& f) {
    constexpr std::array<double, 7> ends = {0.0, 0.01, 0.03, 0.1, 0.3, 0.6, 1.0};
    const double kink = falloff.shape == Falloff::Shape::trapezoid ? falloff.core : 0.0;
    const auto ring = [&](double t) { return falloff_value(falloff, t) * f(t); };
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const double split = kink > ends[i] && kink < ends[i + 1] ? kink : ends[i];
        sum += integrate_panel(ends[i], split, ring) + integrate_panel(split, ends[i + 1], ring);
    }
    return sum;
}

}  // namespace

double falloff_integral(const Falloff& falloff) {
    return 2.0 * real::pi * integrate_falloff(falloff, [](double t) { return t; });
}

double falloff_variance(const Falloff& falloff) {
    return real::pi * integrate_falloff(falloff, [](double t) { return t * t * t; }) /
           falloff_integral(falloff);
}

}  // namespace astrosplat
