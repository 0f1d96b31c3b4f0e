// Percentiles of a list of numbers.
#pragma once

#include <vector>

namespace astrosplat {

/// The value below which the given share (0..1) of the numbers lies, linear between neighbours: 0 gives the
/// least, 1 the greatest, 1/2 the median. 0 for an empty list; NaN must not occur.
double percentile(std::vector<double> values, double share);

}  // namespace astrosplat
