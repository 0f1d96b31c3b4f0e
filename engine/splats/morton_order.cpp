// Morton codes, one scatter by their highest bits, then each of those parts by itself in cache: stable
// throughout, so that neighbours of equal code stay in order of id.
#include "splats/morton_order.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "core/morton.h"
#include "core/parallel.h"
#include "core/sorting.h"
#include "splats/row_order.h"

namespace astrosplat {
namespace {

constexpr unsigned code_bits = 64;
constexpr unsigned part_bits =
    13;  // of the code, highest first: absorbing, and four levels of halving the box
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
        cells_per_unit_ = edge > 0.0 ? static_cast<double>(last_cell) / edge : 0.0;
        if (!set.is_on_lattice()) return;
        for (int k = 0; k < 3; ++k) {
            const double cells = extent[k] * cells_per_unit_;
            double half = static_cast<double>(last_cell / 2 + 1);  // of the power of two that holds them
            while (half > 1.0 && cells <= half) half *= 0.5;
            shift_[k] = half - 0.5 * cells;
        }
    }

    MortonRow operator()(std::int64_t row) const {
        const glm::dvec3 p = (glm::dvec3(set_.position[row]) - lo_) * cells_per_unit_ + shift_;
        const std::uint64_t place = morton_place(cell(p.x), cell(p.y), cell(p.z));
        return {set_.absorbs && set_.color[row].x < 0.0f ? place | morton_absorbs : place, row};
    }

  private:
    static constexpr std::uint64_t last_cell = (std::uint64_t{1} << morton_axis_bits) - 1;
    static std::uint64_t cell(double x) {
        return x > 0.0 ? std::min(static_cast<std::uint64_t>(x), last_cell) : 0;
    }

    const SplatSet& set_;
    glm::dvec3 lo_{0.0};
    double cells_per_unit_ = 0.0;
    glm::dvec3 shift_{0.0};  // cells
};

std::size_t part_of(std::uint64_t code) { return static_cast<std::size_t>(code >> (code_bits - part_bits)); }

/// Rows grouped by the highest bits of their code, in order of row inside a part; starts[part] is where it
/// begins. Codes are made twice: that costs less than the memory to keep them.
Buffer<MortonRow> scatter_to_parts(const SplatSet& set, const Progress& progress,
                                   std::vector<std::int64_t>& starts) {
    const MortonCodes coded(set);
    const std::int64_t chunks = (set.size() + rows_a_chunk - 1) / rows_a_chunk;
    std::vector<std::array<std::int64_t, parts>> next(static_cast<std::size_t>(chunks));
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
    std::vector<std::vector<MortonRow>> scratch(static_cast<std::size_t>(thread_count()));
    parallel_chunks(
        static_cast<std::int64_t>(parts), 8, [&](std::int64_t begin, std::int64_t end, int worker) {
            progress.check();
            for (auto part = static_cast<std::size_t>(begin); part < static_cast<std::size_t>(end); ++part) {
                MortonRow* first = rows.data() + starts[part];
                const auto count = static_cast<std::size_t>(starts[part + 1] - starts[part]);
                sort_part(first, count, scratch[worker]);
                if (!by_id) order_ties(set, first, count);
            }
        });
    progress.at(0.8);
    return rows;
}

}  // namespace astrosplat
