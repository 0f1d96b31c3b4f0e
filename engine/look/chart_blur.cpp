#include "look/chart_blur.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/real.h"
#include "image/weighted_rows.h"

namespace astrosplat {
namespace {

constexpr double cut_at = 3.0;  // sigma

std::vector<float> gaussian_taps(double sigma, bool squared) {
    const auto reach = static_cast<std::int64_t>(std::ceil(cut_at * sigma - 1e-9));
    std::vector<double> weights;
    double sum = 0.0;
    for (std::int64_t k = -reach; k <= reach; ++k) {
        const double t = reach > 0 ? static_cast<double>(k) / sigma : 0.0;
        weights.push_back(real::exp(-0.5 * t * t));
        sum += weights.back();
    }
    std::vector<float> taps;
    for (const double w : weights)
        taps.push_back(static_cast<float>(squared ? w / sum * (w / sum) : w / sum));
    return taps;
}

std::int64_t reach_of(const std::vector<float>& taps) { return static_cast<std::int64_t>(taps.size() / 2); }

}  // namespace

ChartBlur::ChartBlur(const PictureChart& chart, bool squared) : chart_(chart) {
    for (const ChartBlock& block : chart.blocks) {
        taps_u_.push_back(gaussian_taps(block.sigma_u, squared));
        taps_v_.push_back(gaussian_taps(block.sigma_v, squared));
        reach_ = std::max({reach_, reach_of(taps_u_.back()), reach_of(taps_v_.back())});
    }
    between_.resize(static_cast<std::size_t>(chart.cells()));
}

void ChartBlur::operator()(CellValues& values) {
    along_rows(values, between_);
    along_columns(between_, values);
}

void ChartBlur::along_rows(const CellValues& from, CellValues& to) const {
    const std::int64_t columns = chart_.columns, rows = chart_.rows;
    parallel_chunks(chart_.meshes * rows, 16, [&](std::int64_t begin, std::int64_t end, int) {
        std::vector<float> padded(static_cast<std::size_t>(columns + 2 * reach_));
        std::vector<const float*> shifted;
        for (std::int64_t y = begin; y < end; ++y) {
            std::copy_n(from.data() + y * columns, columns, padded.begin() + reach_);
            const std::int64_t first =
                (y / rows * chart_side + PictureChart::block_at(y % rows, rows)) * chart_side;
            for (std::int64_t b = 0; b < chart_side; ++b) {
                const std::int64_t x = PictureChart::block_begin(b, columns);
                const Taps& taps = taps_u_[static_cast<std::size_t>(first + b)];
                shifted.clear();
                for (std::int64_t k = 0; k < static_cast<std::int64_t>(taps.size()); ++k)
                    shifted.push_back(padded.data() + reach_ + x + k - reach_of(taps));
                weighted_rows(taps, shifted, PictureChart::block_begin(b + 1, columns) - x,
                              to.data() + y * columns + x);
            }
        }
    });
}

void ChartBlur::along_columns(const CellValues& from, CellValues& to) const {
    const std::int64_t columns = chart_.columns, rows = chart_.rows;
    const std::vector<float> nothing(static_cast<std::size_t>(columns));
    parallel_chunks(chart_.meshes * rows, 16, [&](std::int64_t begin, std::int64_t end, int) {
        std::vector<const float*> shifted;
        for (std::int64_t y = begin; y < end; ++y) {
            const std::int64_t mesh = y / rows;
            const std::int64_t first =
                (mesh * chart_side + PictureChart::block_at(y % rows, rows)) * chart_side;
            for (std::int64_t b = 0; b < chart_side; ++b) {
                const std::int64_t x = PictureChart::block_begin(b, columns);
                const Taps& taps = taps_v_[static_cast<std::size_t>(first + b)];
                shifted.clear();
                for (std::int64_t k = 0; k < static_cast<std::int64_t>(taps.size()); ++k) {
                    const std::int64_t row = y + k - reach_of(taps);
                    const bool there = row >= mesh * rows && row < (mesh + 1) * rows;
                    shifted.push_back((there ? from.data() + row * columns : nothing.data()) + x);
                }
                weighted_rows(taps, shifted, PictureChart::block_begin(b + 1, columns) - x,
                              to.data() + y * columns + x);
            }
        }
    });
}

}  // namespace astrosplat
