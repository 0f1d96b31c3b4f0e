// A stable counting sort over 64^3 cells, each thread on its own part of the rows; sets are in ascending
// order of id already, so being stable is mostly enough.
#include "splats/spatial_order.h"

#include <algorithm>
#include <tuple>

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

/// Rows are counted and placed in parts, one after the other within a part, so that the order is stable.
struct Parts {
    std::int64_t rows, count;
    std::int64_t size() const { return (rows + count - 1) / count; }
    std::int64_t begin(std::int64_t part) const { return std::min(rows, part * size()); }
};

/// Where each part's first row of each cell goes: entry part * cells + cell.
Buffer<std::int64_t> part_starts(const Buffer<std::uint32_t>& keys, const Parts& parts) {
    Buffer<std::int64_t> starts(static_cast<std::size_t>(parts.count) * cells, 0);
    parallel_for(parts.count, [&](std::int64_t part, int) {
        std::int64_t* counts = starts.data() + static_cast<std::size_t>(part) * cells;
        for (std::int64_t i = parts.begin(part); i < parts.begin(part + 1); ++i)
            ++counts[keys[static_cast<std::size_t>(i)]];
    });
    std::int64_t sum = 0;
    for (std::size_t cell = 0; cell < cells; ++cell) {
        for (std::size_t part = 0; part < static_cast<std::size_t>(parts.count); ++part) {
            const std::int64_t count = starts[part * cells + cell];
            starts[part * cells + cell] = sum;
            sum += count;
        }
    }
    return starts;
}

Buffer<std::int64_t> sort_by_cell(const Buffer<std::uint32_t>& keys, const Parts& parts,
                                  Buffer<std::int64_t> next) {
    Buffer<std::int64_t> order(keys.size());
    parallel_for(parts.count, [&](std::int64_t part, int) {
        std::int64_t* places = next.data() + static_cast<std::size_t>(part) * cells;
        for (std::int64_t i = parts.begin(part); i < parts.begin(part + 1); ++i)
            order[static_cast<std::size_t>(places[keys[static_cast<std::size_t>(i)]]++)] = i;
    });
    return order;
}

void sort_cells_by_id(Buffer<std::int64_t>& order, const Buffer<std::int64_t>& starts, const SplatSet& set) {
    parallel_chunks(static_cast<std::int64_t>(cells), 64, [&](std::int64_t begin, std::int64_t end, int) {
        for (auto cell = static_cast<std::size_t>(begin); cell < static_cast<std::size_t>(end); ++cell)
            std::sort(order.begin() + starts[cell],
                      cell + 1 < cells ? order.begin() + starts[cell + 1] : order.end(),
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
    const Parts parts{set.size(), std::min(8, thread_count())};
    const Buffer<std::int64_t> starts = part_starts(keys, parts);
    Buffer<std::int64_t> order = sort_by_cell(keys, parts, starts);
    if (!std::is_sorted(set.id.begin(), set.id.end())) sort_cells_by_id(order, starts, set);
    return order;
}

}  // namespace astrosplat
