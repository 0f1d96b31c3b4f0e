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
#include "splat_files/native_layout.h"
#include "splat_files/ordered_writer.h"
#include "splats/row_order.h"
#include "splats/spatial_order.h"

namespace astrosplat {

namespace native {
namespace {

std::uint32_t flags_of(const SplatSet& set, RowOrder order, NativePart part) {
    std::uint32_t flags = (set.recipe.empty() ? 0u : has_recipe) | (set.generated ? generated : 0u) |
                          (set.divided ? divided : 0u) | (set.absorbs ? absorbs : 0u) |
                          (set.display_harmonics ? display_harmonics : 0u) |
                          (order == RowOrder::id ? by_id : 0u) | flag_of(part);
    for_each_column([&](auto column, SplatColumn which) {
        if (has(flags | flag_of(which), which) && !(set.*column).empty()) flags |= flag_of(which);
    });
    return flags;
}

/// What stands behind the header: the credit, and behind a zero the recipe.
std::string text_of(const SplatSet& set) {
    return set.recipe.empty() ? set.credit : set.credit + '\0' + set.recipe;
}

std::string header_bytes(const SplatSet& set, std::uint32_t flags) {
    const std::string text = text_of(set);
    Header header{};
    std::memcpy(header.magic, magic.data(), sizeof header.magic);
    header.version = version;
    header.flags = flags;
    header.splats = static_cast<std::uint64_t>(set.size());
    header.block = splats_per_block;
    header.credit_bytes = static_cast<std::uint32_t>(text.size());
    header.spacing = set.spacing;
    header.max_distance = set.max_distance;
    header.test_positions = set.test_positions;
    header.zero_alpha = flags & only_colors ? std::ranges::count(set.alpha, 0.0f) : set.zero_alpha;
    std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
    bytes += text;
    bytes.resize(data_offset(text.size()) - sizeof(std::uint64_t), '\0');
    const std::uint64_t checksum = xxh64(bytes);
    return bytes.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
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

std::string table_bytes(const std::vector<BlockEntry>& table) {
    std::string bytes(reinterpret_cast<const char*>(table.data()), table.size() * sizeof(BlockEntry));
    const std::uint64_t checksum = xxh64(bytes);
    return bytes.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
}

/// The file, whose blocks are what `pack_rows` makes of their rows.
void write_blocks(const WriteTarget& target, const SplatSet& set, std::uint32_t flags,
                  const Progress& progress, const FormatRows& pack_rows) {
    std::vector<BlockEntry> table(block_count(static_cast<std::uint64_t>(set.size()), splats_per_block));
    write_ordered(
        target, header_bytes(set, flags), set.size(), splats_per_block, row_bytes(flags), progress,
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
    write_blocks(target, set, flags_of(set, RowOrder::space, NativePart::whole), progress,
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
    const std::uint32_t flags = native::flags_of(set, order, part);
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
                                     rows * native::row_bytes(native::flags_of(set, RowOrder::id, part)) +
                                     table + sizeof(std::uint64_t));
}

}  // namespace astrosplat
