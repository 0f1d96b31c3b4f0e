// The projection's usual case, no level of detail, in vectors of splats: the bits of project(), which
// it serves.
#pragma once

#include "render/project.h"

namespace astrosplat {

/// Projects splats [begin, end) as far as they fill whole vectors; returns where the rest begins.
std::int64_t project_whole_blocks(const LayerProjection& layer, std::int64_t begin, std::int64_t end,
                                  const ScreenRect& rect, Buffer<ScreenSplat>& out);

/// h of the hybrid blend for a splat at p in camera space, 65535 = 1; 0 for other blends.
std::uint16_t hybrid_of(const LayerProjection& layer, const glm::vec3& p);

}  // namespace astrosplat
