// A splat on the picture: what projection makes of a shaded splat and what the fold consumes. 40 bytes,
// because tens of millions of them stream through memory.
#pragma once

#include <cstdint>

namespace astrosplat {

struct ScreenSplat {
    float x_px, y_px;      // centre, y down, snapped to 1/256 px
    float radius_px;       // where the falloff reaches zero
    float opacity;         // alpha * layer opacity * near fade; times the footprint's weight it is s
    float color[3];        // linear, straight
    std::uint32_t depth;   // bits of the projection's sort key: sorts as the distance from the eye does
    std::uint32_t index;   // of the shaded splat in its layer: stands for the id in ties
    std::uint16_t layer;   // index of the layer in file order
    std::uint16_t hybrid;  // h of the hybrid blend, 65535 = 1
};
static_assert(sizeof(ScreenSplat) == 40);

/// Total order of DESIGN 7, near to far: by distance; ties by (layer, id) ascending, those between children
/// of one splat by their place on the picture.
inline bool in_front_of(const ScreenSplat& a, const ScreenSplat& b) {
    if (a.depth != b.depth) return a.depth < b.depth;
    if (a.layer != b.layer) return a.layer < b.layer;
    if (a.index != b.index) return a.index < b.index;
    if (a.x_px != b.x_px) return a.x_px < b.x_px;
    if (a.y_px != b.y_px) return a.y_px < b.y_px;
    return a.radius_px < b.radius_px;
}

}  // namespace astrosplat
