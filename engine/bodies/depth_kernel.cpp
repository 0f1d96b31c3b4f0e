// Each step is a plain loop over the splats of a block, which the compiler turns into vectors.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bodies/depth_kernel.cpp"
#include <hwy/foreach_target.h>
// after foreach_target
#include <hwy/highway.h>

#include <algorithm>
#include <climits>
#include <vector>

#include "bodies/depth_kernel.h"
#include "core/shared_maths.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

using namespace astrosplat::glsl;

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "maths.glsl"
// after maths
#include "noise.glsl"
#pragma GCC diagnostic pop

#define ASTROSPLAT_DEPTH_LOOP HWY_FLATTEN void

constexpr float unit_deviation = 1.0f / 0.26f;  // of an octave; these are DEPTH 4's
constexpr int coarse_octaves = 3;
constexpr int coarse_candidates = 24, fine_candidates = 8;

using Lane = float[DepthBlock::size];

// A number of 0..1 that follows from a splat's hash: another for each `which`.
float uniform_of(uint random, int which) { return as_uniform(as_mix(random + uint(which) * 0x9e3779b9u)); }

ASTROSPLAT_DEPTH_LOOP add_octave(const NoiseStack& noise, int octave, const DepthBlock& block,
                                 const float* HWY_RESTRICT z, float* HWY_RESTRICT sum) {
    const float frequency = noise.frequency[octave], gain = noise.gain[octave] * unit_deviation;
    for (int i = 0; i < block.count; ++i)
        sum[i] = sum[i] + gain * as_noise_octave(block.x[i], block.y[i], z[i], frequency, noise.seed, octave);
}

// Contribution of a plane of a noise's lattice in the columns of a block's splats: on the plane, and how much
// more a unit above it.
struct NoisePlane {
    Lane value, slope;
};

// One octave in those columns. Candidates for a splat differ in z alone, so the lattice is asked once for
// every plane: in between, noise is the sum of what the two planes contribute, faded with the distance.
struct ColumnNoise {
    float frequency, gain, shift;
    Lane lowest;  // of the planes that count for a splat
    std::vector<NoisePlane> planes;
};

ASTROSPLAT_DEPTH_LOOP fill_plane(const NoiseStack& noise, int octave, const DepthBlock& block, int number,
                                 const float* HWY_RESTRICT lowest, NoisePlane& plane) {
    const float frequency = noise.frequency[octave];
    const float shift_x = as_noise_shift(noise.seed, octave, 0u),
                shift_y = as_noise_shift(noise.seed, octave, 1u);
    const uint field = as_noise_field(noise.seed, octave);
    for (int i = 0; i < block.count; ++i) {
        const float x = block.x[i] * frequency + shift_x, y = block.y[i] * frequency + shift_y;
        const float x0 = floor(x), y0 = floor(y);
        const uint key_x = uint(int(x0)) * AS_NOISE_KEY_X, key_y = uint(int(y0)) * AS_NOISE_KEY_Y,
                   key_z = uint(int(lowest[i]) + number) * AS_NOISE_KEY_Z + field;
        plane.value[i] = as_noise_plane(key_x, key_y, key_z, x - x0, y - y0, 0.0f);
        plane.slope[i] = as_noise_plane(key_x, key_y, key_z, x - x0, y - y0, 1.0f) - plane.value[i];
    }
}

// The range of whole numbers below values >= 0.
struct Cells {
    int first, last;
};
HWY_FLATTEN Cells cells_of(const float* HWY_RESTRICT values, int count) {
    Cells cells{INT_MAX, 0};
    for (int i = 0; i < count; ++i) {
        cells.first = min(cells.first, int(values[i]));
        cells.last = max(cells.last, int(values[i]));
    }
    return cells;
}

ASTROSPLAT_DEPTH_LOOP heights_above_lowest(const ColumnNoise& column, const float* HWY_RESTRICT z, int count,
                                           float* HWY_RESTRICT height) {
    for (int i = 0; i < count; ++i) height[i] = z[i] * column.frequency + column.shift - column.lowest[i];
}

