// Cells of the set's box as bins of its rows.
#include "splats/spatial_order.h"

#include <algorithm>
#include <array>

#include "core/memory.h"
#include "core/morton.h"
#include "core/parallel.h"
#include "splats/row_order.h"

namespace astrosplat {

namespace {

constexpr std::uint32_t cells_per_axis = 64;
constexpr std::size_t cells = std::size_t{cells_per_axis} * cells_per_axis * cells_per_axis;

std::uint32_t cell_along(double offset, double edge) {
    const double cell = edge > 0.0 ? offset / edge : 0.0;
    if (!(cell > 0.0)) return 0;
    return cell < cells_per_axis - 1 ? static_cast<std::uint32_t>(cell) : cells_per_axis - 1;
}

/// spread_bits of every cell's number: looking it up takes a third of the instructions.
constexpr auto spread_cell = [] {
    std::array<std::uint32_t, cells_per_axis> table{};
    for (std::uint32_t cell = 0; cell < cells_per_axis; ++cell)
        table[cell] = static_cast<std::uint32_t>(spread_bits(cell));
    return table;
}();

/// morton_place of the cell.
std::uint32_t morton_cell(const glm::dvec3& offset, double edge) {
    return spread_cell[cell_along(offset.x, edge)] | spread_cell[cell_along(offset.y, edge)] << 1 |
           spread_cell[cell_along(offset.z, edge)] << 2;
}

Buffer<std::uint32_t> cells_of(const SplatSet& set) {
    const Bounds box = bounds(set);
    const glm::dvec3 extent = box.extent();
    const double edge = std::max({extent.x, extent.y, extent.z}) / cells_per_axis;
    Buffer<std::uint32_t> bins(set.position.size());
    parallel_each(bins.size(), 1 << 14,
                  [&](std::size_t i) { bins[i] = morton_cell(glm::dvec3(set.position[i]) - box.lo, edge); });
    return bins;
}

}  // namespace

template <class Row>
Buffer<Row> spatial_order(const SplatSet& set) {
    if (set.size() == 0) return {};
    constexpr std::int64_t bytes_per_row = sizeof(Row) + sizeof(std::uint32_t);
    claim_memory(set.size() * bytes_per_row, "the order of a .splats file");
    return rows_by_bin<Row>(cells_of(set), cells, set.id);
}

template Buffer<std::uint32_t> spatial_order(const SplatSet& set);
template Buffer<std::uint64_t> spatial_order(const SplatSet& set);

}  // namespace astrosplat
