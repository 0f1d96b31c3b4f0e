// Every second pixel of the base, in both directions, is the middle of a patch that seeks its like. A sweep
// reads the matches of the one before only, so that no match depends on threads.
#include "bodies/exemplar.h"

#include "core/parallel.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

constexpr int patch_reach = 2, patch_side = 2 * patch_reach + 1, patch_area = patch_side * patch_side;
constexpr int patch_stride = 2;  // px of the base between the middles of patches
constexpr int row_floats = 8;    // room for a row of a patch: vectors
constexpr int search_reach = 6;  // px of the exemplar about the same place
constexpr int farthest = 24;     // of these, that matches which are handed on get from their own
constexpr int first_guesses = 5, search_sweeps = 3, all_turns = 8;
constexpr float least_deviation = 0.004f, level_weight = 0.15f, contrast_weight = 0.5f;
constexpr float most_gain = 2.0f;       // of a patch's contrast over that of its like
constexpr float best_distance = 0.02f;  // below which distances weigh alike
constexpr float no_distance = std::numeric_limits<float>::infinity();

struct PatchStep {
    int x, y;
};

// By quarters of a turn, and mirrored before for the upper four.
constexpr PatchStep turned_step(int turn, PatchStep step) {
    if (turn & 4) step.x = -step.x;
    switch (turn & 3) {
        case 0:
            return step;
        case 1:
            return {-step.y, step.x};
        case 2:
            return {-step.x, -step.y};
        default:
            return {step.y, -step.x};
    }
}

// For each turn, what belongs to each of a patch's pixels, row by row.
template <class Value, class Of>
constexpr std::array<std::array<Value, patch_area>, all_turns> table_of_turns(const Of& of) {
    std::array<std::array<Value, patch_area>, all_turns> table{};
    for (int turn = 0; turn < all_turns; ++turn)
        for (int i = 0; i < patch_area; ++i)
            table[turn][i] =
                of(turned_step(turn, {i % patch_side - patch_reach, i / patch_side - patch_reach}));
    return table;
}

// Where each pixel of a patch lies in the rows of the turned one.
constexpr auto places_in_rows =
    table_of_turns<int>([](PatchStep at) { return (at.y + patch_reach) * row_floats + at.x + patch_reach; });

struct PatchShape {
    float mean = no_distance;  // of a patch that is no source: farther from all others than any
    float deviation = 1.0f, log_deviation = 0.0f;
    float own = 0.0f;  // mean square in units of `deviation`, which is at least least_deviation
};

using PatchValues = std::array<float, patch_area>;

// Leaves the values less their mean: differences from the middle first, whose rounding is that of details.
PatchShape take_shape(PatchValues& values) {
    const float middle = values[patch_area / 2];
    float sum = 0.0f, squares = 0.0f;
    for (float& value : values) sum += value -= middle;
    const float mean = sum / float(patch_area);
    for (float& value : values) {
        value -= mean;
        squares += value * value;
    }
    const float variance = squares / float(patch_area), deviation = std::sqrt(variance) + least_deviation;
    return {middle + mean, deviation, shared::as_log(deviation), variance / (deviation * deviation)};
}

// Pixels beyond the edge are those at the edge.
PatchValues values_about(const Image& image, std::int64_t x, std::int64_t y) {
    PatchValues values;
    for (int i = 0; i < patch_area; ++i)
        values[i] =
            *image.at(std::clamp<std::int64_t>(x + i % patch_side - patch_reach, 0, image.width - 1),
                      std::clamp<std::int64_t>(y + i / patch_side - patch_reach, 0, image.height - 1));
    return values;
}

// A patch of the base, and it turned each way that it is asked for.
class SoughtPatch {
  public:
    SoughtPatch(const Image& base, std::int64_t x, std::int64_t y, int times)
        : place{int(x / times), int(y / times)}, values_(values_about(base, x, y)) {
        shape = take_shape(values_);
    }

    const float* turned(int turn) {
        float* const rows = turned_[turn].data();
        if (!(made_ >> turn & 1u)) {
            std::fill_n(rows, patch_side * row_floats, 0.0f);
            for (int i = 0; i < patch_area; ++i) rows[places_in_rows[turn][i]] = values_[i];
            made_ |= 1u << turn;
        }
        return rows;
    }

    PatchStep place;  // the same place in the exemplar, px
    PatchShape shape;

  private:
    PatchValues values_;
    std::array<std::array<float, patch_side * row_floats>, all_turns> turned_;
    unsigned made_ = 0;
};

// Where a patch finds its like.
struct PatchMatch {
    std::int32_t x = 0, y = 0;  // middle of that, px of the exemplar
    int turn = 0;               // which lays the patch onto it
    float distance = no_distance;
    float gain = 0.0f;
};

