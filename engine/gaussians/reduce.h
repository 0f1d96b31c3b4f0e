// Fewer splats for export, by the preview's tree (merge/README.md). In: shaded layers and a number. Out: dots
// that stand for all of them, seen from everywhere.
#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <span>
#include <vector>

#include "core/progress.h"
#include "render/frame.h"

namespace astrosplat {

/// At most `count` dots of all layers together, those of layer i at place i, with its opacity in their
/// alphas; where the layers have no more than that, a copy of them. Their size is judged along the view of
/// `world_from_camera` (right, up, back), all as if equally far, so that no side of the model is coarser and
/// nothing is left out. `count` is at least 1. Throws InputError (memory), Cancelled.
std::vector<ShadedSplats> reduce_splats(std::span<const RenderLayer> layers,
                                        const glm::dmat3& world_from_camera, std::int64_t count,
                                        const Progress& progress = {});

}  // namespace astrosplat
