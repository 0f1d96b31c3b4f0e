// Memory and time that one layer of a batch run will take: from its source and the sizes of files, and from
// its sample where there is one.
#pragma once

#include <cstdint>

#include "batch_plan.h"
#include "sampled_run.h"

namespace astrosplat {

struct LayerNeed {
    const LayerParams* params;
    std::int64_t splats = 0;
    bool has_shapes = false;            // captures
    std::int64_t making = 0, held = 0;  // bytes while it is made, and from then on
    std::int64_t streamed = 0;          // bytes held where it stays on disk
    bool may_stream = false, reads_pictures = false;
};

/// Loads meshes and pictures where `count` alone does not tell and the set is not in the cache. Throws as
/// their readers do; of a file of splats that cannot be read nothing is needed: its reader will say why.
/// sampled: nullptr, of layers that are not.
LayerNeed need_of(const BatchPlan& plan, const LayerParams& layer, const SampledRun::Layer* sampled);

}  // namespace astrosplat
