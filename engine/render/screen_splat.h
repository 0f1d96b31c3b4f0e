// A splat on the frame: what projection makes of a shaded splat and what the fold consumes, and the total
// order of such splats, into which a tile's are sorted.
#pragma once

#include "core/buffer.h"
#include "core/progress.h"

namespace astrosplat {

/// 40 bytes, because tens of millions of them stream through memory.
struct ScreenSplat {
    float x_px, y_px;      // centre, y down, snapped to 1/256 px
    float radius_px;       // where the falloff reaches zero; not round: the number of a shape
    float opacity;         // alpha * layer opacity * near fade; times the footprint's weight it is s
    float color[3];        // linear, straight
    std::uint32_t depth;   // bits of the projection's sort depth: sorts as the distance from the eye does
    std::uint32_t index;   // of the shaded splat in its layer: stands for the id in ties
    std::uint16_t layer;   // index of the layer in file order
    std::uint16_t hybrid;  // h of the hybrid blend, 65535 = 1
};
static_assert(sizeof(ScreenSplat) == 40);

/// The outline of a splat that is not round: the unit disc under this matrix, offsets from the centre in px,
/// y down.
struct Shape {
    float xx, xy, yx, yy;  // (xx, yx) is where (1, 0) goes
};

// Numbers of shapes are floats with the sign bit set, from just beyond -0 on; radii never have it set but
// for -0.
inline bool is_round(const ScreenSplat& splat) {
    return std::bit_cast<std::uint32_t>(splat.radius_px) <= 0x80000000u;
}
inline std::uint32_t shape_number(const ScreenSplat& splat) {
    return std::bit_cast<std::uint32_t>(splat.radius_px) - 0x80000001u;
}
inline void set_shape_number(ScreenSplat& splat, std::uint32_t number) {
    splat.radius_px = std::bit_cast<float>(0x80000001u + number);
}

/// Orders as floats are ordered, by their bits: numbers of shapes are denormal, and count as 0 while frames
/// are rendered.
inline std::int32_t order_of(float x) {
    const auto bits = std::bit_cast<std::uint32_t>(x);
    return std::int32_t(bits > 0x80000000u ? 0x80000000u - bits : bits);
}

/// Total order of DESIGN 7, near to far: by distance; ties by (layer, id) ascending, those between children
/// of one splat by their place on the frame. (Splats that are not round have no children.)
inline bool in_front_of(const ScreenSplat& a, const ScreenSplat& b) {
    if (a.depth != b.depth) return a.depth < b.depth;
    if (a.layer != b.layer) return a.layer < b.layer;
    if (a.index != b.index) return a.index < b.index;
    if (a.x_px != b.x_px) return a.x_px < b.x_px;
    if (a.y_px != b.y_px) return a.y_px < b.y_px;
    return order_of(a.radius_px) < order_of(b.radius_px);
}

/// Ids of splats that come by the block, as far as ties in depth may ask for them: a record has no room for
/// more than a number. By layer: for each of its blocks, in the file's order, the ids of those splats of it
/// that left records, in the order of rows. Layers in memory have none; their indices ascend as ids do.
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

/// Sorts a tile's splats into that order. In: where they lie. Out: where each lies, near to far; the splats
/// themselves are not moved. Keeps its memory from tile to tile.
class SplatSorter {
  public:
    /// Radix sort on depth, ties by in_front_of. The result lives until the next call.
    std::span<const ScreenSplat* const> sort(std::span<const std::span<const ScreenSplat>> runs,
                                             const Progress& progress, const TieIds& ids = {});
    /// Bytes that sort() takes for each record, besides the records.
    static constexpr std::int64_t bytes_per_record = 2 * sizeof(std::uint64_t) + 2 * sizeof(void*);

  private:
    int read(std::span<const std::span<const ScreenSplat>> runs, const Progress& progress);
    template <class Before>
    void put_in_order(int open_bits, const Before& before, const Progress& progress);

    Buffer<std::uint64_t> codes_, other_;  // depth less the least one above, place of arrival below
    Buffer<const ScreenSplat*> splats_, order_;
};

}  // namespace astrosplat
