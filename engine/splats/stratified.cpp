// Morton codes, one scatter by their highest bits, then each of those parts by itself in cache: stable
// throughout, so that neighbours with equal codes stay in order of id.
#include "splats/stratified.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <limits>
#include <utility>
#include <vector>

#include "core/memory.h"
#include "core/morton.h"
#include "core/parallel.h"
#include "core/radix_sort.h"
#include "core/shared_maths.h"
#include "splats/row_order.h"

namespace astrosplat {
namespace {

constexpr unsigned code_bits = 3 * morton_axis_bits;
constexpr unsigned part_bits = 12;  // of the code, highest first: four levels of halving the box
constexpr std::size_t parts = std::size_t{1} << part_bits;
constexpr std::int64_t rows_at_once = 1 << 16;

struct CodedRow {
    std::uint64_t code;
    std::int64_t row;
};

/// Cells are cubes, so that a thin disk is sampled evenly over its face before its thickness matters.
class MortonCodes {
  public:
    explicit MortonCodes(const SplatSet& set) : set_(set) {
        const Bounds box = bounds(set);
        lo_ = box.lo;
        const glm::dvec3 extent = box.extent();
        const double edge = std::max({extent.x, extent.y, extent.z});
        cells_per_unit_ = edge > 0.0 ? static_cast<double>(last_cell) / edge : 0.0;
    }

    CodedRow operator()(std::int64_t row) const {
        const glm::dvec3 p = (glm::dvec3(set_.position[row]) - lo_) * cells_per_unit_;
        return {morton_place(cell(p.x), cell(p.y), cell(p.z)), row};
    }

  private:
    static constexpr std::uint64_t last_cell = (std::uint64_t{1} << morton_axis_bits) - 1;
    static std::uint64_t cell(double x) {
        return x > 0.0 ? std::min(static_cast<std::uint64_t>(x), last_cell) : 0;
    }

