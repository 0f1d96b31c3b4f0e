// See native.h for the format. One list of columns (for_each_column) serves sizes, packing and unpacking.
#include "splat_files/native.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "splat_files/checksum.h"
#include "splat_files/mapped_file.h"
#include "splat_files/ordered_writer.h"
#include "splats/row_order.h"
#include "splats/spatial_order.h"

namespace astrosplat {

namespace {

static_assert(std::endian::native == std::endian::little, "the structs below are the file's bytes");

constexpr std::string_view magic = "\x89SPLAT\r\n";
constexpr std::uint32_t version = 1;
constexpr std::uint32_t splats_per_block = 65536;
enum Flag : std::uint32_t {
    generated = 1,
    divided = 2,
    has_uv = 4,
    has_normal = 8,
    has_mesh = 16,
    has_radius = 32,
    by_id = 64,
    has_recipe = 128,
    absorbs = 256,
    has_face = 512,
    only_geometry = 1024,
    only_colors = 2048
};

struct Header {
    char magic[8];
    std::uint32_t version, flags;
    std::uint64_t splats;
    std::uint32_t block, credit_bytes;
    glm::dvec3 spacing;
    double max_distance;
    std::int64_t test_positions, zero_alpha;
};
static_assert(sizeof(Header) == 80);

struct BlockEntry {
    glm::vec3 lo, hi;
    std::uint64_t checksum;
};
static_assert(sizeof(BlockEntry) == 32);

/// What says in the flags that a file has a column; 0: every file has it.
std::uint32_t flag_of(SplatColumn column) {
    switch (column) {
        case SplatColumn::uv:
            return has_uv;
        case SplatColumn::normal:
            return has_normal;
        case SplatColumn::mesh:
            return has_mesh;
        case SplatColumn::radius:
            return has_radius;
        case SplatColumn::face:
            return has_face;
        default:
            return 0;
    }
}

bool has(std::uint32_t flags, SplatColumn column) {
    const bool is_color = column == SplatColumn::color || column == SplatColumn::alpha;
    if (flags & (is_color ? only_geometry : only_colors)) return false;
    return (flags & flag_of(column)) == flag_of(column);
}

std::uint32_t flag_of(NativePart part) {
    return part == NativePart::geometry ? only_geometry : part == NativePart::colors ? only_colors : 0u;
}

std::size_t row_bytes(std::uint32_t flags) {
    return bytes_per_splat([&](SplatColumn column) { return has(flags, column); });
}

/// Where the blocks begin, behind header, credit, padding and checksum.
std::size_t data_offset(std::size_t credit_bytes) {
    return (sizeof(Header) + credit_bytes + sizeof(std::uint64_t) + 63) / 64 * 64;
}

std::size_t block_count(std::uint64_t splats, std::uint32_t block) {
    return static_cast<std::size_t>(splats / block + (splats % block != 0));
}

/// Bounds and checksum of a packed block, whose first array is the positions where there are any.
BlockEntry describe_block(std::uint32_t flags, std::string_view bytes, std::size_t rows) {
    if (!has(flags, SplatColumn::position)) return {glm::vec3(0.0f), glm::vec3(0.0f), xxh64(bytes)};
    BlockEntry entry{glm::vec3(FLT_MAX), glm::vec3(-FLT_MAX), xxh64(bytes)};
    for (std::size_t i = 0; i < rows; ++i) {
        glm::vec3 p;
        std::memcpy(&p, bytes.data() + i * sizeof p, sizeof p);
        entry.lo = glm::min(entry.lo, p);
        entry.hi = glm::max(entry.hi, p);
    }
    return entry;
}

// ---- writing

std::uint32_t flags_of(const SplatSet& set, RowOrder order, NativePart part) {
    std::uint32_t flags = (set.recipe.empty() ? 0u : has_recipe) | (set.generated ? generated : 0u) |
                          (set.divided ? divided : 0u) | (set.absorbs ? absorbs : 0u) |
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

// ---- reading

/// A file whose lengths are known to be right.
struct Layout {
    Header header;
    std::string credit, recipe;
    std::string_view blocks;
    std::vector<BlockEntry> table;
};

struct Checker {
    std::string file;

    [[noreturn]] void fail(std::string_view place, const std::string& expected,
                           const std::string& found) const {
        bad_input(file, place, expected, found);
    }
    /// The 8 bytes behind `bytes` are their checksum.
    void checksum(std::string_view place, std::string_view bytes) const {
        std::uint64_t stored;
        std::memcpy(&stored, bytes.data() + bytes.size(), sizeof stored);
        if (stored != xxh64(bytes)) fail(place, "the checksum written with it", "another (damaged file)");
    }
};

void check_values(const Checker& checker, const Header& header) {
    const auto is_length = [](double v) { return v >= 0.0 && v <= DBL_MAX; };
    if (!is_length(header.spacing.x) || !is_length(header.spacing.y) || !is_length(header.spacing.z) ||
        !is_length(header.max_distance))
        checker.fail("header", "spacing and max_distance finite and >= 0", "another value");
    if (header.test_positions < 0 || header.zero_alpha < 0)
        checker.fail("header", "counts of positions >= 0", "a negative count");
}

Header read_header(const Checker& checker, std::string_view bytes) {
    if (bytes.size() < sizeof(Header) || bytes.substr(0, magic.size()) != magic)
        checker.fail("", "an astrosplat .splats file", "another format");
    Header header;
    std::memcpy(&header, bytes.data(), sizeof header);
    if (header.version != version)
        checker.fail("header", fmt::format("version {}", version), std::to_string(header.version));
    if (header.flags >= only_colors * 2 || (header.flags & only_geometry && header.flags & only_colors))
        checker.fail("header", "known flags", fmt::format("{:#x}", header.flags));
    if (header.block == 0) checker.fail("header", "blocks of at least one splat", "0");
    return header;
}

/// Checks all lengths against the file's size, then the checksums of header and table.
Layout read_layout(const Checker& checker, std::string_view bytes) {
    Layout layout{read_header(checker, bytes), {}, {}, {}, {}};
    const Header& header = layout.header;
    const std::size_t per_splat = row_bytes(header.flags), begin = data_offset(header.credit_bytes);
    const std::size_t blocks = block_count(header.splats, header.block);
    const bool fits = header.splats <= bytes.size() / per_splat;
    const std::size_t data = fits ? static_cast<std::size_t>(header.splats) * per_splat : 0;
    const std::size_t table = blocks * sizeof(BlockEntry);
    if (!fits || bytes.size() != begin + data + table + sizeof(std::uint64_t))
        checker.fail("", fmt::format("the length that {} splats take", header.splats),
                     fmt::format("{} bytes (truncated or damaged file)", bytes.size()));
    checker.checksum("header", bytes.substr(0, begin - sizeof(std::uint64_t)));
    checker.checksum("table", bytes.substr(begin + data, table));
    check_values(checker, header);
    layout.credit = bytes.substr(sizeof(Header), header.credit_bytes);
    if (header.flags & has_recipe) {
        const std::size_t end = layout.credit.rfind('\0');
        if (end == std::string::npos) checker.fail("header", "a zero between credit and recipe", "none");
        layout.recipe = layout.credit.substr(end + 1);
        layout.credit.resize(end);
    }
    layout.blocks = bytes.substr(begin, data);
    layout.table.resize(blocks);
    if (table > 0) std::memcpy(layout.table.data(), bytes.data() + begin + data, table);
    return layout;
}

/// The flags of the arrays that are there and wanted.
std::uint32_t flags_to_read(const Header& header, const OptionalColumns& wanted) {
    std::uint32_t flags = header.flags;
    if (!wanted.uv) flags &= ~std::uint32_t{has_uv};
    if (!wanted.normal) flags &= ~std::uint32_t{has_normal};
    if (!wanted.mesh) flags &= ~std::uint32_t{has_mesh};
    if (!wanted.face) flags &= ~std::uint32_t{has_face};
    return flags;
}

SplatSet empty_set(const Layout& layout, const OptionalColumns& wanted, const std::string& file) {
    const Header& header = layout.header;
    const auto rows = static_cast<std::size_t>(header.splats);
    const std::uint32_t flags = flags_to_read(header, wanted);
    if (rows > 0) claim_memory(static_cast<std::int64_t>(rows * row_bytes(flags)), "splats of " + file);
    SplatSet set;
    for_each_column([&](auto column, SplatColumn which) {
        if (has(flags, which)) (set.*column).resize(rows);
    });
    set.spacing = header.spacing;
    set.max_distance = header.max_distance;
    set.generated = header.flags & generated;
    set.divided = header.flags & divided;
    set.absorbs = header.flags & absorbs;
    set.test_positions = header.test_positions;
    set.zero_alpha = header.zero_alpha;
    set.credit = layout.credit;
    set.recipe = layout.recipe;
    return set;
}

bool is_finite(float v) { return std::fabs(v) <= FLT_MAX; }
bool is_finite(const glm::vec2& v) { return is_finite(v.x) && is_finite(v.y); }
bool is_finite(const glm::vec3& v) { return is_finite(v.x) && is_finite(v.y) && is_finite(v.z); }
bool is_finite(std::uint32_t) { return true; }
bool is_finite(std::uint64_t) { return true; }

/// Copies a block's arrays to the set's rows from `first` on; false when a number is not finite.
bool unpack(SplatSet& set, std::uint32_t flags, std::size_t first, std::size_t rows, const char* p) {
    bool finite = true;
    for_each_column([&](auto column, SplatColumn which) {
        if (!has(flags, which)) return;
        auto& array = set.*column;
        const char* const from = p;
        p += rows * sizeof array[0];
        if (array.empty()) return;  // not wanted
        std::memcpy(&array[first], from, rows * sizeof array[0]);
        for (std::size_t i = first; i < first + rows; ++i) finite &= is_finite(array[i]);
    });
    return finite;
}

void read_block(const Checker& checker, const Layout& layout, std::size_t block, SplatSet& set) {
    const std::size_t first = block * layout.header.block;
    const std::size_t rows = std::min<std::size_t>(layout.header.block, layout.header.splats - first);
    const std::size_t per_splat = row_bytes(layout.header.flags);
    const std::string_view bytes = layout.blocks.substr(first * per_splat, rows * per_splat);
    const std::string place = fmt::format("block {}", block);
    const BlockEntry& stored = layout.table[block];
    const BlockEntry found = describe_block(layout.header.flags, bytes, rows);
    if (stored.checksum != found.checksum)
        checker.fail(place, "the checksum written with it", "another (damaged file)");
    if (stored.lo != found.lo || stored.hi != found.hi)
        checker.fail(place, "positions within its bounds", "others");
    if (!unpack(set, layout.header.flags, first, rows, bytes.data()))
        checker.fail(place, "finite numbers", "infinity or NaN");
}

NativePart part_of(const Header& header) {
    return header.flags & only_geometry ? NativePart::geometry
           : header.flags & only_colors ? NativePart::colors
                                        : NativePart::whole;
}

const char* name_of(NativePart part) {
    constexpr const char* names[] = {"a whole set", "the geometry of a set, from a cache",
                                     "the colours of a set, from a cache"};
    return names[static_cast<std::size_t>(part)];
}

SplatSet read_native_bytes(const Checker& checker, std::string_view bytes, const OptionalColumns& wanted,
                           NativePart part, const Progress& progress) {
    const Layout layout = read_layout(checker, bytes);
    if (part_of(layout.header) != part)
        checker.fail("header", name_of(part), name_of(part_of(layout.header)));
    SplatSet set = empty_set(layout, wanted, checker.file);
    parallel_parts(layout.table.size(), progress,
                   [&](std::size_t block) { read_block(checker, layout, block, set); });
    if ((layout.header.flags & by_id) && !ids_ascend(set.id))
        checker.fail("", "ids in ascending order", "another order");
    return set;
}

}  // namespace

SplatSet read_native(const std::filesystem::path& file, const Progress& progress,
                     const OptionalColumns& wanted, NativePart part) {
    return read_mapped(file, [&](std::string_view bytes) {
        return read_native_bytes(Checker{file.string()}, bytes, wanted, part, progress);
    });
}

std::vector<std::string> native_attributes(const std::filesystem::path& file) {
    return read_mapped(file, [&](std::string_view bytes) {
        const std::uint32_t flags = read_layout(Checker{file.string()}, bytes).header.flags;
        std::vector<std::string> names = {"position", "color", "alpha", "distance"};
        if (flags & has_radius) names.emplace_back("radius");
        if (flags & has_uv) names.emplace_back("uv");
        if (flags & has_normal) names.emplace_back("normal");
        if (flags & has_mesh) names.emplace_back("mesh");
        names.emplace_back("id");
        return names;
    });
}

std::int64_t native_splat_count(const std::filesystem::path& file) {
    return read_mapped(file, [&](std::string_view bytes) {
        const Header header = read_layout(Checker{file.string()}, bytes).header;
        const std::int64_t dark = header.flags & only_colors ? header.zero_alpha : 0;
        return static_cast<std::int64_t>(header.splats) - dark;
    });
}

void write_native(const WriteTarget& target, const SplatSet& set, const Progress& progress, RowOrder order,
                  NativePart part) {
    check_consistent(set);
    assert(order == RowOrder::id ? ids_ascend(set.id) : part == NativePart::whole);
    const std::uint32_t flags = flags_of(set, order, part);
    if (order == RowOrder::id)
        write_blocks(target, set, flags, progress, [&](std::int64_t begin, std::int64_t end, char* out) {
            return pack(set, flags, begin, end, out);
        });
    else if (set.size() <= std::numeric_limits<std::uint32_t>::max())
        write_in_space<std::uint32_t>(target, set, progress);
    else
        write_in_space<std::uint64_t>(target, set, progress);
}

std::int64_t native_file_bytes(const SplatSet& set, NativePart part) {
    const auto rows = static_cast<std::uint64_t>(set.size());
    const std::size_t table = block_count(rows, splats_per_block) * sizeof(BlockEntry);
    return static_cast<std::int64_t>(data_offset(text_of(set).size()) +
                                     rows * row_bytes(flags_of(set, RowOrder::id, part)) + table +
                                     sizeof(std::uint64_t));
}

}  // namespace astrosplat
