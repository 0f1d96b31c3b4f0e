// Data values of a telescope picture as numbers from 0 (black) to 1 (white).
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "source/source.h"

namespace astrosplat {

/// Of the finite ones among the values. All zero when there are none.
struct ValueRange {
    double min = 0.0, max = 0.0;
    double black = 0.0;  // 0.25 percentile
    double white = 0.0;  // 99.75 percentile
};

/// Percentiles are exact, interpolated linearly between ranks p (n - 1) as numpy does.
ValueRange value_range(std::span<const double> values);

/// The same of values that need not be held: `hand_out` gives all of them to its argument, in parts. It is
/// called five times.
using ValueTaker = std::function<void(std::span<const double>)>;
ValueRange value_range(const std::function<void(const ValueTaker& take)>& hand_out);

struct Limits {
    double black = 0.0;
    double white = 1.0;
};

/// The limits settings ask for, the percentiles where they leave them open. Both are finite and black <
/// white: a picture of one value gets white = black + 1. Throws InputError, naming `file`, when set limits
/// contradict that.
Limits choose_limits(const ValueRange& range, const TextureSettings& settings, const std::string& file);

/// x = (value - black) / (white - black) cut to [0, 1]; then linear x, asinh(x / softening) / asinh(1 /
/// softening) or log(1000 x + 1) / log(1001) (ds9's). NaN stays NaN. `stretch` is not automatic.
double stretched(double value, const Limits& limits, TextureSettings::Stretch stretch, double softening);

/// The same for many values.
class StretchCurve {
  public:
    StretchCurve(const Limits& limits, TextureSettings::Stretch stretch, double softening);
    double operator()(double value) const;

  private:
    Limits limits_;
    TextureSettings::Stretch stretch_;
    double softening_;
    double of_white_ = 1.0;  // what the curve makes of 1 before it is scaled
};

}  // namespace astrosplat
