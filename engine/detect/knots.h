// The compact things of a picture, knots and star clusters: each is to be a ball at one depth, not a column
// of dots. In: the picture's light without its stars. Out: where they are, and which pixels belong to which.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"

namespace astrosplat {

struct Knot {
    float x = 0.0f, y = 0.0f;  // px from the top left corner
    float sigma = 0.0f;        // px
    float roundness = 1.0f;    // 0 for a piece of a filament, 1 for what is round
    float ballness = 1.0f;     // 1 only for what is nearly as wide as long
};

struct Knots {
    std::vector<Knot> knots;     // the most prominent first
    Buffer<std::int32_t> owner;  // of each pixel: index into knots, or -1
    Buffer<float> weight;        // of each pixel: share of its fine light that is its owner's, 0..1
};

/// Peaks of the differences of neighbouring Gaussians (1.6 px and on, each 1.6 times the last) that stand out
/// of what is common around them. Each owns a disk of three times its sigma, less and less towards its rim; a
/// peak inside the inner part of another one's disk is part of that one. `given` are knots that are known
/// before, and come first.
Knots find_knots(const Image& brightest, const std::vector<Knot>& given = {});

}  // namespace astrosplat
