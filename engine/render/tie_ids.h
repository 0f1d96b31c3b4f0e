// Ids of splats that come by the block, as far as ties in depth may ask for them: a record has no room for
// more than a number. In: the layer and ScreenSplat::index of a record. Out: its id.
#pragma once

#include <cstdint>
#include <vector>

#include "render/screen_splat.h"

namespace astrosplat {

/// By layer: for each of its blocks, in the file's order, the ids of those splats of it that left records, in
/// the order of rows. Layers in memory have none; their indices ascend as ids do.
struct TieIds {
    static constexpr int row_bits = 16;
    std::vector<std::vector<const std::uint64_t*>> of_layer;

    std::uint64_t id(const ScreenSplat& splat) const {
        return of_layer[splat.layer][splat.index >> row_bits][splat.index & ((1u << row_bits) - 1)];
    }
};

/// The total order of in_front_of, with ids where indices do not stand for them.
inline bool in_front_of(const ScreenSplat& a, const ScreenSplat& b, const TieIds& ids) {
    if (a.depth != b.depth || a.layer != b.layer || a.index == b.index || ids.of_layer[a.layer].empty())
        return in_front_of(a, b);
    const std::uint64_t id_a = ids.id(a), id_b = ids.id(b);
    return id_a != id_b ? id_a < id_b : a.index < b.index;
}

}  // namespace astrosplat
