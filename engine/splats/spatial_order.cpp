// A counting sort over 64^3 cells; sets are in ascending order of id already, so being stable is mostly
// enough.
#include "splats/spatial_order.h"

#include <algorithm>
#include <tuple>
#include <vector>

#include "core/memory.h"
#include "core/parallel.h"

namespace astrosplat {

namespace {

constexpr std::uint32_t cells_per_axis = 64;
constexpr std::size_t cells = std::size_t{cells_per_axis} * cells_per_axis * cells_per_axis;

/// Moves bit i of a 6-bit number to bit 3 i.
std::uint32_t spread(std::uint32_t v) {
    std::uint32_t result = 0;
    for (unsigned bit = 0; bit < 6; ++bit) result |= (v >> bit & 1u) << (3 * bit);
    return result;
}

std::uint32_t cell_along(double offset, double edge) {
    const double cell = edge > 0.0 ? offset / edge : 0.0;
    if (!(cell > 0.0)) return 0;
    return cell < cells_per_axis - 1 ? static_cast<std::uint32_t>(cell) : cells_per_axis - 1;
}

std::uint32_t morton_cell(const glm::dvec3& offset, double edge) {
    return spread(cell_along(offset.x, edge)) | spread(cell_along(offset.y, edge)) << 1 |
           spread(cell_along(offset.z, edge)) << 2;
}

Buffer<std::uint32_t> cells_of(const SplatSet& set) {
    const Bounds box = bounds(set);
    const glm::dvec3 extent = box.extent();
    const double edge = std::max({extent.x, extent.y, extent.z}) / cells_per_axis;
    Buffer<std::uint32_t> keys(set.position.size());
    parallel_chunks(set.size(), 1 << 14, [&](std::int64_t begin, std::int64_t end, int) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
            keys[i] = morton_cell(glm::dvec3(set.position[i]) - box.lo, edge);
    });
    return keys;
}

/// First row of every cell in the sorted order, and the end behind the last.
std::vector<std::int64_t> cell_starts(const Buffer<std::uint32_t>& keys) {
    std::vector<std::int64_t> starts(cells + 1, 0);
    for (const std::uint32_t key : keys) ++starts[key + 1];
    for (std::size_t cell = 0; cell < cells; ++cell) starts[cell + 1] += starts[cell];
    return starts;
}

void sort_cells_by_id(Buffer<std::int64_t>& order, const std::vector<std::int64_t>& starts,
                      const SplatSet& set) {
    parallel_chunks(static_cast<std::int64_t>(cells), 64, [&](std::int64_t begin, std::int64_t end, int) {
        for (auto cell = static_cast<std::size_t>(begin); cell < static_cast<std::size_t>(end); ++cell)
            std::sort(order.begin() + starts[cell], order.begin() + starts[cell + 1],
                      [&](std::int64_t a, std::int64_t b) {
                          const auto id = [&](std::int64_t row) {
                              return set.id[static_cast<std::size_t>(row)];
                          };
                          return std::tuple(id(a), a) < std::tuple(id(b), b);
                      });
    });
}

}  // namespace

Buffer<std::int64_t> spatial_order(const SplatSet& set) {
    constexpr std::int64_t bytes_per_row = sizeof(std::int64_t) + sizeof(std::uint32_t);
    if (set.size() == 0) return {};
    claim_memory(set.size() * bytes_per_row, "the order of a .splats file");
    const Buffer<std::uint32_t> keys = cells_of(set);
    const std::vector<std::int64_t> starts = cell_starts(keys);
    Buffer<std::int64_t> order(keys.size());
    std::vector<std::int64_t> next = starts;
    for (std::size_t i = 0; i < keys.size(); ++i)
        order[static_cast<std::size_t>(next[keys[i]]++)] = static_cast<std::int64_t>(i);
    if (!std::is_sorted(set.id.begin(), set.id.end())) sort_cells_by_id(order, starts, set);
    return order;
}

}  // namespace astrosplat
