// Splats of one size are one blur: they are spread over the pixels about them, the widest first, on a grid as
// coarse as their size allows, and blurred together with all wider ones. Corrections go the other way.
// Spreading is compiled once per instruction set, with the same bits on each: weights are plain loops over a
// few splats, which the compiler turns into vectors; then each splat adds nine vectors.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bodies/flat_light.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "bodies/front_fit.h"
#include "core/parallel.h"
#include "core/real.h"
#include "image/blur.h"
#include "image/channels.h"

#ifndef ASTROSPLAT_SPREAD_SPLATS  // the same for all targets
#define ASTROSPLAT_SPREAD_SPLATS
namespace astrosplat {

// Rows of a grid while light is added to them by quadratic B-splines. Pixels have four channels, so that each
// is stored and loaded as one vector; and there are more of them all around, for what splats at the edges
// spread.
struct SpreadRows {
    static constexpr std::int64_t margin = 2;
    std::int64_t width, first, end;  // px; rows [first, end)
    Image pixels = make_image(width + 2 * margin, end - first + 2 * margin, 4);
};

// Splats in the space of their picture, whose top left corner is at (-left, top).
struct SpreadSplats {
    const glm::vec3* position;
    const glm::vec3* color;
    const float* alpha;
    std::size_t count;
    float left, top;  // texels
    float scale;      // pixels a texel
    float flux;       // pixels: the sum of the weights of a splat
};

}  // namespace astrosplat
#endif

HWY_BEFORE_NAMESPACE();
namespace astrosplat::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

constexpr std::size_t block = 64;

struct Block {
    std::int32_t column[block], row[block];  // of the pixel that the splat lies in
    float across[3][block], down[3][block];  // weights of that pixel and of its neighbours
    alignas(16) float light[block][4];
};

// Quadratic B-spline weights of the step that a place >= 0 lies in and of its neighbours.
HWY_FLATTEN void weigh(const float* HWY_RESTRICT place, std::size_t count, std::int32_t* HWY_RESTRICT middle,
                       float (*HWY_RESTRICT weight)[block]) {
    for (std::size_t i = 0; i < count; ++i) {
        middle[i] = static_cast<std::int32_t>(place[i]);
        const float t = place[i] - float(middle[i]) - 0.5f;
        weight[0][i] = 0.5f * (0.5f - t) * (0.5f - t);
        weight[1][i] = 0.75f - t * t;
        weight[2][i] = 0.5f * (0.5f + t) * (0.5f + t);
    }
}

HWY_FLATTEN void fill(const SpreadSplats& splats, std::size_t first, std::size_t count, Block& out) {
    float x[block], y[block];
    for (std::size_t i = 0; i < count; ++i) {
        x[i] = (splats.position[first + i].x + splats.left) * splats.scale;
        y[i] = (splats.top - splats.position[first + i].y) * splats.scale;
        const float share = splats.flux * splats.alpha[first + i];
        for (int c = 0; c < 3; ++c) out.light[i][c] = splats.color[first + i][c] * share;
        out.light[i][3] = 0.0f;
    }
    weigh(x, count, out.column, out.across);
    weigh(y, count, out.row, out.down);
}

}  // namespace

// Adds the light of splats, as far as it reaches the rows.
HWY_FLATTEN void spread_splats(const SpreadSplats& splats, SpreadRows& rows) {
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
    for (std::size_t first = 0; first < splats.count; first += block) {
        const std::size_t count = std::min(block, splats.count - first);
        fill(splats, first, count, now);
        for (std::size_t i = 0; i < count; ++i)
            if (now.row[i] >= rows.first - 1 && now.row[i] <= rows.end)
                for (std::size_t channel = 0; channel < 4; channel += hn::Lanes(channels)) spread(i, channel);
    }
}

}  // namespace astrosplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(spread_splats);

