// Numbers that a drag makes, without digits that nobody chose.
#pragma once

namespace astrosplat {

/// `value` without the digits that a step this small cannot mean.
double rounded_to_step(double value, double step);

}  // namespace astrosplat
