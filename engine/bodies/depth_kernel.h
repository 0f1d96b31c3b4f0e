// Depths of many splats at once, in the noise that bands share (DEPTH 4). Compiled once per instruction set
// with the same bits on each.
#pragma once

#include <cstdint>
#include <span>

#include "core/shared_maths.h"

namespace astrosplat {

/// Octaves of a noise field, coarse to fine.
struct NoiseStack {
    static constexpr int most = 16;
    int count = 0;
    float frequency[most];  // a texel
    float gain[most];       // times an octave of unit deviation
    std::uint32_t seed = 0;
};

/// Splats on their way to a depth, texels.
struct DepthBlock {
    static constexpr int size = 256;
    int count = 0;
    float x[size], y[size];
    float height[size];          // scale height H_k of the envelope
    float clumping[size];        // how much of the noise and of candidates' weights counts
    std::uint32_t random[size];  // a hash for each splat; all of its choices follow from it, but
    float even[size];            // 0..1, spread evenly over neighbours: the share of what is before its depth
    float z[size];               // out
};

/// Places along the lines of sight of a block's splats, one of which each takes.
struct DepthCandidates {
    static constexpr int count = 24;
    float z[count][DepthBlock::size];
    float weight[count][DepthBlock::size];  // logarithm
};

/// Deviation of ln(u / (1 - u)) of an even u: pi / sqrt(3).
inline constexpr float logistic_deviation = 1.8138f;

/// An even number of (0, 1) spread as a logistic: quantile of sech^2(z / 2) / 4, whose scale height is 2.
static inline float logistic(float u) { return shared::as_log(u / (1.0f - u)); }

/// No farther out than 2.1 scale heights, where a few wide splats would stand alone, as smoke; u: [0, 1].
static inline float near_logistic(float u) { return logistic(0.015f + 0.97f * shared::clamp(u, 0.0f, 1.0f)); }

/// A Gaussian of a galaxy as lines of sight meet it: light exp(-u^2 u2 - v^2 v2) `light` at (u, v), about
/// the depth v * slope with a standard deviation; texels.
struct LineGaussian {
    float light, u2, v2, slope, deviation;
};

/// Where lines of sight meet a galaxy: along its major axis and across it, texels.
struct LinePlaces {
    float u[DepthBlock::size], v[DepthBlock::size];
};

/// Candidates' z of even shares of what the Gaussians, at least one, shine at each splat's place: where all
/// are as likely, `even` is the share before its very depth. Sets the heights: the mean deviation.
void spread_candidates(std::span<const LineGaussian> gaussians, const LinePlaces& places, DepthBlock& block,
                       DepthCandidates& candidates);

/// z drawn from the candidates, each as likely as exp(weight + sum of gain N(x, y, z)), by the
/// first three octaves; then from eight places about the one chosen, H_k apart at most, by the others.
void line_depths(const NoiseStack& noise, const DepthCandidates& candidates, DepthBlock& block);

/// z drawn from sech^2(z / H_k) exp(clumping * sum of gain N(x, y, z)), normalised in every column: `even`
/// among 24 candidates by the first three octaves, then eight about the one chosen by the others.
void disk_depths(const NoiseStack& noise, DepthBlock& block);

/// z = clumping * sum of gain N(x, y, 0), at most 2 H_k from 0, and a draw from sech^2(z / spread) with the
/// spread at most H_k.
void sheet_depths(const NoiseStack& noise, float spread, DepthBlock& block);

/// z = sum of gain N(x, y, 0) alone.
void noise_sum(const NoiseStack& noise, DepthBlock& block);

}  // namespace astrosplat