// Those of all patches, row by row.
struct PatchMatches {
    std::int64_t width, height;
    Buffer<PatchMatch> matches;

    PatchMatch& at(std::int64_t x, std::int64_t y) { return matches[y * width + x]; }
    const PatchMatch& at(std::int64_t x, std::int64_t y) const { return matches[y * width + x]; }
};

// Sum of the products of a turned patch and what lies under it: `under` begins at the upper left. Eight sums
// beside each other, which vectors of any width add up to the same bits.
float sum_of_products(const float* patch, const float* under, std::int64_t width) {
    float sums[row_floats] = {};
    for (int row = 0; row < patch_side; ++row, patch += row_floats, under += width)
        for (int i = 0; i < row_floats; ++i) sums[i] += patch[i] * under[i];
    return ((sums[0] + sums[1]) + (sums[2] + sums[3])) + sums[4];
}

class PatchSearch {
  public:
    PatchSearch(const Image& base, const Exemplar& exemplar, int times, const PatchPlace& place,
                std::uint32_t seed)
        : base_(base),
          coarse_(exemplar.coarse),
          times_(times),
          place_(place),
          seed_(seed),
          shapes_(coarse_.pixels.size()) {
        for_each_pixel(coarse_, [&](std::int64_t x, std::int64_t y) {
            PatchShape& shape = shapes_[y * coarse_.width + x] = {};
            if (!is_source(exemplar.sources, x, y)) return;
            PatchValues values = values_about(coarse_, x, y);
            shape = take_shape(values);
        });
        coarse_.pixels.resize(coarse_.pixels.size() + row_floats, 0.0f);  // a row of vectors ends beyond
    }

    PatchMatches find(const Progress& progress) const {
        PatchMatches found;
        for (int sweep = 0; sweep <= search_sweeps; ++sweep) {
            found = swept(sweep, found, progress);
            progress.at(double(sweep + 1) / double(search_sweeps + 1));
        }
        return found;
    }

  private:
    bool is_source(const Image& sources, std::int64_t x, std::int64_t y) const {
        bool all = x >= patch_reach && y >= patch_reach && x < coarse_.width - patch_reach &&
                   y < coarse_.height - patch_reach;
        for_each_about(sources, x, y, patch_reach,
                       [&](std::int64_t i, std::int64_t j) { all = all && *sources.at(i, j) > 0.0f; });
        return all;
    }

    PatchMatches swept(int sweep, const PatchMatches& before, const Progress& progress) const {
        const std::uint32_t seed =
            shared::as_hash(seed_, std::uint32_t(times_), std::uint32_t(sweep), shared::PURPOSE_DETAIL_PATCH);
        PatchMatches after{(base_.width + patch_stride - 1) / patch_stride,
                           (base_.height + patch_stride - 1) / patch_stride,
                           {}};
        after.matches.resize(std::size_t(after.width * after.height));
        parallel_each(after.height, 4, [&](std::int64_t y) {
            progress.check();
            for (std::int64_t x = 0; x < after.width; ++x) {
                SoughtPatch patch(base_, x * patch_stride, y * patch_stride, times_);
                const std::uint32_t random =
                    shared::as_hash(seed, std::uint32_t(place_.x / patch_stride + x),
                                    std::uint32_t(place_.y / patch_stride + y), shared::PURPOSE_DETAIL_PATCH);
                after.at(x, y) = sweep == 0 ? first(patch, random) : better(before, patch, x, y, random);
            }
        });
        return after;
    }

    // The same place, and others about it.
    PatchMatch first(SoughtPatch& patch, std::uint32_t random) const {
        PatchMatch best;
        try_at(patch, patch.place.x, patch.place.y, 0, best);
        for (int i = 0; i < first_guesses; ++i) {
            random = shared::as_mix(random + 1u);
            const int turn = random >> 29 == 0 ? int(random >> 26 & 7u) : 0;
            const PatchStep step = step_within(search_reach, random);
            try_at(patch, patch.place.x + step.x, patch.place.y + step.y, turn, best);
        }
        return best;
    }

