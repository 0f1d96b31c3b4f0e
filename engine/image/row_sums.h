// Sums over images whose bits do not depend on the number of threads.
#pragma once

#include <cstdint>
#include <vector>

#include "core/parallel.h"

namespace astrosplat {

/// The sum of row(y) for y in [0, height): rows on all threads, their sums in order.
template <class Row>
double sum_over_rows(std::int64_t height, const Row& row) {
    std::vector<double> sums(static_cast<std::size_t>(height));
    parallel_each(height, 16, [&](std::int64_t y) { sums[static_cast<std::size_t>(y)] = row(y); });
    double sum = 0.0;
    for (const double s : sums) sum += s;
    return sum;
}

}  // namespace astrosplat
