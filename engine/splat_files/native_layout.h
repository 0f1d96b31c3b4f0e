// The format of native.h as structs and bytes: header, blocks and table. Reading: bytes of a file become a
// Layout whose lengths and checksums are known to be right. Writing: the facts of a set become flags, header
// and table. For the readers and the writers alone.
#pragma once

#include <cfloat>
#include <glm/vec3.hpp>

#include "splat_files/native.h"
#include "splats/splat_set.h"

namespace astrosplat::native {

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
    only_colors = 2048,
    has_scale = 4096,
    has_rotation = 8192,
    has_harmonics = 16384,
    display_harmonics = 32768,
    has_origin = 65536
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

/// The bits of the flags that say that a file has a column, by index_of(); 0: every file has it.
inline constexpr auto column_flags = [] {
    std::array<std::uint32_t, splat_column_count> flags{};
    constexpr std::uint32_t optional[] = {has_uv,   has_normal, has_mesh,     has_radius,
                                          has_face, has_scale,  has_rotation, has_harmonics};
    std::ranges::copy(optional, flags.end() - std::ssize(optional));
    return flags;
}();
static_assert(column_flags.back() == has_harmonics);
bool has(std::uint32_t flags, SplatColumn column);
SplatColumns columns_of(std::uint32_t flags);
std::size_t row_bytes(std::uint32_t flags);

/// Where the blocks begin, behind header, credit (with origin and recipe), padding and checksum.
std::size_t data_offset(std::size_t credit_bytes);
std::size_t block_count(std::uint64_t splats, std::uint32_t block);
/// Bounds and checksum of a packed block, whose first array is the positions where there are any.
BlockEntry describe_block(std::uint32_t flags, std::string_view bytes, std::size_t rows);

/// Widens the entry's bounds by positions.
void add_to_box(std::span<const glm::vec3> positions, BlockEntry& entry);

/// A file whose lengths are known to be right.
struct Layout {
    Header header;
    std::string credit, origin, recipe;
    std::string_view blocks;
    std::vector<BlockEntry> table;
};

struct Checker {
    std::string file;

    [[noreturn]] void fail(std::string_view place, const std::string& expected,
                           const std::string& found) const;
    /// The 8 bytes behind `bytes` are their checksum.
    void checksum(std::string_view place, std::string_view bytes) const;
    /// Checksum and bounds as stored, then that all numbers are finite.
    void block(std::size_t number, const BlockEntry& stored, const BlockEntry& found,
               const std::function<bool()>& is_finite) const;
};

/// Checks all lengths against the file's size, then the checksums of header and table. Throws InputError.
Layout read_layout(const Checker& checker, std::string_view bytes);
/// The same, and that it is this part of a set.
Layout read_layout(const Checker& checker, std::string_view bytes, NativePart part);

/// The set as the header describes it.
SplatSetFacts facts_of(const Layout& layout);

/// A block of the file.
struct Block {
    std::size_t first, rows;  // of the file's rows
    std::string_view bytes;
};
Block block_at(const Layout& layout, std::size_t number);

/// `held`: the columns that the set has.
std::uint32_t flags_of(const SplatSetFacts& facts, const SplatColumns& held, RowOrder order, NativePart part);

/// The text behind the header: the credit, and behind a zero the recipe.
std::string text_of(const SplatSetFacts& facts);

/// Header, texts, padding and their checksum, of a file of so many splats.
std::string header_bytes(const SplatSetFacts& facts, std::uint32_t flags, std::int64_t splats);

/// The table and its checksum.
std::string table_bytes(const std::vector<BlockEntry>& table);

/// Whether there is neither infinity nor NaN among values of any column.
template <class T>
bool all_finite(const T* values, std::size_t count) {
    bool finite = true;
    if constexpr (!std::is_integral_v<T>) {
        const float* const numbers = reinterpret_cast<const float*>(values);
        for (std::size_t i = 0; i < count * sizeof(T) / sizeof(float); ++i)
            finite &= std::fabs(numbers[i]) <= FLT_MAX;
    }
    return finite;
}

}  // namespace astrosplat::native
