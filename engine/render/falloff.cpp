#include "render/falloff.h"

#include "core/real.h"
#include "render/shared_render.h"

namespace astrosplat {
namespace {

/// Integral of w(t) f(t) from 0 to 1.
template <class F>
double integral_with(const Falloff& falloff, const F& f) {
    constexpr double ends[] = {0.0, 0.01, 0.03, 0.1, 0.3, 0.6, 1.0};
    return integrate_falloff(falloff, ends, [&](double t) { return falloff_value(falloff, t) * f(t); });
}

}  // namespace

double falloff_value(const Falloff& falloff, double t) {
    return shared::falloff_weight(static_cast<int>(falloff.shape), falloff.core, falloff.sharpness,
                                  static_cast<float>(t));
}

std::vector<double> falloff_kinks(const Falloff& falloff) {
    const double core = falloff.core;
    if (falloff.shape == Falloff::Shape::trapezoid && core > 0.0 && core < 1.0) return {core};
    return {};
}

double falloff_integral(const Falloff& falloff) {
    return 2.0 * real::pi * integral_with(falloff, [](double t) { return t; });
}

double falloff_variance(const Falloff& falloff) {
    return real::pi * integral_with(falloff, [](double t) { return t * t * t; }) / falloff_integral(falloff);
}

}  // namespace astrosplat
