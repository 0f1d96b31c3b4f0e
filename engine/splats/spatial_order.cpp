// A stable counting sort over 64^3 cells, each thread on its own part of the rows; sets are in ascending
// order of id already, so being stable is mostly enough.
#include "splats/spatial_order.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <tuple>

#include "core/memory.h"
#include "core/parallel.h"

namespace astrosplat {

namespace {

constexpr std::uint32_t cells_per_axis = 64;
constexpr std::size_t cells = std::size_t{cells_per_axis} * cells_per_axis * cells_per_axis;

/// spread[v]: bit i of the 6-bit number v as bit 3 i.
constexpr std::array<std::uint32_t, cells_per_axis> make_spread() {
    std::array<std::uint32_t, cells_per_axis> table{};
    for (std::uint32_t v = 0; v < cells_per_axis; ++v)
        for (unsigned bit = 0; bit < 6; ++bit) table[v] |= (v >> bit & 1u) << (3 * bit);
    return table;
}
constexpr std::array<std::uint32_t, cells_per_axis> spread = make_spread();

std::uint32_t cell_along(double offset, double edge) {
    const double cell = edge > 0.0 ? offset / edge : 0.0;
    if (!(cell > 0.0)) return 0;
    return cell < cells_per_axis - 1 ? static_cast<std::uint32_t>(cell) : cells_per_axis - 1;
}

std::uint32_t morton_cell(const glm::dvec3& offset, double edge) {
    return spread[cell_along(offset.x, edge)] | spread[cell_along(offset.y, edge)] << 1 |
           spread[cell_along(offset.z, edge)] << 2;
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
template <class Row>
Buffer<Row> part_starts(const Buffer<std::uint32_t>& keys, const Parts& parts) {
    Buffer<Row> starts(static_cast<std::size_t>(parts.count) * cells, 0);
    parallel_for(parts.count, [&](std::int64_t part, int) {
        Row* const counts = starts.data() + static_cast<std::size_t>(part) * cells;
        for (std::int64_t i = parts.begin(part); i < parts.begin(part + 1); ++i)
            ++counts[keys[static_cast<std::size_t>(i)]];
    });
    Row sum = 0;
    for (std::size_t cell = 0; cell < cells; ++cell) {
        for (std::size_t part = 0; part < static_cast<std::size_t>(parts.count); ++part) {
            const Row count = starts[part * cells + cell];
            starts[part * cells + cell] = sum;
            sum += count;
        }
    }
    return starts;
}

/// Moves each part's starts to where its rows of the cell end.
template <class Row>
Buffer<Row> sort_by_cell(const Buffer<std::uint32_t>& keys, const Parts& parts, Buffer<Row>& starts) {
    Buffer<Row> order(keys.size());
    parallel_for(parts.count, [&](std::int64_t part, int) {
        Row* const places = starts.data() + static_cast<std::size_t>(part) * cells;
        for (std::int64_t i = parts.begin(part); i < parts.begin(part + 1); ++i)
            order[places[keys[static_cast<std::size_t>(i)]]++] = static_cast<Row>(i);
    });
    return order;
}

/// ends: where each cell's rows end.
template <class Row>
void sort_cells_by_id(Buffer<Row>& order, const Row* ends, const SplatSet& set) {
    parallel_chunks(static_cast<std::int64_t>(cells), 64, [&](std::int64_t begin, std::int64_t end, int) {
        for (auto cell = static_cast<std::size_t>(begin); cell < static_cast<std::size_t>(end); ++cell)
            std::sort(order.data() + (cell > 0 ? ends[cell - 1] : 0), order.data() + ends[cell],
                      [&](Row a, Row b) { return std::tuple(set.id[a], a) < std::tuple(set.id[b], b); });
    });
}

}  // namespace

template <class Row>
Buffer<Row> spatial_order(const SplatSet& set) {
    assert(static_cast<std::uint64_t>(set.size()) <= std::numeric_limits<Row>::max());
    if (set.size() == 0) return {};
    constexpr std::int64_t bytes_per_row = sizeof(Row) + sizeof(std::uint32_t);
    claim_memory(set.size() * bytes_per_row, "the order of a .splats file");
    const Buffer<std::uint32_t> keys = cells_of(set);
    const Parts parts{set.size(), std::min(8, thread_count())};
    Buffer<Row> places = part_starts<Row>(keys, parts);
    Buffer<Row> order = sort_by_cell(keys, parts, places);
    if (!std::is_sorted(set.id.begin(), set.id.end())) {
        const Row* const ends = places.data() + static_cast<std::size_t>(parts.count - 1) * cells;
        sort_cells_by_id(order, ends, set);
    }
    return order;
}

template Buffer<std::uint32_t> spatial_order(const SplatSet& set);
template Buffer<std::uint64_t> spatial_order(const SplatSet& set);

}  // namespace astrosplat
