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

std::uint32_t cell_along(double offset, double edge) {
    const double cell = edge > 0.0 ? offset / edge : 0.0;
    if (!(cell > 0.0)) return 0;
    return cell < SpatialCells::per_axis - 1 ? static_cast<std::uint32_t>(cell) : SpatialCells::per_axis - 1;
}

/// spread_bits of every cell's number: looking it up takes a third of the instructions.
constexpr auto spread_cell = [] {
    std::array<std::uint32_t, SpatialCells::per_axis> table{};
    for (std::uint32_t cell = 0; cell < SpatialCells::per_axis; ++cell)
        table[cell] = static_cast<std::uint32_t>(spread_bits(cell));
    return table;
}();

Buffer<std::uint32_t> cells_of(const SplatSet& set) {
    const SpatialCells cells(bounds(set));
    Buffer<std::uint32_t> bins(set.position.size());
    parallel_each(bins.size(), 1 << 14, [&](std::size_t i) { bins[i] = cells.of(set.position[i]); });
    return bins;
}

}  // namespace

SpatialCells::SpatialCells(const Bounds& box) : lo_(box.lo) {
    const glm::dvec3 extent = box.extent();
    edge_ = std::max({extent.x, extent.y, extent.z}) / per_axis;
}

glm::uvec3 SpatialCells::place_of(const glm::dvec3& position) const {
    const glm::dvec3 offset = position - lo_;
    return {cell_along(offset.x, edge_), cell_along(offset.y, edge_), cell_along(offset.z, edge_)};
}

std::uint32_t SpatialCells::number_of(const glm::uvec3& place) {
    return spread_cell[place.x] | spread_cell[place.y] << 1 | spread_cell[place.z] << 2;
}

std::uint32_t SpatialCells::of(const glm::vec3& position) const {
    return number_of(place_of(glm::dvec3(position)));
}

Bounds SpatialCells::cube(std::uint32_t first, std::uint32_t cells) const {
    glm::dvec3 at(0.0);
    double side = 1.0;
    for (std::uint32_t rest = cells; rest > 1; rest /= 8) side *= 2.0;
    for (int bit = 0; bit < 3 * levels; ++bit)
        if (first >> bit & 1u) at[bit % 3] += static_cast<double>(1u << bit / 3);
    return {lo_ + at * edge_, lo_ + (at + side) * edge_};
}

template <class Row>
Buffer<Row> spatial_order(const SplatSet& set) {
    if (set.size() == 0) return {};
    constexpr std::int64_t bytes_per_row = sizeof(Row) + sizeof(std::uint32_t);
    claim_memory(set.size() * bytes_per_row, "the order of a .splats file");
    return rows_by_bin<Row>(cells_of(set), SpatialCells::count, set.id);
}

template Buffer<std::uint32_t> spatial_order(const SplatSet& set);
template Buffer<std::uint64_t> spatial_order(const SplatSet& set);

}  // namespace astrosplat
