#include "render/falloff.h"

#include <cmath>

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

FalloffTraits traits_of(const Falloff& falloff) {
    using Shape = Falloff::Shape;
    constexpr double exponent = 11.5, steep = 8.0;  // e^-11.5 = 1e-5
    const double core = falloff.core, sharpness = falloff.sharpness;
    const double decay = std::min(1.0, exponent / sharpness);  // where exponential carries no more
    switch (falloff.shape) {
        case Shape::constant:
            return {.flat_core = true, .core = 1.0f, .linear_in_distance = false};
        case Shape::linear:
            return {};
        case Shape::trapezoid:
            return {.flat_core = true,
                    .core = falloff.core,
                    .kinks = core > 0.0 && core < 1.0 ? std::vector{core} : std::vector<double>{}};
        case Shape::gaussian:
            return {.reach = static_cast<float>(std::sqrt(decay)),
                    .linear_in_distance = false,
                    .steep_centre = sharpness > steep};
        case Shape::exponential:
            return {.reach = static_cast<float>(decay), .steep_centre = sharpness > steep};
    }
    return {};
}

double falloff_integral(const Falloff& falloff) {
    return 2.0 * real::pi * integral_with(falloff, [](double t) { return t; });
}

double falloff_variance(const Falloff& falloff) {
    return real::pi * integral_with(falloff, [](double t) { return t * t * t; }) / falloff_integral(falloff);
}

}  // namespace astrosplat
