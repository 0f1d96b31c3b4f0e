// Reading and writing of native files: whole sets, their parts, or some of the rows. One list of columns
// (for_each_column) serves sizes, packing and unpacking.
#include "splat_files/native.h"

#include <fmt/format.h>

#include <cstring>

#include "core/memory.h"
#include "core/parallel.h"
#include "splat_files/file_bytes.h"
#include "splat_files/native_layout.h"
#include "splats/row_order.h"

namespace astrosplat {

namespace native {
namespace {

std::uint32_t flags_of_set(const SplatSet& set, RowOrder order, NativePart part) {
    SplatColumns held;
    for_each_column(
        [&](auto array, SplatColumn column) { held.set(index_of(column), !(set.*array).empty()); });
    return flags_of(set, held, order, part);
}

/// Rows [begin, end) of every array that the flags name.
char* pack(const SplatSet& set, std::uint32_t flags, std::int64_t begin, std::int64_t end, char* out) {
    for_each_column([&](auto column, SplatColumn which) {
        const auto& array = set.*column;
        if (!has(flags, which)) return;
        const std::size_t bytes = std::size_t(end - begin) * sizeof array[0];
        std::memcpy(out, &array[begin], bytes);
        out += bytes;
    });
    return out;
}

/// Those rows of every array.
template <class Row>
char* pack(const SplatSet& set, std::span<const Row> rows, char* out) {
    for_each_column([&](auto column, SplatColumn) {
        if (!(set.*column).empty()) out = gather((set.*column).data(), rows, out);
    });
    return out;
}

/// The file, whose blocks are what `pack_rows` makes of their rows.
void write_blocks(const WriteTarget& target, const SplatSet& set, std::uint32_t flags,
                  const Progress& progress, const FormatRows& pack_rows) {
    std::vector<BlockEntry> table(block_count(std::uint64_t(set.size()), splats_per_block));
    SplatSetFacts facts = set;
    if (flags & only_colors) facts.zero_alpha = std::ranges::count(set.alpha, 0.0f);
    write_ordered(
        target, header_bytes(facts, flags, set.size()), set.size(), splats_per_block, row_bytes(flags),
        progress,
        [&](std::int64_t begin, std::int64_t end, char* out) {
            char* const stop = pack_rows(begin, end, out);
            table[begin / splats_per_block] =
                describe_block(flags, {out, std::size_t(stop - out)}, std::size_t(end - begin));
            return stop;
        },
        [&] { return table_bytes(table); });
}

template <class Row>
void write_in_space(const WriteTarget& target, const SplatSet& set, const Progress& progress) {
    const Buffer<Row> order = spatial_order<Row>(set);
    write_blocks(target, set, flags_of_set(set, RowOrder::space, NativePart::whole), progress,
                 [&](std::int64_t begin, std::int64_t end, char* out) {
                     const auto first = std::size_t(begin), count = std::size_t(end - begin);
                     return pack(set, std::span(order).subspan(first, count), out);
                 });
}

}  // namespace
}  // namespace native

void write_native(const WriteTarget& target, const SplatSet& set, const Progress& progress, RowOrder order,
                  NativePart part) {
    check_consistent(set);
    assert(order == RowOrder::id ? ids_ascend(set.id) : part == NativePart::whole);
    const std::uint32_t flags = native::flags_of_set(set, order, part);
    if (order == RowOrder::id)
        native::write_blocks(target, set, flags, progress,
                             [&](std::int64_t begin, std::int64_t end, char* out) {
                                 return native::pack(set, flags, begin, end, out);
                             });
    else if (set.size() <= std::numeric_limits<std::uint32_t>::max())
        native::write_in_space<std::uint32_t>(target, set, progress);
    else
        native::write_in_space<std::uint64_t>(target, set, progress);
}

std::int64_t native_file_bytes(const SplatSet& set, NativePart part) {
    const auto rows = std::uint64_t(set.size());
    const std::size_t table =
        native::block_count(rows, native::splats_per_block) * sizeof(native::BlockEntry);
    return std::int64_t(native::data_offset(native::text_of(set).size()) +
                        rows * native::row_bytes(native::flags_of_set(set, RowOrder::id, part)) + table +
                        sizeof(std::uint64_t));
}

namespace native {
namespace {

/// A set of so many rows, with all that is known of the whole.
SplatSet empty_set(const Layout& layout, std::size_t rows, const OptionalColumns& wanted,
                   const std::string& file) {
    const auto is_read = [&](SplatColumn column) {
        return has(layout.header.flags, column) && is_wanted(column, wanted);
    };
    if (rows > 0) claim_memory(std::int64_t(rows * bytes_per_splat(is_read)), "splats of " + file);
    SplatSet set;
    for_each_column([&](auto array, SplatColumn column) {
        if (is_read(column)) (set.*array).resize(rows);
    });
    static_cast<SplatSetFacts&>(set) = facts_of(layout);
    return set;
}

/// Calls visit(array of the set, the block's bytes of it) for what is there and wanted.
template <class Visit>
void for_each_array(SplatSet& set, std::uint32_t flags, const Block& block, const Visit& visit) {
    const char* p = block.bytes.data();
    for_each_column([&](auto column, SplatColumn which) {
        if (!has(flags, which)) return;
        auto& array = set.*column;
        const char* const from = p;
        p += block.rows * sizeof array[0];
        if (!array.empty()) visit(array, from);
    });
}

/// Copies a block's arrays to their place in the set; false when a number is not finite.
bool unpack(SplatSet& set, std::uint32_t flags, const Block& block) {
    bool finite = true;
    for_each_array(set, flags, block, [&](auto& array, const char* from) {
        std::memcpy(&array[block.first], from, block.rows * sizeof array[0]);
        finite &= all_finite(&array[block.first], block.rows);
    });
    return finite;
}

/// The same of those rows of the block that are among `rows`, to their places among these.
bool unpack(SplatSet& set, std::uint32_t flags, const Block& block, std::span<const std::int64_t> rows) {
    const auto begin = std::ranges::lower_bound(rows, std::int64_t(block.first));
    const auto end = std::lower_bound(begin, rows.end(), std::int64_t(block.first + block.rows));
    const auto to = std::size_t(begin - rows.begin()), count = std::size_t(end - begin);
    bool finite = true;
    for_each_array(set, flags, block, [&](auto& array, const char* from) {
        for (std::size_t i = to; i < to + count; ++i) {
            const std::size_t row = std::size_t(rows[i]) - block.first;
            std::memcpy(&array[i], from + row * sizeof array[0], sizeof array[0]);
            finite &= all_finite(&array[i], 1);
        }
    });
    return finite;
}

/// `unpack_rows` takes what is wanted of the block; false: a number is not finite.
template <class Unpack>
void read_block(const Checker& checker, const Layout& layout, std::size_t number, const Unpack& unpack_rows) {
    const Block block = block_at(layout, number);
    const BlockEntry found = describe_block(layout.header.flags, block.bytes, block.rows);
    checker.block(number, layout.table[number], found, [&] { return unpack_rows(block); });
    forget_pages(block.bytes);
}

void check_order(const Checker& checker, const Layout& layout, const SplatSet& set) {
    if ((layout.header.flags & by_id) && !ids_ascend(set.id))
        checker.fail("", "ids in ascending order", "another order");
}

SplatSet read_native_bytes(const Checker& checker, std::string_view bytes, const OptionalColumns& wanted,
                           NativePart part, const Progress& progress) {
    const Layout layout = read_layout(checker, bytes, part);
    SplatSet set = empty_set(layout, layout.header.splats, wanted, checker.file);
    parallel_parts(layout.table.size(), progress, [&](std::size_t number) {
        read_block(checker, layout, number,
                   [&](const Block& block) { return unpack(set, layout.header.flags, block); });
    });
    check_order(checker, layout, set);
    return set;
}

std::vector<SplatSet> read_rows_of_bytes(const Checker& checker, std::string_view bytes, NativePart part,
                                         std::span<const NativeRows> choices, const Progress& progress) {
    const Layout layout = read_layout(checker, bytes, part);
    std::vector<SplatSet> sets;
    for (const auto& [rows, wanted] : choices) {
        if (!rows.empty() && rows.back() >= std::int64_t(layout.header.splats))
            checker.fail("header", fmt::format("more than {} splats", rows.back()),
                         std::to_string(layout.header.splats));
        sets.push_back(empty_set(layout, rows.size(), wanted, checker.file));
    }
    parallel_parts(layout.table.size(), progress, [&](std::size_t number) {
        read_block(checker, layout, number, [&](const Block& block) {
            bool finite = true;
            for (std::size_t i = 0; i < sets.size(); ++i)
                finite &= unpack(sets[i], layout.header.flags, block, choices[i].rows);
            return finite;
        });
    });
    for (const SplatSet& set : sets) check_order(checker, layout, set);
    return sets;
}

/// Of a file of colours: alphas stand behind the colours of their block.
float alpha_at(const Block& block, std::size_t row) {
    float alpha;
    std::memcpy(&alpha, block.bytes.data() + block.rows * sizeof(glm::vec3) + row * sizeof alpha,
                sizeof alpha);
    return alpha;
}

Buffer<std::int64_t> lit_rows_of(const Layout& layout, const Progress& progress) {
    std::vector<std::size_t> before(layout.table.size() + 1, 0);  // lit rows before each block
    parallel_parts(layout.table.size(), progress, [&](std::size_t number) {
        const Block block = block_at(layout, number);
        for (std::size_t i = 0; i < block.rows; ++i) before[number + 1] += alpha_at(block, i) > 0.0f;
    });
    for (std::size_t i = 1; i < before.size(); ++i) before[i] += before[i - 1];
    Buffer<std::int64_t> rows(before.back());
    parallel_parts(layout.table.size(), progress, [&](std::size_t number) {
        const Block block = block_at(layout, number);
        std::size_t to = before[number];
        for (std::size_t i = 0; i < block.rows; ++i)
            if (alpha_at(block, i) > 0.0f) rows[to++] = std::int64_t(block.first + i);
        forget_pages(block.bytes);
    });
    return rows;
}

}  // namespace
}  // namespace native

SplatSet read_native(const fs::path& file, const Progress& progress, const OptionalColumns& wanted,
                     NativePart part) {
    return read_mapped(file, [&](std::string_view bytes) {
        return native::read_native_bytes(native::Checker{file.string()}, bytes, wanted, part, progress);
    });
}

std::vector<SplatSet> read_native_rows(const fs::path& file, NativePart part,
                                       std::span<const NativeRows> choices, const Progress& progress) {
    return read_mapped(file, [&](std::string_view bytes) {
        return native::read_rows_of_bytes(native::Checker{file.string()}, bytes, part, choices, progress);
    });
}

LitRows native_lit_rows(const fs::path& file, const Progress& progress) {
    return read_mapped(file, [&](std::string_view bytes) {
        const native::Layout layout =
            native::read_layout(native::Checker{file.string()}, bytes, NativePart::colors);
        return LitRows{native::lit_rows_of(layout, progress), std::int64_t(layout.header.splats)};
    });
}

SplatColumns native_columns(const fs::path& file) {
    return read_mapped(file, [&](std::string_view bytes) {
        return native::columns_of(native::read_layout(native::Checker{file.string()}, bytes).header.flags);
    });
}

std::int64_t native_splat_count(const fs::path& file) {
    return read_mapped(file, [&](std::string_view bytes) {
        const native::Header header = native::read_layout(native::Checker{file.string()}, bytes).header;
        const std::int64_t dark = header.flags & native::only_colors ? header.zero_alpha : 0;
        return std::int64_t(header.splats) - dark;
    });
}

}  // namespace astrosplat
