// The finest merged splats that a frame has time for (merge/README.md), each in place of those below a node.
// In: merged layers, a camera and a number of splats. Out: splats for the renderer, which stand for all.
#pragma once

#include <glm/vec3.hpp>

#include "merge/tree.h"
#include "render/frame.h"
#include "render/project.h"

namespace astrosplat {

/// Optical depth of a splat: the integral of -ln(1 - alpha w) over its disc, square radii; and its inverse.
class DepthTable {
  public:
    explicit DepthTable(const Falloff& falloff);

    /// alpha in [0, 1]; what hides more than most_log counts as that.
    double depth(double alpha) const;
    /// Alpha of a splat of this depth, at most 1.
    double alpha(double depth) const;

  private:
    static constexpr int steps = 512;
    static constexpr double most_log = 8.0;  // of -ln(1 - alpha): depths beyond are the same

    double of_faint_, most_depth_;         // depth over alpha where alpha is small; of the largest alpha
    std::array<double, steps + 1> ratio_;  // depth over -ln(1 - alpha), at equal steps of that
    std::array<double, steps + 1> alpha_;  // over x, at equal steps of x = depth / (depth + of_faint)
};

/// Values that all merged splats of a layer share.
struct MergeSettings {
    /// `even`: the set's splats are spread evenly, as on a lattice or all over a picture.
    explicit MergeSettings(const LayerRender& render, bool even = false);

    LayerRender render;
    bool even;
    DepthTable depths;
    double variance;  // of the falloff, square radii
    double overlap;   // variance of a merged one over that of what it stands for, where as wide as high
};

struct NodeSplat {        // in place of all below a node
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
/// n of them spread over the merged one's disc at random let through what it does: its depth is n times that
/// of one splat thinned to the disc.
NodeSplat splat_of(const MergeSettings& settings, const NodeSums& sums, const Across& across, float hybrid);

/// A splat, or a merged one in place of many.
struct CloudPlace {
    glm::vec3 centre{0.0f}, spread{0.0f};  // and standard deviations of its light along the axes; layer space
    glm::vec3 in_camera{0.0f};             // the centre
    float radius = 0.0f;                   // of the splat, or of those that it stands for; layer space
    float alpha = 0.0f;
    glm::vec3 color{0.0f};
};

/// Factor of the light of such a place that lod.noise gives it close by, for a preview that does not divide
/// splats: light is where the children would have it, but for what is finer than the splat. > 0; 1 where the
/// splats would not become children, or the layer has no such noise.
float cloud_light(const LayerProjection& layer, const CloudPlace& place);

struct CutLayer {
    const MergedSplats* merged = nullptr;
    const MergeSettings* merging = nullptr;
    LayerProjection projection;        // of make_projection; its splats are not used
    const Relight* relight = nullptr;  // under another look than that of `merged`
};

struct CutSettings {
    std::int64_t budget = 0;             // splats together, at most
    float least_px = 1.5f;               // what looks smaller is not divided
    std::int64_t width = 0, height = 0;  // px of the frame
};

/// The splats of each layer: of nodes merged ones, and what looks large down to its own; nothing that the
/// frame does not show. Divides what looks largest while the budget has room. Alphas have the layer's opacity
/// in them. The same for any thread count.
std::vector<ShadedSplats> cut_splats(std::span<const CutLayer> layers, const CutSettings& settings);

}  // namespace astrosplat