// For places from `lowest` to `highest`.
ColumnNoise column_noise(const NoiseStack& noise, int octave, const DepthBlock& block, const float* lowest,
                         const float* highest) {
    ColumnNoise column;
    column.frequency = noise.frequency[octave];
    column.gain = noise.gain[octave] * unit_deviation * AS_NOISE_SCALE;
    column.shift = as_noise_shift(noise.seed, octave, 2u);
    for (int i = 0; i < block.count; ++i)
        column.lowest[i] = floor(lowest[i] * column.frequency + column.shift);
    Lane height;
    heights_above_lowest(column, highest, block.count, height);
    column.planes.resize(std::size_t(cells_of(height, block.count).last) + 2);
    for (std::size_t n = 0; n < column.planes.size(); ++n)
        fill_plane(noise, octave, block, int(n), column.lowest, column.planes[n]);
    return column;
}

ASTROSPLAT_DEPTH_LOOP add_plane(const NoisePlane& plane, float number, float gain, int count,
                                const float* HWY_RESTRICT height, float* HWY_RESTRICT sum) {
    for (int i = 0; i < count; ++i) {
        const float above = height[i] - number;
        const float share = as_noise_fade(max(0.0f, 1.0f - abs(above)));
        sum[i] = sum[i] + gain * ((plane.value[i] + plane.slope[i] * above) * share);
    }
}

void add_column(const ColumnNoise& column, const float* z, int count, float* sum) {
    Lane height;
    heights_above_lowest(column, z, count, height);
    const Cells cells = cells_of(height, count);
    const int end = min(cells.last + 2, int(column.planes.size()));
    for (int n = cells.first; n < end; ++n)
        add_plane(column.planes[n], float(n), column.gain, count, height, sum);
}

ASTROSPLAT_DEPTH_LOOP clear(float* HWY_RESTRICT values, int count) {
    for (int i = 0; i < count; ++i) values[i] = 0.0f;
}

ASTROSPLAT_DEPTH_LOOP coarse_places(const DepthBlock& block, int candidate, float* HWY_RESTRICT z) {
    for (int i = 0; i < block.count; ++i) {
        const float place = block.even[i] * float(coarse_candidates), within = place - floor(place);
        z[i] = 0.5f * block.height[i] * near_logistic((float(candidate) + within) / float(coarse_candidates));
    }
}

ASTROSPLAT_DEPTH_LOOP fine_places(const DepthBlock& block, float longest, int candidate,
                                  float* HWY_RESTRICT z) {
    for (int i = 0; i < block.count; ++i) {
        const float u = uniform_of(block.random[i], 1 + candidate);
        const float span = min(0.6f * longest, block.height[i]);
        z[i] = block.z[i] + span * ((float(candidate) + u) / float(fine_candidates) - 0.5f);
    }
}

ASTROSPLAT_DEPTH_LOOP weights(const DepthBlock& block, float* HWY_RESTRICT energy, float* HWY_RESTRICT sum) {
    for (int i = 0; i < block.count; ++i) {
        energy[i] = as_exp(block.clumping[i] * energy[i]);
        sum[i] = sum[i] + energy[i];
    }
}

ASTROSPLAT_DEPTH_LOOP uniform_choices(const DepthBlock& block, float* HWY_RESTRICT choice) {
    for (int i = 0; i < block.count; ++i) choice[i] = uniform_of(block.random[i], 1 + fine_candidates);
}

ASTROSPLAT_DEPTH_LOOP start_choice(const float* HWY_RESTRICT choice, int count, float* HWY_RESTRICT rest) {
    for (int i = 0; i < count; ++i) rest[i] = rest[i] * choice[i];
}

// Takes the candidate where the rest of the weight is not used up yet, so that the last one taken is the
// choice.
ASTROSPLAT_DEPTH_LOOP choose(const float* HWY_RESTRICT weight, const float* HWY_RESTRICT place,
                             float* HWY_RESTRICT rest, float* HWY_RESTRICT z, int count) {
    for (int i = 0; i < count; ++i) {
        z[i] = rest[i] >= 0.0f ? place[i] : z[i];
        rest[i] = rest[i] - weight[i];
    }
}

ASTROSPLAT_DEPTH_LOOP widen(const float* HWY_RESTRICT place, int count, float* HWY_RESTRICT lowest,
                            float* HWY_RESTRICT highest) {
    for (int i = 0; i < count; ++i) {
        lowest[i] = min(lowest[i], place[i]);
        highest[i] = max(highest[i], place[i]);
    }
}

