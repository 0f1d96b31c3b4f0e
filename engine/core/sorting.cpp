#include "core/sorting.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace astrosplat {

double percentile(std::vector<double> values, double share) {
    if (values.empty()) return 0.0;
    const double rank = share * static_cast<double>(values.size() - 1), below = std::floor(rank);
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(below);
    std::nth_element(values.begin(), at, values.end());
    if (rank == below) return *at;
    return *at + (*std::min_element(at + 1, values.end()) - *at) * (rank - below);
}

}  // namespace astrosplat