    // What its neighbours found, carried on; then places about the best one, ever nearer.
    PatchMatch better(const PatchMatches& before, SoughtPatch& patch, std::int64_t x, std::int64_t y,
                      std::uint32_t random) const {
        constexpr PatchStep neighbours[] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1},
                                            {-4, 0}, {4, 0}, {0, -4}, {0, 4}};
        PatchMatch best = before.at(x, y);
        for (const PatchStep& n : neighbours) {
            if (x + n.x < 0 || y + n.y < 0 || x + n.x >= before.width || y + n.y >= before.height) continue;
            const PatchMatch& there = before.at(x + n.x, y + n.y);
            const PatchStep step = turned_step(there.turn, {-n.x * patch_stride, -n.y * patch_stride});
            try_at(patch, there.x + step.x, there.y + step.y, there.turn, best);
        }
        for (int reach = search_reach; reach >= 1; reach /= 3) {
            random = shared::as_mix(random + 1u);
            const PatchStep step = step_within(reach, random);
            const int turn = random >> 28 & 1u ? best.turn : int(random >> 25 & 7u);
            try_at(patch, best.x + step.x, best.y + step.y, turn, best);
        }
        return best;
    }

    static PatchStep step_within(int reach, std::uint32_t random) {
        const std::uint32_t side = 2u * std::uint32_t(reach) + 1u;
        return {int(random % side) - reach, int((random >> 10) % side) - reach};
    }

    // The mean square of both patches' difference, each in units of its deviation, and what these and the
    // means differ by.
    void try_at(SoughtPatch& patch, std::int32_t x, std::int32_t y, int turn, PatchMatch& best) const {
        if (x < 0 || y < 0 || x >= coarse_.width || y >= coarse_.height) return;
        if (std::max(std::abs(x - patch.place.x), std::abs(y - patch.place.y)) > farthest) return;
        const PatchShape &here = patch.shape, &there = shapes_[y * coarse_.width + x];
        const float level = here.mean - there.mean, contrast = here.log_deviation - there.log_deviation;
        const float apart = level_weight * level * level + contrast_weight * contrast * contrast;
        if (!(apart < best.distance)) return;
        const float* const under = coarse_.at(x - patch_reach, y - patch_reach);
        const float common = sum_of_products(patch.turned(turn), under, coarse_.width) /
                             (float(patch_area) * here.deviation * there.deviation);
        const float distance = apart + std::max(0.0f, here.own + there.own - 2.0f * common);
        if (distance < best.distance)
            best = {x, y, turn, distance,
                    std::clamp(here.deviation / there.deviation, 1.0f / most_gain, most_gain)};
    }

    const Image& base_;
    Image coarse_;
    int times_;
    PatchPlace place_;
    std::uint32_t seed_;
    Buffer<PatchShape> shapes_;  // at each pixel of coarse_
};

// Means of what the patches that cover a pixel found for it: those count most in whose middle it lies, and
// which found what they sought.
class PatchVotes {
  public:
    PatchVotes(const Image& fine, PatchMatches found) : fine_(fine), found_(std::move(found)) {
        places_ = table_of_turns<std::int64_t>(
            [&](PatchStep at) { return (at.y * fine.width + at.x) * fine.channels; });
        for (int i = 0; i < patch_area; ++i) {
            const int x = i % patch_side - patch_reach, y = i / patch_side - patch_reach;
            weights_[i] = float(real::exp(-(x * x + y * y) / (0.72 * patch_stride * patch_stride)));
        }
    }

    void mean_at(std::int64_t x, std::int64_t y, float* out) const {
        std::array<float, 3> sum{};
        float weight = 1e-12f;
        const auto vote = [&](std::int64_t column, std::int64_t row) {
            const PatchMatch& match = found_.at(column, row);
            if (match.distance == no_distance) return;
            const auto i = std::size_t((y - row * patch_stride + patch_reach) * patch_side + x -
                                       column * patch_stride + patch_reach);
            const float* const copied = fine_.at(match.x, match.y) + places_[match.turn][i];
            const float counts = weights_[i] / (best_distance + match.distance);
            for (int c = 0; c < fine_.channels; ++c) sum[c] += counts * match.gain * copied[c];
            weight += counts;
        };
        for_each_between(found_, first_over(x), first_over(y), (x + patch_reach) / patch_stride,
                         (y + patch_reach) / patch_stride, vote);
        for (int c = 0; c < fine_.channels; ++c) out[c] = sum[c] / weight;
    }

  private:
    // Of the patches that cover a pixel.
    static std::int64_t first_over(std::int64_t x) {
        return std::max<std::int64_t>(0, (x - patch_reach + patch_stride - 1) / patch_stride);
    }

    const Image& fine_;
    PatchMatches found_;
    std::array<std::array<std::int64_t, patch_area>, all_turns> places_;  // of each pixel, from the middle
    PatchValues weights_;
};

}  // namespace

Image exemplar_details(const Image& base, const Exemplar& exemplar, int times, const PatchPlace& place,
                       std::uint32_t seed, const Progress& progress) {
    assert(exemplar.fine.channels == 1 || exemplar.fine.channels == 3);
    const PatchVotes votes(exemplar.fine, PatchSearch(base, exemplar, times, place, seed).find(progress));
    Image details = unfilled_image(base.width, base.height, exemplar.fine.channels);
    for_each_pixel(details, [&](std::int64_t x, std::int64_t y) { votes.mean_at(x, y, details.at(x, y)); });
    return details;
}

}  // namespace astrosplat