// One draw among `candidates` places, with octaves [first, end) as weights. places(candidate, z, weight) sets
// them; weights are 0 before.
template <int candidates, class Places>
void draw(const NoiseStack& noise, int first, int end, const float* choice, DepthBlock& block,
          Places places) {
    Lane place[candidates], weight[candidates], rest, lowest, highest;
    for (int candidate = 0; candidate < candidates; ++candidate) {
        clear(weight[candidate], block.count);
        places(candidate, place[candidate], weight[candidate]);
    }
    std::copy_n(place[0], block.count, lowest);
    std::copy_n(place[0], block.count, highest);
    for (int candidate = 1; candidate < candidates; ++candidate)
        widen(place[candidate], block.count, lowest, highest);
    for (int octave = first; octave < end; ++octave) {
        const ColumnNoise column = column_noise(noise, octave, block, lowest, highest);
        for (int candidate = 0; candidate < candidates; ++candidate)
            add_column(column, place[candidate], block.count, weight[candidate]);
    }
    clear(rest, block.count);
    for (int candidate = 0; candidate < candidates; ++candidate) weights(block, weight[candidate], rest);
    start_choice(choice, block.count, rest);
    for (int candidate = 0; candidate < candidates; ++candidate)
        choose(weight[candidate], place[candidate], rest, block.z, block.count);
}

ASTROSPLAT_DEPTH_LOOP add_spread(float spread, DepthBlock& block) {
    for (int i = 0; i < block.count; ++i) {
        const float most = 2.0f * block.height[i];
        block.z[i] = clamp(block.clumping[i] * block.z[i], -most, most) +
                     0.5f * min(spread, block.height[i]) * near_logistic(block.even[i]);
    }
}

// One Gaussian's light in the columns of a block's splats, and the share of all that is before its own.
struct LineShare {
    Lane share, begin;
};

ASTROSPLAT_DEPTH_LOOP add_light(const LineGaussian& g, const LinePlaces& places, int count,
                                float* HWY_RESTRICT light, float* HWY_RESTRICT sum) {
    for (int i = 0; i < count; ++i) {
        const float u = places.u[i], v = places.v[i];
        light[i] = g.light * as_exp(-u * u * g.u2 - v * v * g.v2);
        sum[i] = sum[i] + light[i];
    }
}

// `begin`: of the shares so far. The last Gaussian has what is left.
ASTROSPLAT_DEPTH_LOOP add_share(float deviation, bool last, const float* HWY_RESTRICT sum,
                                float* HWY_RESTRICT begin, LineShare& line, DepthBlock& block) {
    for (int i = 0; i < block.count; ++i) {
        const float share = last ? max(1.0f - begin[i], 1e-6f) : line.share[i] / max(sum[i], 1e-30f);
        line.begin[i] = begin[i];
        line.share[i] = share;
        block.height[i] = block.height[i] + share * deviation;
        begin[i] = begin[i] + share;
    }
}

ASTROSPLAT_DEPTH_LOOP shares_before(const DepthBlock& block, int candidate, float* HWY_RESTRICT before) {
    for (int i = 0; i < block.count; ++i) {
        const float place = block.even[i] * float(coarse_candidates), within = place - floor(place);
        before[i] = (float(candidate) + within) / float(coarse_candidates);
    }
}

// Of the candidates that are not before the Gaussian's own share: those of later ones are set again.
ASTROSPLAT_DEPTH_LOOP find_within(const LineGaussian& g, const LineShare& line, const LinePlaces& places,
                                  const float* HWY_RESTRICT before, int count, float* HWY_RESTRICT within,
                                  float* HWY_RESTRICT middle, float* HWY_RESTRICT deviation) {
    for (int i = 0; i < count; ++i) {
        const bool reached = before[i] >= line.begin[i];
        within[i] = reached ? (before[i] - line.begin[i]) / line.share[i] : within[i];
        middle[i] = reached ? places.v[i] * g.slope : middle[i];
        deviation[i] = reached ? g.deviation : deviation[i];
    }
}

