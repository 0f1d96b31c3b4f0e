// The order in which a native file stores its splats: coarse cells along a Morton curve, so that a block of
// neighbouring rows is a small region of space. In: SplatSet. Out: the row indices in that order.
#pragma once

#include <cstdint>

#include "core/bounds.h"
#include "core/buffer.h"
#include "splats/splat_set.h"

namespace astrosplat {

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

}  // namespace astrosplat
