#include "edit/rounding.h"

#include <cmath>
#include <cstdlib>

namespace astrosplat {

double rounded_to_step(double value, double step) {
    if (!(step > 0.0)) return value;
    const int digits = static_cast<int>(std::floor(std::log10(step)));
    // Dividing by a whole power of ten gives the double nearest to the short decimal; multiplying by 0.001
    // does not.
    const double power = std::pow(10.0, std::abs(digits));
    const double rounded = digits < 0 ? std::round(value * power) / power : std::round(value / power) * power;
    return rounded + 0.0;  // never -0
}

}  // namespace astrosplat
