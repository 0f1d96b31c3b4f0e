// Reading of native files: whole sets, their parts, or some of the rows.
#include "splat_files/native_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/memory.h"
#include "core/parallel.h"
#include "splat_files/mapped_file.h"
#include "splat_files/native_layout.h"
#include "splats/row_order.h"

namespace astrosplat {

namespace native {
namespace {

/// The flags of the arrays that are there and wanted.
std::uint32_t flags_to_read(const Header& header, const OptionalColumns& wanted) {
    std::uint32_t flags = header.flags;
    if (!wanted.uv) flags &= ~std::uint32_t{has_uv};
    if (!wanted.normal) flags &= ~std::uint32_t{has_normal};
    if (!wanted.mesh) flags &= ~std::uint32_t{has_mesh};
    if (!wanted.face) flags &= ~std::uint32_t{has_face};
    return flags;
}

/// A set of so many rows, with all that is known of the whole.
SplatSet empty_set(const Layout& layout, std::size_t rows, const OptionalColumns& wanted,
                   const std::string& file) {
    const std::uint32_t flags = flags_to_read(layout.header, wanted);
    if (rows > 0) claim_memory(static_cast<std::int64_t>(rows * row_bytes(flags)), "splats of " + file);
    SplatSet set;
    for_each_column([&](auto column, SplatColumn which) {
        if (has(flags, which)) (set.*column).resize(rows);
    });
    static_cast<SplatSetFacts&>(set) = facts_of(layout);
    return set;
}

bool is_finite(float v) { return std::fabs(v) <= FLT_MAX; }
bool is_finite(const glm::vec4& v) {
    return is_finite(v.x) && is_finite(v.y) && is_finite(v.z) && is_finite(v.w);
}
bool is_finite(const Harmonics& harmonics) {
    return std::ranges::all_of(
        harmonics.c, [](const glm::vec3& c) { return is_finite(c.x) && is_finite(c.y) && is_finite(c.z); });
}
bool is_finite(const glm::vec2& v) { return is_finite(v.x) && is_finite(v.y); }
bool is_finite(const glm::vec3& v) { return is_finite(v.x) && is_finite(v.y) && is_finite(v.z); }
bool is_finite(std::uint32_t) { return true; }
bool is_finite(std::uint64_t) { return true; }

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
        for (std::size_t i = block.first; i < block.first + block.rows; ++i) finite &= is_finite(array[i]);
    });
    return finite;
}

/// The same of those rows of the block that are among `rows`, to their places among these.
bool unpack(SplatSet& set, std::uint32_t flags, const Block& block, std::span<const std::int64_t> rows) {
    const auto begin = std::ranges::lower_bound(rows, static_cast<std::int64_t>(block.first));
    const auto end = std::lower_bound(begin, rows.end(), static_cast<std::int64_t>(block.first + block.rows));
    const auto to = static_cast<std::size_t>(begin - rows.begin()),
               count = static_cast<std::size_t>(end - begin);
    bool finite = true;
    for_each_array(set, flags, block, [&](auto& array, const char* from) {
        for (std::size_t i = to; i < to + count; ++i) {
            const std::size_t row = static_cast<std::size_t>(rows[i]) - block.first;
            std::memcpy(&array[i], from + row * sizeof array[0], sizeof array[0]);
            finite &= is_finite(array[i]);
        }
    });
    return finite;
}

/// `unpack_rows` takes what is wanted of the block; false: a number is not finite.
template <class Unpack>
void read_block(const Checker& checker, const Layout& layout, std::size_t number, const Unpack& unpack_rows) {
    const Block block = block_at(layout, number);
    const std::string place = fmt::format("block {}", number);
    const BlockEntry& stored = layout.table[number];
    const BlockEntry found = describe_block(layout.header.flags, block.bytes, block.rows);
    if (stored.checksum != found.checksum)
        checker.fail(place, "the checksum written with it", "another (damaged file)");
    if (stored.lo != found.lo || stored.hi != found.hi)
        checker.fail(place, "positions within its bounds", "others");
    if (!unpack_rows(block)) checker.fail(place, "finite numbers", "infinity or NaN");
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
        if (!rows.empty() && rows.back() >= static_cast<std::int64_t>(layout.header.splats))
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
            if (alpha_at(block, i) > 0.0f) rows[to++] = static_cast<std::int64_t>(block.first + i);
        forget_pages(block.bytes);
    });
    return rows;
}

}  // namespace
}  // namespace native

SplatSet read_native(const std::filesystem::path& file, const Progress& progress,
                     const OptionalColumns& wanted, NativePart part) {
    return read_mapped(file, [&](std::string_view bytes) {
        return native::read_native_bytes(native::Checker{file.string()}, bytes, wanted, part, progress);
    });
}

std::vector<SplatSet> read_native_rows(const std::filesystem::path& file, NativePart part,
                                       std::span<const NativeRows> choices, const Progress& progress) {
    return read_mapped(file, [&](std::string_view bytes) {
        return native::read_rows_of_bytes(native::Checker{file.string()}, bytes, part, choices, progress);
    });
}

LitRows native_lit_rows(const std::filesystem::path& file, const Progress& progress) {
    return read_mapped(file, [&](std::string_view bytes) {
        const native::Layout layout =
            native::read_layout(native::Checker{file.string()}, bytes, NativePart::colors);
        return LitRows{native::lit_rows_of(layout, progress),
                       static_cast<std::int64_t>(layout.header.splats)};
    });
}

std::vector<std::string> native_attributes(const std::filesystem::path& file) {
    return read_mapped(file, [&](std::string_view bytes) {
        const std::uint32_t flags = native::read_layout(native::Checker{file.string()}, bytes).header.flags;
        std::vector<std::string> names = {"position", "color", "alpha", "distance"};
        if (flags & native::has_radius) names.emplace_back("radius");
        if (flags & native::has_uv) names.emplace_back("uv");
        if (flags & native::has_normal) names.emplace_back("normal");
        if (flags & native::has_mesh) names.emplace_back("mesh");
        if (flags & native::has_scale) names.insert(names.end(), {"scale", "rotation"});
        if (flags & native::has_harmonics) names.emplace_back("harmonics");
        names.emplace_back("id");
        return names;
    });
}

std::int64_t native_splat_count(const std::filesystem::path& file) {
    return read_mapped(file, [&](std::string_view bytes) {
        const native::Header header = native::read_layout(native::Checker{file.string()}, bytes).header;
        const std::int64_t dark = header.flags & native::only_colors ? header.zero_alpha : 0;
        return static_cast<std::int64_t>(header.splats) - dark;
    });
}

}  // namespace astrosplat
