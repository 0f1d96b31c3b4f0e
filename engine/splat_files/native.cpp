// Writing of native files. One list of columns (for_each_column) serves sizes, packing and unpacking.
#include "splat_files/native.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "splat_files/checksum.h"
#include "splat_files/native_bytes.h"
#include "splat_files/ordered_writer.h"
#include "splats/row_order.h"
#include "splats/spatial_order.h"

namespace astrosplat {

namespace native {
namespace {

std::uint32_t flags_of_set(const SplatSet& set, RowOrder order, NativePart part) {
    const auto holds = [&](SplatColumn wanted) {
        bool there = false;
        for_each_column([&](auto column, SplatColumn which) {
            if (which == wanted) there = !(set.*column).empty();
        });
        return there;
    };
    return flags_of(set, holds, order, part);
}

/// Rows [begin, end) of every array that the flags name.
char* pack(const SplatSet& set, std::uint32_t flags, std::int64_t begin, std::int64_t end, char* out) {
    for_each_column([&](auto column, SplatColumn which) {
        const auto& array = set.*column;
        if (!has(flags, which)) return;
        const std::size_t bytes = static_cast<std::size_t>(end - begin) * sizeof array[0];
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
    std::vector<BlockEntry> table(block_count(static_cast<std::uint64_t>(set.size()), splats_per_block));
    SplatSetFacts facts = set;
    if (flags & only_colors) facts.zero_alpha = std::ranges::count(set.alpha, 0.0f);
    write_ordered(
        target, header_bytes(facts, flags, set.size()), set.size(), splats_per_block, row_bytes(flags),
        progress,
        [&](std::int64_t begin, std::int64_t end, char* out) {
            char* const stop = pack_rows(begin, end, out);
            table[begin / splats_per_block] = describe_block(
                flags, {out, static_cast<std::size_t>(stop - out)}, static_cast<std::size_t>(end - begin));
            return stop;
        },
        [&] { return table_bytes(table); });
}

template <class Row>
void write_in_space(const WriteTarget& target, const SplatSet& set, const Progress& progress) {
    const Buffer<Row> order = spatial_order<Row>(set);
    write_blocks(target, set, flags_of_set(set, RowOrder::space, NativePart::whole), progress,
                 [&](std::int64_t begin, std::int64_t end, char* out) {
                     const auto first = static_cast<std::size_t>(begin),
                                count = static_cast<std::size_t>(end - begin);
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
    const auto rows = static_cast<std::uint64_t>(set.size());
    const std::size_t table =
        native::block_count(rows, native::splats_per_block) * sizeof(native::BlockEntry);
    return static_cast<std::int64_t>(native::data_offset(native::text_of(set).size()) +
                                     rows * native::row_bytes(native::flags_of_set(set, RowOrder::id, part)) +
                                     table + sizeof(std::uint64_t));
}

}  // namespace astrosplat
