// Weights are plain loops over a few dots, which the compiler turns into vectors; then each dot adds nine
// vectors.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bodies/spread_kernel.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

#include <algorithm>

#include "bodies/spread_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

constexpr std::size_t block = 64;

struct Block {
    std::int32_t column[block], row[block];  // of the pixel that the dot lies in
    float across[3][block], down[3][block];  // weights of that pixel and of its neighbours
    alignas(16) float light[block][4];
};

// Quadratic B-spline weights of the step that a place >= 0 lies in and of its neighbours.
HWY_FLATTEN void weigh(const float* HWY_RESTRICT place, std::size_t count, std::int32_t* HWY_RESTRICT middle,
                       float (*HWY_RESTRICT weight)[block]) {
    for (std::size_t i = 0; i < count; ++i) {
        middle[i] = static_cast<std::int32_t>(place[i]);
        const float t = place[i] - static_cast<float>(middle[i]) - 0.5f;
        weight[0][i] = 0.5f * (0.5f - t) * (0.5f - t);
        weight[1][i] = 0.75f - t * t;
        weight[2][i] = 0.5f * (0.5f + t) * (0.5f + t);
    }
}

HWY_FLATTEN void fill(const SpreadDots& dots, std::size_t first, std::size_t count, Block& out) {
    float x[block], y[block];
    for (std::size_t i = 0; i < count; ++i) {
        x[i] = (dots.position[first + i].x + dots.left) * dots.scale;
        y[i] = (dots.top - dots.position[first + i].y) * dots.scale;
        const float share = dots.flux * dots.alpha[first + i];
        for (int c = 0; c < 3; ++c) out.light[i][c] = dots.color[first + i][c] * share;
        out.light[i][3] = 0.0f;
    }
    weigh(x, count, out.column, out.across);
    weigh(y, count, out.row, out.down);
}

}  // namespace

HWY_FLATTEN void spread_dots_here(const SpreadDots& dots, SpreadRows& rows) {
    const hn::CappedTag<float, 4> channels;
    const std::int64_t next_row = 4 * rows.pixels.width;
    Block now;
    const auto spread = [&](std::size_t i, std::size_t channel) {
        const auto light = hn::Load(channels, now.light[i] + channel);
        const auto left = hn::Mul(light, hn::Set(channels, now.across[0][i])),
                   middle = hn::Mul(light, hn::Set(channels, now.across[1][i])),
                   right = hn::Mul(light, hn::Set(channels, now.across[2][i]));
        float* to =
            rows.pixels.at(now.column[i] + rows.margin - 1, now.row[i] - rows.first + rows.margin - 1) +
            channel;
        for (int j = 0; j < 3; ++j, to += next_row) {
            const auto down = hn::Set(channels, now.down[j][i]);
            hn::Store(hn::Add(hn::Load(channels, to), hn::Mul(left, down)), channels, to);
            hn::Store(hn::Add(hn::Load(channels, to + 4), hn::Mul(middle, down)), channels, to + 4);
            hn::Store(hn::Add(hn::Load(channels, to + 8), hn::Mul(right, down)), channels, to + 8);
        }
    };
    for (std::size_t first = 0; first < dots.count; first += block) {
        const std::size_t count = std::min(block, dots.count - first);
        fill(dots, first, count, now);
        for (std::size_t i = 0; i < count; ++i)
            if (now.row[i] >= rows.first - 1 && now.row[i] <= rows.end)
                for (std::size_t channel = 0; channel < 4; channel += hn::Lanes(channels)) spread(i, channel);
    }
}

}  // namespace astrosplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(spread_dots_here);

void spread_dots(const SpreadDots& dots, SpreadRows& rows) {
    HWY_DYNAMIC_DISPATCH(spread_dots_here)(dots, rows);
}

SpreadRows::SpreadRows(std::int64_t grid_width, std::int64_t first_row, std::int64_t end_row)
    : width(grid_width),
      first(first_row),
      end(end_row),
      pixels(make_image(grid_width + 2 * margin, end_row - first_row + 2 * margin, 4)) {}

void SpreadRows::add_to(Image& sum) const {
    for (std::int64_t row = first - 1; row <= end; ++row) {
        const std::int64_t to = std::clamp<std::int64_t>(row, 0, sum.height - 1);
        if (to < first || to >= end) continue;
        const float* const here = pixels.at(margin, row - first + margin);
        float* const there = sum.at(0, to);
        const auto add = [&](std::int64_t column, std::int64_t to_column) {
            for (int channel = 0; channel < 3; ++channel)
                there[3 * to_column + channel] += here[4 * column + channel];
        };
        add(-1, 0);
        for (std::int64_t column = 0; column < width; ++column) add(column, column);
        add(width, width - 1);
    }
}

}  // namespace astrosplat
#endif  // HWY_ONCE
