// Percentiles by selection, and the three curves with the engine's own functions.
#include "source/stretch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/real.h"

namespace astrosplat {
namespace {

// Reorders the values.
double percentile(std::vector<double>& values, double fraction) {
    const double rank = fraction * static_cast<double>(values.size() - 1);
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::floor(rank));
    std::nth_element(values.begin(), at, values.end());
    const double part = rank - std::floor(rank);
    if (part == 0.0) return *at;
    const double next = *std::min_element(at + 1, values.end());
    return *at + (next - *at) * part;
}

}  // namespace

ValueRange value_range(std::span<const double> values) {
    std::vector<double> finite;
    finite.reserve(values.size());
    std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
                 [](double v) { return std::isfinite(v); });
    if (finite.empty()) return {};
    const auto [min, max] = std::ranges::minmax_element(finite);
    ValueRange range{*min, *max, 0.0, 0.0};
    range.black = percentile(finite, 0.0025);
    range.white = percentile(finite, 0.9975);
    return range;
}

Limits choose_limits(const ValueRange& range, const TextureSettings& settings, const std::string& file) {
    Limits limits{settings.black.value_or(range.black), settings.white.value_or(range.white)};
    const bool set = settings.black || settings.white;
    if (!set && !(limits.black < limits.white)) limits.white = limits.black + 1.0;
    if (!std::isfinite(limits.black) || !std::isfinite(limits.white) || !(limits.black < limits.white))
        bad_input(file, "", "a black point below the white point",
                  fmt::format("black = {} and white = {}", limits.black, limits.white));
    return limits;
}

StretchCurve::StretchCurve(const Limits& limits, TextureSettings::Stretch stretch, double softening)
    : limits_(limits), stretch_(stretch), softening_(softening) {
    assert(stretch != TextureSettings::Stretch::automatic);
    if (stretch == TextureSettings::Stretch::asinh) of_white_ = real::asinh(1.0 / softening);
    if (stretch == TextureSettings::Stretch::log) of_white_ = real::log(1001.0);
}

double StretchCurve::operator()(double value) const {
    if (std::isnan(value)) return value;
    const double x = std::clamp((value - limits_.black) / (limits_.white - limits_.black), 0.0, 1.0);
    if (stretch_ == TextureSettings::Stretch::asinh) return real::asinh(x / softening_) / of_white_;
    if (stretch_ == TextureSettings::Stretch::log) return real::log(1000.0 * x + 1.0) / of_white_;
    return x;
}

double stretched(double value, const Limits& limits, TextureSettings::Stretch stretch, double softening) {
    return StretchCurve(limits, stretch, softening)(value);
}

}  // namespace astrosplat
