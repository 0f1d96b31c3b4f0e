// The projection's usual case, splats that level of detail does not divide, in vectors of them: the bits of
// project(), which it serves.
#pragma once

#include "render/project.h"

namespace astrosplat {

/// Projects splats [begin, end) as far as they fill whole vectors; returns where the others begin. Those that
/// level of detail may divide and may show, and stars that stay points close by, are left to `rest`.
std::int64_t project_whole_blocks(const LayerProjection& layer, std::int64_t begin, std::int64_t end,
                                  const ScreenRect& rect, Buffer<ScreenSplat>& out,
                                  Buffer<std::int64_t>& rest);

/// Appends a splat at each of the places at which the frame shows it, as far as the square of half width
/// support_px around it touches `rect`; period_px is the lens's.
inline void push_places(ScreenSplat splat, float period_px, float support_px, const ScreenRect& rect,
                        Buffer<ScreenSplat>& out) {
    const float x_px = splat.x_px;
    for (const float turn_px : {0.0f, -period_px, period_px}) {
        splat.x_px = x_px + turn_px;
        if (splat.x_px + support_px > rect.x0 && splat.x_px - support_px < rect.x1) out.push_back(splat);
        if (period_px == 0.0f) break;
    }
}

/// h of the hybrid blend for a splat at p in camera space, 65535 = 1; 0 for other blends.
std::uint16_t hybrid_of(const LayerProjection& layer, const glm::vec3& p);

}  // namespace astrosplat
