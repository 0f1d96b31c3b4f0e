// Optical depths are tabulated once for a falloff; a faint one takes three look-ups and no logarithm.
#include "core/real.h"
#include "merge/cut.h"
#include "render/footprint.h"

namespace astrosplat {
namespace {

/// Integral of -ln(1 - alpha w) over the unit disc. Panels shrink towards both ends of the radius.
double integrate_depth(const Falloff& falloff, double alpha) {
    constexpr double ends[] = {0.0, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 0.6, 1.0};
    return 2.0 * real::pi * integrate_falloff(falloff, ends, [&](double t) {
               return -t * real::log(1.0 - alpha * falloff_value(falloff, t));
           });
}

/// -ln(1 - x), x in [0, 1].
double log_of_rest(double x) {
    constexpr double few = 1.0 / 64.0;  // below, a series is as exact and takes a tenth of the time
    return x < few ? x * (1.0 + x * (0.5 + x * (1.0 / 3.0 + x * 0.25))) : -real::log(1.0 - x);
}

template <std::size_t size>
double interpolated(const std::array<double, size>& table, double at) {
    const std::size_t i = std::min(size - 2, std::size_t(at));
    return table[i] + (table[i + 1] - table[i]) * (at - double(i));
}

}  // namespace

DepthTable::DepthTable(const Falloff& falloff) : of_faint_(falloff_integral(falloff)) {
    ratio_[0] = of_faint_;
    for (int i = 1; i <= steps; ++i) {
        const double log = most_log * i / steps;
        ratio_[i] = integrate_depth(falloff, 1.0 - real::exp(-log)) / log;
    }
    most_depth_ = most_log * ratio_[steps];
    alpha_[0] = 1.0;
    for (int i = 1; i < steps; ++i) {
        const double x = double(i) / steps, depth = of_faint_ * x / (1.0 - x);
        double low = 0.0, high = most_log;
        for (int k = 0; k < 40; ++k) {
            const double log = 0.5 * (low + high);
            (log * interpolated(ratio_, log * (steps / most_log)) < depth ? low : high) = log;
        }
        alpha_[i] = (1.0 - real::exp(-low)) / x;
    }
    alpha_[steps] = 1.0;
}

double DepthTable::depth(double alpha) const {
    const double log = std::min(most_log, log_of_rest(alpha));
    return log * interpolated(ratio_, log * (steps / most_log));
}

double DepthTable::alpha(double depth) const {
    if (!(depth < most_depth_)) return 1.0;
    const double x = depth / (depth + of_faint_);
    return x * interpolated(alpha_, x * steps);
}

}  // namespace astrosplat
