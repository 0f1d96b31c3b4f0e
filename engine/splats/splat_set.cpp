// Bounds, order and consistency of splat sets. Rows are sorted by the upper bits of their ids, counted, and
// then in each step by all of them.
#include "splats/splat_set.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>
#include <span>
#include <vector>

#include "core/memory.h"
#include "core/parallel.h"
#include "splats/row_order.h"

namespace astrosplat {
namespace {

constexpr std::int64_t splats_per_chunk = 1 << 16;

template <class T, class Row>
void permute(Buffer<T>& values, const Buffer<Row>& from) {
    if (values.empty()) return;
    Buffer<T> sorted(values.size());
    parallel_chunks(static_cast<std::int64_t>(from.size()), splats_per_chunk,
                    [&](std::int64_t begin, std::int64_t end, int) {
                        gather(values.data(), std::span<const Row>(from.data() + begin, from.data() + end),
                               reinterpret_cast<char*>(sorted.data() + begin));
                    });
    values = std::move(sorted);
}

/// Ids in some tens of thousands of equal steps from the lowest to the highest.
struct IdSteps {
    std::uint64_t lowest;
    int shift;
    std::size_t count;
};

IdSteps steps_of(const Buffer<std::uint64_t>& ids) {
    constexpr int step_bits = 16;
    const auto [lowest, highest] = std::ranges::minmax_element(ids);
    const int shift = std::max(0, static_cast<int>(std::bit_width(*highest - *lowest)) - step_bits);
    return {*lowest, shift, static_cast<std::size_t>((*highest - *lowest) >> shift) + 1};
}

template <class T>
void give_back(Buffer<T>& values) {
    values = Buffer<T>();  // clear() would keep the memory
}

template <class Row>
void sort_rows(SplatSet& set) {
    const IdSteps steps = steps_of(set.id);
    Buffer<std::uint32_t> bins(set.id.size());
    parallel_each(bins.size(), splats_per_chunk, [&](std::size_t i) {
        bins[i] = static_cast<std::uint32_t>((set.id[i] - steps.lowest) >> steps.shift);
    });
    const Buffer<Row> order = rows_by_bin<Row>(bins, steps.count, set.id);
    for_each_column([&](auto column, SplatColumn) { permute(set.*column, order); });
}

}  // namespace

void drop_splats(SplatSet& set) {
    for_each_column([&](auto column, SplatColumn) { give_back(set.*column); });
}

void drop_columns(SplatSet& set, const OptionalColumns& wanted) {
    if (!wanted.uv) give_back(set.uv);
    if (!wanted.normal) give_back(set.normal);
    if (!wanted.mesh) give_back(set.mesh);
    if (!wanted.face) give_back(set.face);
}

Bounds bounds(const SplatSet& set) {
    const std::int64_t chunks = (set.size() + splats_per_chunk - 1) / splats_per_chunk;
    std::vector<Bounds> parts(static_cast<std::size_t>(chunks));
    parallel_for(chunks, [&](std::int64_t part, int) {
        Bounds box;  // kept apart from its neighbours in `parts`, which other threads write
        const std::int64_t end = std::min(set.size(), (part + 1) * splats_per_chunk);
        for (std::int64_t i = part * splats_per_chunk; i < end; ++i) {
            if (!set.stars || !is_direction(set.position[i])) box.add(glm::dvec3(set.position[i]));
        }
        parts[part] = box;
    });
    Bounds box;
    for (const Bounds& part : parts) box.add(part);
    return box;
}

void sort_by_id(SplatSet& set) {
    check_consistent(set);
    if (ids_ascend(set.id)) return;
    constexpr std::int64_t bytes_per_row = sizeof(std::uint64_t) + sizeof(std::uint32_t) + sizeof(glm::vec3);
    claim_memory(set.size() * bytes_per_row, "sorting splats by id");
    if (set.size() <= std::numeric_limits<std::uint32_t>::max())
        sort_rows<std::uint32_t>(set);
    else
        sort_rows<std::uint64_t>(set);
}

void check_consistent([[maybe_unused]] const SplatSet& set) {
    for_each_column([&]([[maybe_unused]] auto column, [[maybe_unused]] SplatColumn which) {
        assert((set.*column).size() == set.position.size() || (is_optional(which) && (set.*column).empty()));
    });
}

}  // namespace astrosplat
