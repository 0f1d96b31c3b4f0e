#include "fidelity/flux.h"

#include <cassert>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "core/sorting.h"

namespace astrosplat {
namespace {

using ChannelSums = std::array<double, 3>;

ChannelSums cell_light(const Image& image, std::int64_t column, std::int64_t row) {
    ChannelSums sums{};
    const auto begin = [](std::int64_t cell, std::int64_t size) { return cell * size / flux_cells; };
    for (std::int64_t y = begin(row, image.height); y < begin(row + 1, image.height); ++y)
        for (std::int64_t x = begin(column, image.width); x < begin(column + 1, image.width); ++x)
            for (int c = 0; c < 3; ++c) sums[static_cast<std::size_t>(c)] += image.at(x, y)[c];
    return sums;
}

std::vector<ChannelSums> light_of_cells(const Image& image) {
    std::vector<ChannelSums> cells(static_cast<std::size_t>(flux_cells * flux_cells));
    parallel_for(flux_cells, [&](std::int64_t row, int) {
        for (std::int64_t column = 0; column < flux_cells; ++column)
            cells[static_cast<std::size_t>(row * flux_cells + column)] = cell_light(image, column, row);
    });
    return cells;
}

double ratio(double light, double of) {
    return of > 0.0 ? light / of : std::numeric_limits<double>::quiet_NaN();
}

double total(const ChannelSums& sums) { return sums[0] + sums[1] + sums[2]; }

}  // namespace

FluxRatios flux_ratios(const Image& picture, const Image& reference) {
    assert(picture.width == reference.width && picture.height == reference.height);
    const std::vector<ChannelSums> ours = light_of_cells(picture), theirs = light_of_cells(reference);
    const double cell_samples =
        3.0 * static_cast<double>(picture.width * picture.height) / static_cast<double>(ours.size());
    FluxRatios result;
    ChannelSums our_sum{}, their_sum{};
    std::vector<double> lit;
    for (std::size_t i = 0; i < ours.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            our_sum[c] += ours[i][c];
            their_sum[c] += theirs[i][c];
        }
        const bool dark = total(theirs[i]) < darkest_cell * cell_samples;
        result.cells.push_back(dark ? std::numeric_limits<double>::quiet_NaN()
                                    : ratio(total(ours[i]), total(theirs[i])));
        if (!std::isnan(result.cells.back())) lit.push_back(result.cells.back());
    }
    for (std::size_t c = 0; c < 3; ++c) result.channels[c] = ratio(our_sum[c], their_sum[c]);
    result.frame = ratio(total(our_sum), total(their_sum));
    result.cells_5 = percentile(lit, 0.05);
    result.cells_50 = percentile(lit, 0.5);
    result.cells_95 = percentile(lit, 0.95);
    return result;
}

}  // namespace astrosplat
