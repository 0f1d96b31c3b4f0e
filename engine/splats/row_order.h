// The rows of a set in other orders. In: ids, bins or positions. Out: the rows' numbers by bin, by coarse
// cells of space (as native files store them: a block of neighbouring rows is a small region) or along a
// Morton curve, on which neighbours mostly lie together; and arrays gathered in such an order.
#pragma once

#include <cstring>

#include "core/bounds.h"
#include "core/buffer.h"
#include "core/progress.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// True when ids ascend; equal ones may follow each other.
bool ids_ascend(const Buffer<std::uint64_t>& ids);

/// The rows in ascending order of bin, those of equal bin in ascending order of id, those of equal id in
/// ascending order. Bins are below `bin_count`. The same for any thread count. Row: std::uint32_t, for
/// fewer than 2^32 rows, or std::uint64_t.
template <class Row>
Buffer<Row> rows_by_bin(const Buffer<std::uint32_t>& bins, std::size_t bin_count,
                        const Buffer<std::uint64_t>& ids);

/// Copies the rows one after the other to `out`, which need not be aligned, and returns its end. They lie
/// anywhere in memory, so that fetching them ahead of time is worth more than all else here.
template <class T, class Row>
char* gather(const T* from, std::span<const Row> rows, char* out) {
    constexpr std::size_t ahead = 256;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        __builtin_prefetch(from + rows[std::min(i + ahead, rows.size() - 1)]);
        std::memcpy(out, from + rows[i], sizeof(T));
        out += sizeof(T);
    }
    return out;
}

constexpr unsigned morton_axis_bits = 21;  // of each coordinate

/// Moves bit i of a 21-bit number to bit 3 i.
constexpr std::uint64_t spread_bits(std::uint64_t v) {
    v = (v | v << 32) & 0x001f00000000ffffu;
    v = (v | v << 16) & 0x001f0000ff0000ffu;
    v = (v | v << 8) & 0x100f00f00f00f00fu;
    v = (v | v << 4) & 0x10c30c30c30c30c3u;
    return (v | v << 2) & 0x1249249249249249u;
}

/// x varies fastest. Coordinates are below 2^21.
constexpr std::uint64_t morton_place(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
    return spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
}

/// Cubic cells, 64 along the longest side of a box of positions, numbered in Morton order (x lowest).
class SpatialCells {
  public:
    static constexpr int levels = 6;  // of halvings: 2^levels cells along an axis
    static constexpr std::uint32_t per_axis = 1u << levels, count = 1u << 3 * levels;

    explicit SpatialCells(const Bounds& box);
    /// Cells from the box's lower corner; places outside it count to the cells at its sides.
    glm::uvec3 place_of(const glm::dvec3& position) const;
    static std::uint32_t number_of(const glm::uvec3& place);
    std::uint32_t of(const glm::vec3& position) const;
    /// The cube of the 8^n cells from `first` on, which is a multiple of 8^n; scene units. All positions of
    /// these cells lie in it, but for rounding.
    Bounds cube(std::uint32_t first, std::uint32_t cells) const;
    /// Whether there is more than one place.
    bool extended() const { return edge_ > 0.0; }

  private:
    glm::dvec3 lo_;
    double edge_;  // scene units; 0 where all positions are one
};

/// The cells of the set's box; inside a cell ascending ids, equal ids in the set's order. The same for any
/// thread count. Row: std::uint32_t, for sets of fewer than 2^32 splats, or std::uint64_t.
template <class Row>
Buffer<Row> spatial_order(const SplatSet& set);

/// Codes have 21 bits an axis; those from here on are of splats that absorb, and last come stars of pictures
/// and their spikes, whose lowest bit of x is lost.
constexpr std::uint64_t morton_absorbs = std::uint64_t{1} << 63;
constexpr std::uint64_t morton_stars = std::uint64_t{3} << 62;

struct MortonRow {
    std::uint64_t code;
    std::int64_t row;
};

/// Cells are cubes, the longest side of the set's box 2^21 of them; on a lattice (SplatSetFacts) the
/// first boundary across each side is in the middle of the box. Rows of equal code in order of id. The
/// same for any thread count. Throws Cancelled.
Buffer<MortonRow> morton_order(const SplatSet& set, const Progress& progress = {});

}  // namespace astrosplat
