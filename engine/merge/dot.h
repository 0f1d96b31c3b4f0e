// One dot in place of the splats below a node, for a falloff, a blend and a view. In: NodeSums. Out: radius,
// alpha and colour.
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "merge/sums.h"
#include "render/layer_render.h"

namespace astrosplat {

/// Optical depth of a dot: the integral of -ln(1 - alpha w) over its disc, square radii; and its inverse.
class DepthTable {
  public:
    explicit DepthTable(const Falloff& falloff);

    /// alpha in [0, 1]; what hides more than most_log counts as that.
    double depth(double alpha) const;
    /// Alpha of a dot of this depth, at most 1.
    double alpha(double depth) const;

  private:
    static constexpr int steps = 512;
    static constexpr double most_log = 8.0;  // of -ln(1 - alpha): depths beyond are the same

    double of_faint_, most_depth_;         // depth over alpha where alpha is small; of the largest alpha
    std::array<double, steps + 1> ratio_;  // depth over -ln(1 - alpha), at equal steps of that
    std::array<double, steps + 1> alpha_;  // over x, at equal steps of x = depth / (depth + of_faint)
};

/// What a layer's dots have in common.
struct DotSettings {
    /// `lattice`: the set's splats are on one.
    explicit DotSettings(const LayerRender& render, bool lattice = false);

    LayerRender render;
    bool lattice;
    DepthTable depths;
    double variance;  // of the falloff, square radii
    double overlap;   // variance of a dot over that of what it stands for, where that is as wide as high
};

struct Dot {
    float radius = 0.0f;  // scene units
    float alpha = 0.0f;   // with the layer's opacity
    glm::vec3 color{0.0f};
};

/// Variances of the splats' centres across the line of sight, square scene units: their mean over directions,
/// and that along the longer axis.
struct Across {
    float mean, largest;
};

/// `hybrid` is the share of screen (blend hybrid). Add keeps the light exactly. Where splats hide each other,
/// n of them spread over the dot's disc at random let through what the dot does: its depth is n times that of
/// one splat thinned to the disc.
Dot make_dot(const DotSettings& settings, const NodeSums& sums, const Across& across, float hybrid);

}  // namespace astrosplat
