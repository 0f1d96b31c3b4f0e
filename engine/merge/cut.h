// The finest dots that a frame has time for (merge/README.md). In: merged layers, a camera and a number of
// dots. Out: splats for the renderer, which stand for all of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "merge/dot.h"
#include "merge/sums.h"
#include "render/project.h"

namespace astrosplat {

struct CutLayer {
    const MergedSplats* merged = nullptr;
    const DotSettings* dots = nullptr;
    LayerProjection projection;  // of make_projection; its splats are not used
};

struct CutSettings {
    std::int64_t budget = 0;             // dots together, at most
    float least_px = 1.5f;               // what looks smaller is not divided
    std::int64_t width = 0, height = 0;  // px of the frame
};

/// The splats of each layer: nodes as dots, and what looks large down to the splats themselves; nothing that
/// the frame does not show. Divides what looks largest while the budget has room. Alphas have
/// the layer's opacity in them. The same for any thread count.
std::vector<ShadedSplats> cut_splats(std::span<const CutLayer> layers, const CutSettings& settings);

}  // namespace astrosplat