namespace {

constexpr std::size_t splats_per_chunk = 4096;
constexpr std::int64_t rows_per_strip = 32;
constexpr double coarsest_step = 0.55;  // of the deviation of what is seen on a grid
constexpr std::int64_t smallest_grid = 8;
constexpr double spread_variance = 0.25;    // steps^2, of the quadratic B-spline at any offset
constexpr double doubling_variance = 0.75;  // steps^2 of the finer grid
constexpr double seen_share = 0.25;         // of a footprint's variance through which a splat sees the ratio
constexpr float largest_factor = 3.0f;
constexpr double fine_sigma = 1.5;            // texels, up to which splats are sharpened
constexpr double around = 16.0;               // times the variance of what a splat sees
constexpr double narrowest_halved_px = 1.25;  // its profile need not be exact
constexpr double few_share = 0.01;            // splats of a range, of the pixels of what they see
constexpr double same_sigma = 0.01;           // share that sigmas of one range differ by
constexpr double narrowest_blur_px = 0.4;     // a narrower one leaves 97 % of a pixel where it is

// Of a Gaussian whose values at whole steps have that variance, steps^2. Those of a narrow one have less than
// its own, so a wider one stands for it, of which the middle and its neighbours count.
double sampled_sigma(double variance) {
    constexpr double narrow = 0.25;
    if (variance >= narrow) return std::sqrt(variance);
    const double neighbour_over_middle = variance / (2.0 * (1.0 - variance));
    return std::sqrt(-0.5 / real::log(neighbour_over_middle));
}

float clamped(float factor) { return std::clamp(factor, 1.0f / largest_factor, largest_factor); }

// The factor that splats take of a ratio: with `overshoot` its square.
Image factor_of(const Fraction& fraction, bool overshoot) {
    Image factor = unfilled_image(fraction.seen.width, fraction.seen.height, 1);
    parallel_each(factor.pixels.size(), 65536, [&](std::size_t i) {
        const float ratio = fraction.wanted.pixels[i] / fraction.seen.pixels[i];
        factor.pixels[i] = clamped(overshoot ? ratio * ratio : ratio);
    });
    return factor;
}

// The square, and once more what the ratio differs by from that of the pixels `blur_px` around.
Image sharpening_factor_of(const Fraction& fraction, double blur_px) {
    Image factor = unfilled_image(fraction.seen.width, fraction.seen.height, 1);
    parallel_each(factor.pixels.size(), 65536, [&](std::size_t i) {
        factor.pixels[i] = fraction.wanted.pixels[i] / fraction.seen.pixels[i];
    });
    const Image wide = gaussian_blur(factor, blur_px, narrowest_halved_px);
    parallel_each(factor.pixels.size(), 65536, [&](std::size_t i) {
        const float ratio = factor.pixels[i];
        factor.pixels[i] = clamped(ratio * ratio * (ratio / wide.pixels[i]));
    });
    return factor;
}

// Beyond its edges a picture is mirrored.
void add_rows(const SpreadRows& rows, Image& sum) {
    for (std::int64_t row = rows.first - 1; row <= rows.end; ++row) {
        const std::int64_t to = std::clamp<std::int64_t>(row, 0, sum.height - 1);
        if (to < rows.first || to >= rows.end) continue;
        const float* const here = rows.pixels.at(rows.margin, row - rows.first + rows.margin);
        float* const there = sum.at(0, to);
        const auto add = [&](std::int64_t column, std::int64_t to_column) {
            for (int channel = 0; channel < 3; ++channel)
                there[3 * to_column + channel] += here[4 * column + channel];
        };
        add(-1, 0);
        for (std::int64_t column = 0; column < rows.width; ++column) add(column, column);
        add(rows.width, rows.width - 1);
    }
}

}  // namespace

FlatLight::FlatLight(PictureSplats& set, std::int64_t width, std::int64_t height, double filter_px)
    : set_(set), middle_(0.5f * glm::vec2(width, height)), filter_variance_(filter_px * filter_px) {
    grids_.push_back({width, height, 1.0});
    while (std::min(grids_.back().width, grids_.back().height) > smallest_grid) {
        const Grid& finer = grids_.back();
        grids_.push_back({(finer.width + 1) / 2, (finer.height + 1) / 2, 2.0 * finer.step});
    }
    for (const SplatRange& range : set.ranges) add_range(range);
    std::ranges::stable_sort(ranges_, {}, &Range::sigma);
}

void FlatLight::add_range(const SplatRange& splats) {
    const auto sigma = double(splats.sigma);
    auto same = std::ranges::find_if(
        ranges_, [&](const Range& range) { return std::fabs(range.sigma - sigma) < same_sigma * sigma; });
    if (same == ranges_.end()) same = ranges_.insert(ranges_.end(), {sigma, {}});
    Range& range = *same;
    const auto end = std::size_t(splats.end);
    for (auto i = std::size_t(splats.begin); i < end; i += splats_per_chunk)
        range.chunks.push_back({i, std::min(i + splats_per_chunk, end), texel(i).y, texel(i).y});
    parallel_each(range.chunks.size(), 16, [&](std::size_t c) {
        Chunk& chunk = range.chunks[c];
        for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
            chunk.top = std::min(chunk.top, texel(i).y);
            chunk.bottom = std::max(chunk.bottom, texel(i).y);
        }
    });
}

// From the top left corner.
glm::vec2 FlatLight::texel(std::size_t splat) const {
    const glm::vec3& p = set_.splats.position[splat];
    return {p.x + middle_.x, middle_.y - p.y};
}

// The coarsest on which a Gaussian so narrow is still smooth.
std::size_t FlatLight::grid_for(double variance) const {
    std::size_t grid = 0;
    while (grid + 1 < grids_.size() && grids_[grid].step < coarsest_step * std::sqrt(variance)) ++grid;
    return grid;
}

