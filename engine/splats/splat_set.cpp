// Bounds, order, consistency and samples of splat sets. Rows are sorted by the upper bits of their ids,
// counted, and then in each step by all of them.
#include "splats/splat_set.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "core/shared_maths.h"
#include "splats/row_order.h"

namespace astrosplat {
namespace {

constexpr std::int64_t splats_per_chunk = 1 << 16;

/// These rows of a column, in their order; a column that is not there stays so.
template <class T, class Row>
Buffer<T> taken_rows(const Buffer<T>& from, const Buffer<Row>& rows) {
    Buffer<T> taken(from.empty() ? 0 : rows.size());
    parallel_chunks(std::int64_t(taken.size()), splats_per_chunk,
                    [&](std::int64_t begin, std::int64_t end, int) {
                        gather(from.data(), std::span<const Row>(rows.data() + begin, rows.data() + end),
                               reinterpret_cast<char*>(taken.data() + begin));
                    });
    return taken;
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
    const int shift = std::max(0, int(std::bit_width(*highest - *lowest)) - step_bits);
    return {*lowest, shift, std::size_t((*highest - *lowest) >> shift) + 1};
}

template <class T>
void give_back(Buffer<T>& values) {
    values = Buffer<T>();  // clear() would keep the memory
}

template <class Row>
void sort_rows(SplatSet& set) {
    const IdSteps steps = steps_of(set.id);
    Buffer<std::uint32_t> bins(set.id.size());
    parallel_each(bins.size(), splats_per_chunk,
                  [&](std::size_t i) { bins[i] = std::uint32_t((set.id[i] - steps.lowest) >> steps.shift); });
    const Buffer<Row> order = rows_by_bin<Row>(bins, steps.count, set.id);
    for_each_column([&](auto column, SplatColumn) { set.*column = taken_rows(set.*column, order); });
}

}  // namespace

std::vector<std::string> column_names(const SplatColumns& columns) {
    using enum SplatColumn;
    constexpr std::array in_order = {position, color, alpha, distance, radius,    uv,
                                     normal,   mesh,  scale, rotation, harmonics, id};
    static_assert(in_order.size() + 1 == splat_column_count, "all but the face, which no file tells");
    std::vector<std::string> names;
    for (const SplatColumn column : in_order)
        if (columns[index_of(column)]) names.emplace_back(name_of(column));
    return names;
}

void drop_splats(SplatSet& set) {
    for_each_column([&](auto column, SplatColumn) { give_back(set.*column); });
}

void drop_columns(SplatSet& set, const OptionalColumns& wanted) {
    for_each_column([&](auto column, SplatColumn which) {
        if (!is_wanted(which, wanted)) give_back(set.*column);
    });
}

Bounds bounds(const SplatSet& set) {
    const std::int64_t chunks = (set.size() + splats_per_chunk - 1) / splats_per_chunk;
    std::vector<Bounds> parts(chunks);
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

SplatSet take_rows(const SplatSet& set, const Buffer<std::int64_t>& rows) {
    SplatSet taken;
    static_cast<SplatSetFacts&>(taken) = set;
    for_each_column([&](auto column, SplatColumn) { taken.*column = taken_rows(set.*column, rows); });
    return taken;
}

std::int64_t sampled_row(std::int64_t size, std::int64_t count, std::int64_t i) {
    const auto begin_of = [&](std::int64_t stretch) {
        return std::int64_t(double(stretch) * double(size) / double(count));
    };
    const std::int64_t begin = begin_of(i), end = i + 1 < count ? begin_of(i + 1) : size;
    const float chance = shared::as_uniform(shared::as_hash(1u, std::uint32_t(i), 0u, 0u));
    const auto step = std::int64_t(chance * float(end - begin));
    return std::min(begin + step, end - 1);
}

Buffer<std::int64_t> sampled_rows(std::int64_t size, std::int64_t count) {
    Buffer<std::int64_t> rows(std::size_t(std::min(count, size)));
    const auto sampled = std::int64_t(rows.size());
    for (std::int64_t i = 0; i < sampled; ++i) rows[i] = sampled_row(size, sampled, i);
    return rows;
}

SplatSet sample_rows(const SplatSet& set, std::int64_t count) {
    return take_rows(set, sampled_rows(set.size(), count));
}

}  // namespace astrosplat