ASTROSPLAT_DEPTH_LOOP spread_about(const float* HWY_RESTRICT within, const float* HWY_RESTRICT middle,
                                   const float* HWY_RESTRICT deviation, int count, float* HWY_RESTRICT z) {
    for (int i = 0; i < count; ++i)
        z[i] = middle[i] + deviation[i] * (near_logistic(within[i]) / logistic_deviation);
}

}  // namespace

void spread_candidates_target(std::span<const LineGaussian> gaussians, const LinePlaces& places,
                              DepthBlock& block, DepthCandidates& candidates) {
    std::vector<LineShare> lines(gaussians.size());
    Lane sum, begin, before, within, middle, deviation;
    for (float* const values : {sum, begin, block.height, within, middle, deviation})
        clear(values, block.count);
    for (std::size_t n = 0; n < lines.size(); ++n)
        add_light(gaussians[n], places, block.count, lines[n].share, sum);
    for (std::size_t n = 0; n < lines.size(); ++n)
        add_share(gaussians[n].deviation, n + 1 == lines.size(), sum, begin, lines[n], block);
    for (int candidate = 0; candidate < coarse_candidates; ++candidate) {
        shares_before(block, candidate, before);
        for (std::size_t n = 0; n < lines.size(); ++n)
            find_within(gaussians[n], lines[n], places, before, block.count, within, middle, deviation);
        spread_about(within, middle, deviation, block.count, candidates.z[candidate]);
    }
}

template <class Places>
void draw_twice(const NoiseStack& noise, DepthBlock& block, Places places) {
    draw<coarse_candidates>(noise, 0, min(noise.count, coarse_octaves), block.even, block, places);
    if (noise.count <= coarse_octaves) return;
    const float longest = 1.0f / noise.frequency[coarse_octaves];
    Lane choice;
    uniform_choices(block, choice);
    draw<fine_candidates>(
        noise, coarse_octaves, noise.count, choice, block,
        [&](int candidate, float* z, float*) { fine_places(block, longest, candidate, z); });
}

void disk_depths_target(const NoiseStack& noise, DepthBlock& block) {
    draw_twice(noise, block, [&](int candidate, float* z, float*) { coarse_places(block, candidate, z); });
}

void line_depths_target(const NoiseStack& noise, const DepthCandidates& candidates, DepthBlock& block) {
    static_assert(coarse_candidates == DepthCandidates::count);
    draw_twice(noise, block, [&](int candidate, float* z, float* weight) {
        std::copy_n(candidates.z[candidate], block.count, z);
        std::copy_n(candidates.weight[candidate], block.count, weight);
    });
}

void noise_sum_target(const NoiseStack& noise, DepthBlock& block) {
    Lane plane;
    clear(plane, block.count);
    clear(block.z, block.count);
    for (int octave = 0; octave < noise.count; ++octave) add_octave(noise, octave, block, plane, block.z);
}

void sheet_depths_target(const NoiseStack& noise, float spread, DepthBlock& block) {
    noise_sum_target(noise, block);
    add_spread(spread, block);
}

}  // namespace HWY_NAMESPACE
}  // namespace astrosplat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(disk_depths_target);
HWY_EXPORT(line_depths_target);
HWY_EXPORT(noise_sum_target);
HWY_EXPORT(sheet_depths_target);
HWY_EXPORT(spread_candidates_target);

void disk_depths(const NoiseStack& noise, DepthBlock& block) {
    HWY_DYNAMIC_DISPATCH(disk_depths_target)(noise, block);
}

void line_depths(const NoiseStack& noise, const DepthCandidates& candidates, DepthBlock& block) {
    HWY_DYNAMIC_DISPATCH(line_depths_target)(noise, candidates, block);
}

void noise_sum(const NoiseStack& noise, DepthBlock& block) {
    HWY_DYNAMIC_DISPATCH(noise_sum_target)(noise, block);
}

void sheet_depths(const NoiseStack& noise, float spread, DepthBlock& block) {
    HWY_DYNAMIC_DISPATCH(sheet_depths_target)(noise, spread, block);
}

void spread_candidates(std::span<const LineGaussian> gaussians, const LinePlaces& places, DepthBlock& block,
                       DepthCandidates& candidates) {
    HWY_DYNAMIC_DISPATCH(spread_candidates_target)(gaussians, places, block, candidates);
}

}  // namespace astrosplat
#endif