void FlatLight::spread(const Range& range, double step, Image& sum) const {
    const auto scale = float(1.0 / step);
    const auto flux =
        float(double(footprint_share) * 2.0 * real::pi * range.sigma * range.sigma / (step * step));
    parallel_chunks(sum.height, rows_per_strip, [&](std::int64_t first_row, std::int64_t end_row, int) {
        SpreadRows rows{sum.width, first_row, end_row};
        const auto top = float(double(first_row - 1) * step), bottom = float(double(end_row + 1) * step);
        for (const Chunk& chunk : range.chunks) {
            if (chunk.bottom < top || chunk.top > bottom) continue;
            const ShadedSplats& all = set_.splats;
            HWY_DYNAMIC_DISPATCH(spread_splats)
            ({&all.position[chunk.begin], &all.color[chunk.begin], &all.alpha[chunk.begin],
              chunk.end - chunk.begin, middle_.x, middle_.y, scale, flux},
             rows);
        }
        add_rows(rows, sum);
    });
}

Image FlatLight::sum() const {
    std::size_t grid = grids_.size() - 1;
    double missing = 0.0;  // texels^2, of the blur of what is there
    Image sum = make_image(grids_[grid].width, grids_[grid].height, 3);
    const auto move_to = [&](std::size_t to, double still_missing) {
        double now = missing - still_missing;
        for (std::size_t g = to; g < grid; ++g) now -= doubling_variance * grids_[g].step * grids_[g].step;
        const double step = grids_[grid].step;
        if (now > 0.0) sum = gaussian_blur(std::move(sum), sampled_sigma(now / (step * step)));
        for (; grid > to; --grid) sum = doubled(sum, grids_[grid - 1].width, grids_[grid - 1].height);
        missing = still_missing;
    };
    for (auto range = ranges_.rbegin(); range != ranges_.rend(); ++range) {
        const double variance = footprint_variance * range->sigma * range->sigma + filter_variance_;
        const std::size_t to = grid_for(variance);
        const double step = grids_[to].step;
        move_to(to, std::max(0.0, variance - spread_variance * step * step));
        spread(*range, step, sum);
    }
    move_to(0, 0.0);
    return sum;
}

// They see what those of the next narrower range do: a view of their own would take as long as that of many.
bool FlatLight::has_few(const Range& range, const Grid& seen) const {
    std::size_t splats = 0;
    for (const Chunk& chunk : range.chunks) splats += chunk.end - chunk.begin;
    return double(splats) < few_share * double(seen.width * seen.height);
}

void FlatLight::multiply(const Range& range, const Image& factor, int channel, double step) {
    const int of_factor = factor.channels == 1 ? 0 : channel;
    const auto scale = float(1.0 / step);
    parallel_each(range.chunks.size(), 16, [&](std::size_t c) {
        for (std::size_t i = range.chunks[c].begin; i < range.chunks[c].end; ++i) {
            const glm::vec2 at = texel(i) * scale;
            set_.splats.color[i][channel] *= LinearSample(factor, at.x, at.y).of(factor, of_factor);
        }
    });
}

void FlatLight::multiply(const Image& factor, double step) {
    for (const Range& range : ranges_)
        for (int c = 0; c < 3; ++c) multiply(range, factor, c, step);
}

void FlatLight::correct(Fraction fraction, int channel, bool overshoot) {
    std::size_t grid = 0;
    double variance = 0.0;  // texels^2, of the blur so far
    Image factor;
    bool sharpened = false;
    for (const Range& range : ranges_) {
        const double seen = seen_share * (range.sigma * range.sigma + filter_variance_);
        const bool sharpens = overshoot && range.sigma <= fine_sigma;
        const bool there = !factor.pixels.empty() && sharpens == sharpened && grid_for(seen) == grid;
        if (there && has_few(range, grids_[grid])) {
            multiply(range, factor, channel, grids_[grid].step);
            continue;
        }
        for (const std::size_t to = grid_for(seen); grid < to; ++grid) {
            fraction.wanted = halved(fraction.wanted);
            fraction.seen = halved(fraction.seen);
            variance += doubling_variance * grids_[grid].step * grids_[grid].step;
        }
        const double step = grids_[grid].step;
        const auto missing_px = [&](double wanted) { return std::sqrt(wanted - variance) / step; };
        if (missing_px(std::max(seen, variance)) > narrowest_blur_px) {
            fraction.wanted = gaussian_blur(std::move(fraction.wanted), missing_px(seen));
            fraction.seen = gaussian_blur(std::move(fraction.seen), missing_px(seen));
            variance = seen;
        }
        factor = {};  // before the next one takes as much
        factor = sharpens ? sharpening_factor_of(fraction, missing_px(around * seen))
                          : factor_of(fraction, overshoot);
        sharpened = sharpens;
        multiply(range, factor, channel, step);
    }
}

}  // namespace astrosplat
#endif  // HWY_ONCE
