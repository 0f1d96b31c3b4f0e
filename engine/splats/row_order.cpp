// A stable counting sort by bin, each thread on its own part of the rows; sets are mostly in ascending order
// of id already, and then being stable is enough.
#include "splats/row_order.h"

#include <atomic>
#include <cassert>
#include <limits>
#include <tuple>

#include "core/parallel.h"

namespace astrosplat {

namespace {

/// Rows are counted and placed in parts, one after the other within a part, so that the order is stable.
struct Parts {
    std::int64_t rows, count;
    std::int64_t size() const { return (rows + count - 1) / count; }
    std::int64_t begin(std::int64_t part) const { return std::min(rows, part * size()); }
};

/// Where each part's first row of each bin goes: entry part * bin_count + bin.
template <class Row>
Buffer<Row> part_starts(const Buffer<std::uint32_t>& bins, std::size_t bin_count, const Parts& parts) {
    Buffer<Row> starts(static_cast<std::size_t>(parts.count) * bin_count, 0);
    parallel_for(parts.count, [&](std::int64_t part, int) {
        Row* const counts = starts.data() + static_cast<std::size_t>(part) * bin_count;
        for (std::int64_t i = parts.begin(part); i < parts.begin(part + 1); ++i) ++counts[bins[i]];
    });
    Row sum = 0;
    for (std::size_t bin = 0; bin < bin_count; ++bin) {
        for (std::size_t part = 0; part < static_cast<std::size_t>(parts.count); ++part) {
            const Row count = starts[part * bin_count + bin];
            starts[part * bin_count + bin] = sum;
            sum += count;
        }
    }
    return starts;
}

/// Moves each part's starts to where its rows of the bin end.
template <class Row>
Buffer<Row> place_rows(const Buffer<std::uint32_t>& bins, std::size_t bin_count, const Parts& parts,
                       Buffer<Row>& starts) {
    Buffer<Row> order(bins.size());
    parallel_for(parts.count, [&](std::int64_t part, int) {
        Row* const places = starts.data() + static_cast<std::size_t>(part) * bin_count;
        for (std::int64_t i = parts.begin(part); i < parts.begin(part + 1); ++i)
            order[places[bins[i]]++] = static_cast<Row>(i);
    });
    return order;
}

/// ends: where each bin's rows end.
template <class Row>
void sort_bins_by_id(Buffer<Row>& order, std::span<const Row> ends, const Buffer<std::uint64_t>& ids) {
    parallel_each(ends.size(), 64, [&](std::size_t bin) {
        std::sort(order.data() + (bin > 0 ? ends[bin - 1] : 0), order.data() + ends[bin],
                  [&](Row a, Row b) { return std::tuple(ids[a], a) < std::tuple(ids[b], b); });
    });
}

}  // namespace

bool ids_ascend(const Buffer<std::uint64_t>& ids) {
    std::atomic<bool> ascend{true};
    parallel_chunks(static_cast<std::int64_t>(ids.size()), 1 << 16,
                    [&](std::int64_t begin, std::int64_t end, int) {
                        const auto from = ids.begin() + std::max(begin - 1, std::int64_t{0});
                        if (ascend && !std::is_sorted(from, ids.begin() + end)) ascend = false;
                    });
    return ascend;
}

template <class Row>
Buffer<Row> rows_by_bin(const Buffer<std::uint32_t>& bins, std::size_t bin_count,
                        const Buffer<std::uint64_t>& ids) {
    assert(bins.size() == ids.size() && bins.size() <= std::numeric_limits<Row>::max());
    if (bins.empty()) return {};
    const Parts parts{static_cast<std::int64_t>(bins.size()), std::min(8, thread_count())};
    Buffer<Row> places = part_starts<Row>(bins, bin_count, parts);
    Buffer<Row> order = place_rows(bins, bin_count, parts, places);
    if (!ids_ascend(ids)) sort_bins_by_id<Row>(order, std::span(places).last(bin_count), ids);
    return order;
}

template Buffer<std::uint32_t> rows_by_bin(const Buffer<std::uint32_t>&, std::size_t,
                                           const Buffer<std::uint64_t>&);
template Buffer<std::uint64_t> rows_by_bin(const Buffer<std::uint32_t>&, std::size_t,
                                           const Buffer<std::uint64_t>&);

}  // namespace astrosplat
