#include "splat_files/native_layout.h"

#include <fmt/format.h>

#include <cstring>
#include <glm/common.hpp>

#include "core/error.h"
#include "core/hash.h"

namespace astrosplat::native {

static_assert(std::endian::native == std::endian::little, "the structs are the file's bytes");

bool has(std::uint32_t flags, SplatColumn column) {
    const bool is_color = column == SplatColumn::color || column == SplatColumn::alpha;
    if (flags & (is_color ? only_geometry : only_colors)) return false;
    const std::uint32_t own = column_flags[index_of(column)];
    return (flags & own) == own;
}

SplatColumns columns_of(std::uint32_t flags) {
    SplatColumns columns;
    for_each_column([&](auto, SplatColumn column) { columns.set(index_of(column), has(flags, column)); });
    return columns;
}

std::size_t row_bytes(std::uint32_t flags) {
    return bytes_per_splat([&](SplatColumn column) { return has(flags, column); });
}

std::size_t data_offset(std::size_t credit_bytes) {
    return (sizeof(Header) + credit_bytes + sizeof(std::uint64_t) + 63) / 64 * 64;
}

std::size_t block_count(std::uint64_t splats, std::uint32_t block) {
    return std::size_t(splats / block + (splats % block != 0));
}

BlockEntry describe_block(std::uint32_t flags, std::string_view bytes, std::size_t rows) {
    if (!has(flags, SplatColumn::position)) return {glm::vec3(0.0f), glm::vec3(0.0f), xxh64(bytes)};
    BlockEntry entry{glm::vec3(FLT_MAX), glm::vec3(-FLT_MAX), xxh64(bytes)};
    add_to_box({reinterpret_cast<const glm::vec3*>(bytes.data()), rows}, entry);
    return entry;
}

void add_to_box(std::span<const glm::vec3> positions, BlockEntry& entry) {
    glm::vec3 lo = entry.lo, hi = entry.hi;  // not in memory, which the positions might lie in
    for (const glm::vec3& p : positions) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    entry.lo = lo;
    entry.hi = hi;
}

void Checker::fail(std::string_view place, const std::string& expected, const std::string& found) const {
    bad_input(file, place, expected, found);
}

void Checker::checksum(std::string_view place, std::string_view bytes) const {
    std::uint64_t stored;
    std::memcpy(&stored, bytes.data() + bytes.size(), sizeof stored);
    if (stored != xxh64(bytes)) fail(place, "the checksum written with it", "another (damaged file)");
}

void Checker::block(std::size_t number, const BlockEntry& stored, const BlockEntry& found,
                    const std::function<bool()>& is_finite) const {
    const std::string place = fmt::format("block {}", number);
    if (stored.checksum != found.checksum)
        fail(place, "the checksum written with it", "another (damaged file)");
    if (stored.lo != found.lo || stored.hi != found.hi) fail(place, "positions within its bounds", "others");
    if (!is_finite()) fail(place, "finite numbers", "infinity or NaN");
}

namespace {

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
    if (header.flags >= has_origin * 2 || (header.flags & only_geometry && header.flags & only_colors))
        checker.fail("header", "known flags", fmt::format("{:#x}", header.flags));
    const std::uint32_t gaussians = header.flags & (has_scale | has_rotation | has_radius);
    if (gaussians & (has_scale | has_rotation) && gaussians != (has_scale | has_rotation | has_radius))
        checker.fail("header", "scale, rotation and radius together", fmt::format("{:#x}", header.flags));
    if (header.block == 0) checker.fail("header", "blocks of at least one splat", "0");
    return header;
}

NativePart part_of(const Header& header) {
    return header.flags & only_geometry ? NativePart::geometry
           : header.flags & only_colors ? NativePart::colors
                                        : NativePart::whole;
}

const char* name_of(NativePart part) {
    constexpr const char* names[] = {"a whole set", "the geometry of a set, from a cache",
                                     "the colours of a set, from a cache"};
    return names[std::size_t(part)];
}

template <class T>
std::string& append_bytes(const T& value, std::string& bytes) {
    return bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Takes what is behind the last zero of a header's text.
std::string cut_off(const Checker& checker, const char* what, std::string& text) {
    const std::size_t end = text.rfind('\0');
    if (end == std::string::npos)
        checker.fail("header", fmt::format("a zero between credit and {}", what), "none");
    std::string behind = text.substr(end + 1);
    text.resize(end);
    return behind;
}

}  // namespace

Layout read_layout(const Checker& checker, std::string_view bytes) {
    Layout layout{read_header(checker, bytes), {}, {}, {}, {}, {}};
    const Header& header = layout.header;
    const std::size_t per_splat = row_bytes(header.flags), begin = data_offset(header.credit_bytes);
    const std::size_t blocks = block_count(header.splats, header.block);
    const bool fits = header.splats <= bytes.size() / per_splat;
    const std::size_t data = fits ? std::size_t(header.splats) * per_splat : 0;
    const std::size_t table = blocks * sizeof(BlockEntry);
    if (!fits || bytes.size() != begin + data + table + sizeof(std::uint64_t))
        checker.fail("", fmt::format("the length that {} splats take", header.splats),
                     fmt::format("{} bytes (truncated or damaged file)", bytes.size()));
    checker.checksum("header", bytes.substr(0, begin - sizeof(std::uint64_t)));
    checker.checksum("table", bytes.substr(begin + data, table));
    check_values(checker, header);
    layout.credit = bytes.substr(sizeof(Header), header.credit_bytes);
    if (header.flags & has_recipe) layout.recipe = cut_off(checker, "recipe", layout.credit);
    if (header.flags & has_origin) layout.origin = cut_off(checker, "origin", layout.credit);
    layout.blocks = bytes.substr(begin, data);
    layout.table.resize(blocks);
    if (table > 0) std::memcpy(layout.table.data(), bytes.data() + begin + data, table);
    return layout;
}

Layout read_layout(const Checker& checker, std::string_view bytes, NativePart part) {
    Layout layout = read_layout(checker, bytes);
    if (part_of(layout.header) != part)
        checker.fail("header", name_of(part), name_of(part_of(layout.header)));
    return layout;
}

SplatSetFacts facts_of(const Layout& layout) {
    const Header& header = layout.header;
    SplatSetFacts facts;
    facts.spacing = header.spacing;
    facts.max_distance = header.max_distance;
    facts.generated = header.flags & generated;
    facts.divided = header.flags & divided;
    facts.absorbs = header.flags & absorbs;
    facts.display_harmonics = header.flags & display_harmonics;
    facts.test_positions = header.test_positions;
    facts.zero_alpha = header.zero_alpha;
    facts.credit = layout.credit;
    facts.origin = layout.origin;
    facts.recipe = layout.recipe;
    return facts;
}

Block block_at(const Layout& layout, std::size_t number) {
    const std::size_t first = number * layout.header.block;
    const std::size_t rows = std::min<std::size_t>(layout.header.block, layout.header.splats - first);
    const std::size_t per_splat = row_bytes(layout.header.flags);
    return {first, rows, layout.blocks.substr(first * per_splat, rows * per_splat)};
}

std::uint32_t flags_of(const SplatSetFacts& facts, const SplatColumns& held, RowOrder order,
                       NativePart part) {
    std::uint32_t flags =
        (facts.recipe.empty() ? 0u : has_recipe) | (facts.origin.empty() ? 0u : has_origin) |
        (facts.generated ? generated : 0u) | (facts.divided ? divided : 0u) | (facts.absorbs ? absorbs : 0u) |
        (facts.display_harmonics ? display_harmonics : 0u) | (order == RowOrder::id ? by_id : 0u) |
        (part == NativePart::geometry ? only_geometry : 0u) | (part == NativePart::colors ? only_colors : 0u);
    for_each_column([&](auto, SplatColumn column) {
        const std::uint32_t own = column_flags[index_of(column)];
        if (held[index_of(column)] && has(flags | own, column)) flags |= own;
    });
    return flags;
}

std::string text_of(const SplatSetFacts& facts) {
    std::string text = facts.credit;
    for (const std::string* behind : {&facts.origin, &facts.recipe})
        if (!behind->empty()) text += '\0' + *behind;
    return text;
}

std::string header_bytes(const SplatSetFacts& facts, std::uint32_t flags, std::int64_t splats) {
    const std::string text = text_of(facts);
    Header header{};
    std::memcpy(header.magic, magic.data(), sizeof header.magic);
    header.version = version;
    header.flags = flags;
    header.splats = std::uint64_t(splats);
    header.block = splats_per_block;
    header.credit_bytes = std::uint32_t(text.size());
    header.spacing = facts.spacing;
    header.max_distance = facts.max_distance;
    header.test_positions = facts.test_positions;
    header.zero_alpha = facts.zero_alpha;
    std::string bytes;
    append_bytes(header, bytes) += text;
    bytes.resize(data_offset(text.size()) - sizeof(std::uint64_t), '\0');
    return append_bytes(xxh64(bytes), bytes);
}

std::string table_bytes(const std::vector<BlockEntry>& table) {
    std::string bytes(reinterpret_cast<const char*>(table.data()), table.size() * sizeof(BlockEntry));
    return append_bytes(xxh64(bytes), bytes);
}

}  // namespace astrosplat::native
