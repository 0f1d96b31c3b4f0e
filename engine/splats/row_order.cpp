// By bin: a stable counting sort, each thread on its own part of the rows; sets are mostly in ascending order
// of id already, and then being stable is enough. Along the curve: one scatter by the highest bits of the
// codes, then each of those parts by itself in cache, stable throughout.
#include "splats/row_order.h"

#include <atomic>
#include <tuple>

#include "core/memory.h"
#include "core/parallel.h"
#include "core/sorting.h"

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
    Buffer<Row> starts(std::size_t(parts.count) * bin_count, 0);
    parallel_for(parts.count, [&](std::int64_t part, int) {
        Row* const counts = starts.data() + std::size_t(part) * bin_count;
        for (std::int64_t i = parts.begin(part); i < parts.begin(part + 1); ++i) ++counts[bins[i]];
    });
    Row sum = 0;
    for (std::size_t bin = 0; bin < bin_count; ++bin) {
        for (std::size_t part = 0; part < std::size_t(parts.count); ++part) {
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
        Row* const places = starts.data() + std::size_t(part) * bin_count;
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

std::uint32_t cell_along(double offset, double edge) {
    const double cell = edge > 0.0 ? offset / edge : 0.0;
    if (!(cell > 0.0)) return 0;
    return cell < SpatialCells::per_axis - 1 ? std::uint32_t(cell) : SpatialCells::per_axis - 1;
}

/// spread_bits of every cell's number: looking it up takes a third of the instructions.
constexpr auto spread_cell = [] {
    std::array<std::uint32_t, SpatialCells::per_axis> table{};
    for (std::uint32_t cell = 0; cell < SpatialCells::per_axis; ++cell)
        table[cell] = std::uint32_t(spread_bits(cell));
    return table;
}();

Buffer<std::uint32_t> cells_of(const SplatSet& set) {
    const SpatialCells cells(bounds(set));
    Buffer<std::uint32_t> bins(set.position.size());
    parallel_each(bins.size(), 1 << 14, [&](std::size_t i) { bins[i] = cells.of(set.position[i]); });
    return bins;
}

}  // namespace

bool ids_ascend(const Buffer<std::uint64_t>& ids) {
    std::atomic<bool> ascend{true};
    parallel_chunks(std::int64_t(ids.size()), 1 << 16, [&](std::int64_t begin, std::int64_t end, int) {
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
    const Parts parts{std::int64_t(bins.size()), std::min(8, thread_count())};
    Buffer<Row> places = part_starts<Row>(bins, bin_count, parts);
    Buffer<Row> order = place_rows(bins, bin_count, parts, places);
    if (!ids_ascend(ids)) sort_bins_by_id<Row>(order, std::span(places).last(bin_count), ids);
    return order;
}

template Buffer<std::uint32_t> rows_by_bin(const Buffer<std::uint32_t>&, std::size_t,
                                           const Buffer<std::uint64_t>&);
template Buffer<std::uint64_t> rows_by_bin(const Buffer<std::uint32_t>&, std::size_t,
                                           const Buffer<std::uint64_t>&);

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
        if (first >> bit & 1u) at[bit % 3] += double(1u << bit / 3);
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

namespace {

constexpr unsigned code_bits = 64;
constexpr unsigned part_bits = 13;  // of the code, highest first: what it is, and four halvings of the box
constexpr std::size_t parts = std::size_t{1} << part_bits;
constexpr std::int64_t rows_a_chunk = 1 << 16;

/// Cells are cubes, so that a thin disk is sampled evenly over its face before its thickness matters. On a
/// lattice, which is as deep before its surface as behind it, the first boundary across a side of the box is
/// in its middle.
class MortonCodes {
  public:
    explicit MortonCodes(const SplatSet& set) : set_(set) {
        const Bounds box = bounds(set);
        lo_ = box.lo;
        const glm::dvec3 extent = box.extent();
        const double edge = std::max({extent.x, extent.y, extent.z});
        cells_per_unit_ = edge > 0.0 ? double(last_cell) / edge : 0.0;
        if (!set.is_on_lattice()) return;
        for (int k = 0; k < 3; ++k) {
            const double cells = extent[k] * cells_per_unit_;
            double half = double(last_cell / 2 + 1);  // of the power of two that holds them
            while (half > 1.0 && cells <= half) half *= 0.5;
            shift_[k] = half - 0.5 * cells;
        }
    }

    MortonRow operator()(std::int64_t row) const {
        const glm::dvec3 p = (glm::dvec3(set_.position[row]) - lo_) * cells_per_unit_ + shift_;
        const std::uint64_t place = morton_place(cell(p.x), cell(p.y), cell(p.z));
        if (set_.absorbs && set_.color[row].x < 0.0f) return {place >> 1 | morton_absorbs, row};
        const std::uint64_t id = set_.id[row];
        return {is_star(id) || is_spike(id) ? place >> 1 | morton_stars : place, row};
    }

  private:
    static constexpr std::uint64_t last_cell = (std::uint64_t{1} << morton_axis_bits) - 1;
    static std::uint64_t cell(double x) { return x > 0.0 ? std::min(std::uint64_t(x), last_cell) : 0; }

    const SplatSet& set_;
    glm::dvec3 lo_{0.0};
    double cells_per_unit_ = 0.0;
    glm::dvec3 shift_{0.0};  // cells
};

std::size_t part_of(std::uint64_t code) { return std::size_t(code >> (code_bits - part_bits)); }

/// Rows grouped by the highest bits of their code, in order of row inside a part; starts[part] is where it
/// begins. Codes are made twice: that costs less than the memory to keep them.
Buffer<MortonRow> scatter_to_parts(const SplatSet& set, const Progress& progress,
                                   std::vector<std::int64_t>& starts) {
    const MortonCodes coded(set);
    const std::int64_t chunks = (set.size() + rows_a_chunk - 1) / rows_a_chunk;
    std::vector<std::array<std::int64_t, parts>> next(chunks);
    const auto each_row = [&](std::int64_t c, const auto& visit) {
        progress.check();
        const std::int64_t end = std::min(set.size(), (c + 1) * rows_a_chunk);
        for (std::int64_t row = c * rows_a_chunk; row < end; ++row) visit(coded(row), next[c]);
    };
    parallel_for(chunks, [&](std::int64_t c, int) {
        next[c].fill(0);
        each_row(c, [](const MortonRow& r, auto& counts) { ++counts[part_of(r.code)]; });
    });
    starts.assign(parts + 1, 0);
    std::int64_t sum = 0;
    for (std::size_t part = 0; part < parts; ++part) {
        starts[part] = sum;
        for (auto& counts : next) sum += std::exchange(counts[part], sum);
    }
    starts[parts] = sum;
    Buffer<MortonRow> sorted(set.position.size());
    parallel_for(chunks, [&](std::int64_t c, int) {
        each_row(c, [&](const MortonRow& r, auto& places) { sorted[places[part_of(r.code)]++] = r; });
    });
    return sorted;
}

void sort_part(MortonRow* rows, std::size_t count, std::vector<MortonRow>& scratch) {
    constexpr std::size_t few = 512;  // below, counting digits costs more than comparing
    if (count < few || count > std::numeric_limits<std::uint32_t>::max())
        return std::sort(rows, rows + count, [](const MortonRow& a, const MortonRow& b) {
            return a.code != b.code ? a.code < b.code : a.row < b.row;
        });
    scratch.resize(count);
    const MortonRow* const sorted = radix_sort<8>(
        rows, scratch.data(), count, 0, code_bits - part_bits, [](const MortonRow& r) { return r.code; },
        [] {});
    if (sorted != rows) std::copy_n(sorted, count, rows);
}

/// Rows of equal codes by id, for sets that are not in that order.
void order_ties(const SplatSet& set, MortonRow* rows, std::size_t count) {
    const auto id = [&](const MortonRow& r) { return set.id[r.row]; };
    for (std::size_t i = 0; i < count;) {
        std::size_t end = i + 1;
        while (end < count && rows[end].code == rows[i].code) ++end;
        std::stable_sort(rows + i, rows + end,
                         [&](const MortonRow& a, const MortonRow& b) { return id(a) < id(b); });
        i = end;
    }
}

}  // namespace

Buffer<MortonRow> morton_order(const SplatSet& set, const Progress& progress) {
    std::vector<std::int64_t> starts;
    Buffer<MortonRow> rows = scatter_to_parts(set, progress, starts);
    progress.at(0.4);
    const bool by_id = ids_ascend(set.id);
    std::vector<std::vector<MortonRow>> scratch(thread_count());
    parallel_chunks(std::int64_t(parts), 8, [&](std::int64_t begin, std::int64_t end, int worker) {
        progress.check();
        for (auto part = std::size_t(begin); part < std::size_t(end); ++part) {
            MortonRow* first = rows.data() + starts[part];
            const auto count = std::size_t(starts[part + 1] - starts[part]);
            sort_part(first, count, scratch[worker]);
            if (!by_id) order_ties(set, first, count);
        }
    });
    progress.at(0.8);
    return rows;
}

}  // namespace astrosplat