    const SplatSet& set_;
    glm::dvec3 lo_{0.0};
    double cells_per_unit_ = 0.0;
};

std::size_t part_of(std::uint64_t code) { return static_cast<std::size_t>(code >> (code_bits - part_bits)); }

/// Rows grouped by the highest bits of their code, in order of row inside a part; starts[part] is where it
/// begins. Codes are made twice: that costs less than the memory to keep them.
Buffer<CodedRow> scatter_to_parts(const SplatSet& set, const Progress& progress,
                                  std::vector<std::int64_t>& starts) {
    const MortonCodes coded(set);
    const std::int64_t chunks = (set.size() + rows_at_once - 1) / rows_at_once;
    std::vector<std::array<std::int64_t, parts>> next(static_cast<std::size_t>(chunks));
    const auto each_row = [&](std::int64_t c, const auto& visit) {
        progress.check();
        const std::int64_t end = std::min(set.size(), (c + 1) * rows_at_once);
        for (std::int64_t row = c * rows_at_once; row < end; ++row) visit(coded(row), next[c]);
    };
    parallel_for(chunks, [&](std::int64_t c, int) {
        next[c].fill(0);
        each_row(c, [](const CodedRow& r, auto& counts) { ++counts[part_of(r.code)]; });
    });
    starts.assign(parts + 1, 0);
    std::int64_t sum = 0;
    for (std::size_t part = 0; part < parts; ++part) {
        starts[part] = sum;
        for (auto& counts : next) sum += std::exchange(counts[part], sum);
    }
    starts[parts] = sum;
    Buffer<CodedRow> sorted(set.position.size());
    parallel_for(chunks, [&](std::int64_t c, int) {
        each_row(c, [&](const CodedRow& r, auto& places) { sorted[places[part_of(r.code)]++] = r; });
    });
    return sorted;
}

void sort_part(CodedRow* rows, std::size_t count, std::vector<CodedRow>& scratch) {
    constexpr std::size_t few = 512;  // below, counting digits costs more than comparing
    if (count < few || count > std::numeric_limits<std::uint32_t>::max())
        return std::sort(rows, rows + count, [](const CodedRow& a, const CodedRow& b) {
            return a.code != b.code ? a.code < b.code : a.row < b.row;
        });
    scratch.resize(count);
    const CodedRow* const sorted = radix_sort<8>(
        rows, scratch.data(), count, 0, code_bits - part_bits, [](const CodedRow& r) { return r.code; },
        [] {});
    if (sorted != rows) std::copy_n(sorted, count, rows);
}

/// Rows of equal codes by id, for sets that are not in that order.
void order_ties(const SplatSet& set, CodedRow* rows, std::size_t count) {
    const auto id = [&](const CodedRow& r) { return set.id[r.row]; };
    for (std::size_t i = 0; i < count;) {
        std::size_t end = i + 1;
        while (end < count && rows[end].code == rows[i].code) ++end;
        std::stable_sort(rows + i, rows + end,
                         [&](const CodedRow& a, const CodedRow& b) { return id(a) < id(b); });
        i = end;
    }
}

Buffer<CodedRow> morton_order(const SplatSet& set, const Progress& progress) {
    std::vector<std::int64_t> starts;
    Buffer<CodedRow> rows = scatter_to_parts(set, progress, starts);
    progress.at(0.4);
    const bool by_id = ids_ascend(set.id);
    std::vector<std::vector<CodedRow>> scratch(static_cast<std::size_t>(thread_count()));
    parallel_chunks(
        static_cast<std::int64_t>(parts), 8, [&](std::int64_t begin, std::int64_t end, int worker) {
            progress.check();
            for (auto part = static_cast<std::size_t>(begin); part < static_cast<std::size_t>(end); ++part) {
                CodedRow* first = rows.data() + starts[part];
                const auto count = static_cast<std::size_t>(starts[part + 1] - starts[part]);
                sort_part(first, count, scratch[worker]);
                if (!by_id) order_ties(set, first, count);
            }
        });
    progress.at(0.8);
    return rows;
}

/// The lowest `bits` bits in reverse; v has no others.
std::uint64_t reversed(std::uint64_t v, unsigned bits) {
    if (bits == 0) return 0;
    v = (v & 0x5555555555555555u) << 1 | (v >> 1 & 0x5555555555555555u);
    v = (v & 0x3333333333333333u) << 2 | (v >> 2 & 0x3333333333333333u);
    v = (v & 0x0f0f0f0f0f0f0f0fu) << 4 | (v >> 4 & 0x0f0f0f0f0f0f0f0fu);
    return __builtin_bswap64(v) >> (64 - bits);
}

/// Runs through j = 0 .. 2^bits - 1 and takes the row of rank reversed(j) where there is one. Blocks of 2^low
/// successive j have ranks that agree in their lowest bits, so how many of them exist is known beforehand.
Buffer<std::int64_t> by_reversed_rank(const Buffer<CodedRow>& sorted, const Progress& progress) {
    const auto count = static_cast<std::uint64_t>(sorted.size());
    const auto bits = static_cast<unsigned>(std::bit_width(count - 1));
    const unsigned low = std::min(bits, 16u), high = bits - low;
    const std::uint64_t blocks = std::uint64_t{1} << high;
    std::vector<std::uint64_t> starts(static_cast<std::size_t>(blocks + 1), 0);
    for (std::uint64_t b = 0; b < blocks; ++b) {
        const std::uint64_t first = reversed(b, high);
        starts[b + 1] = starts[b] + (first < count ? (count - first + blocks - 1) >> high : 0);
    }
    Buffer<std::int64_t> order(sorted.size());
    parallel_for(static_cast<std::int64_t>(blocks), [&](std::int64_t block, int) {
        progress.check();
        const std::uint64_t first = reversed(static_cast<std::uint64_t>(block), high);
        std::uint64_t at = starts[block];
        for (std::uint64_t j = 0; j < std::uint64_t{1} << low; ++j) {
            const std::uint64_t rank = reversed(j, low) << high | first;
            if (rank < count) order[at++] = sorted[rank].row;
        }
        assert(at == starts[static_cast<std::size_t>(block) + 1]);
    });
    return order;
}

template <class T, class RowAt>
void copy_array(const Buffer<T>& from, std::int64_t count, const RowAt& row_at, Buffer<T>& to) {
    if (from.empty()) return;
    to.resize(count);
    parallel_each(to.size(), rows_at_once, [&](std::size_t i) { to[i] = from[row_at(i)]; });
}

/// Row i of the result is row row_at(i) of the set.
template <class RowAt>
SplatSet copy_arrays(const SplatSet& set, std::int64_t count, const RowAt& row_at) {
    SplatSet taken;
    static_cast<SplatSetFacts&>(taken) = set;
    for_each_column([&](auto column, SplatColumn) { copy_array(set.*column, count, row_at, taken.*column); });
    return taken;
}

}  // namespace

Buffer<std::int64_t> stratified_order(const SplatSet& set, const Progress& progress) {
    if (set.size() == 0) return {};
    claim_memory(set.size() * static_cast<std::int64_t>(sizeof(CodedRow) + sizeof(std::int64_t)),
                 "the order of a preview");
    Buffer<std::int64_t> order = by_reversed_rank(morton_order(set, progress), progress);
    progress.at(1.0);
    return order;
}

SplatSet take_rows(const SplatSet& set, const Buffer<std::int64_t>& order, std::int64_t count) {
    assert(count >= 0 && count <= static_cast<std::int64_t>(order.size()));
    return copy_arrays(set, count, [&](std::size_t i) { return static_cast<std::size_t>(order[i]); });
}

SplatSet sample_rows(const SplatSet& set, std::int64_t count) {
    const auto wanted = static_cast<std::uint64_t>(std::min(count, set.size()));
    if (wanted == 0) return first_rows(set, 0);
    const auto bits = static_cast<unsigned>(std::bit_width(wanted)) - 1;
    const auto size = static_cast<std::uint64_t>(set.size());
    // One row by chance of each stretch: every n-th row of a lattice would be a pattern.
    return copy_arrays(set, std::int64_t{1} << bits, [&](std::size_t i) {
        const std::uint64_t stretch = reversed(i, bits);
        const std::uint64_t begin = stretch * size >> bits, end = (stretch + 1) * size >> bits;
        const auto low = static_cast<std::uint32_t>(stretch);
        const float chance = shared::as_uniform(shared::as_hash(1u, low, 0u, 0u));
        const auto step = static_cast<std::uint64_t>(chance * static_cast<float>(end - begin));
        return static_cast<std::size_t>(std::min(begin + step, end - 1));
    });
}

SplatSet first_rows(const SplatSet& set, std::int64_t count) {
    assert(count >= 0 && count <= set.size());
    return copy_arrays(set, count, [](std::size_t i) { return i; });
}

}  // namespace astrosplat
