#include "splat_files/native_bytes.h"

#include <cstring>

#include "splat_files/checksum.h"

namespace astrosplat::native {
namespace {

template <class T>
std::string& append_bytes(const T& value, std::string& bytes) {
    return bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

std::uint32_t flags_of(const SplatSetFacts& facts, const std::function<bool(SplatColumn)>& holds,
                       RowOrder order, NativePart part) {
    std::uint32_t flags = (facts.recipe.empty() ? 0u : has_recipe) | (facts.generated ? generated : 0u) |
                          (facts.divided ? divided : 0u) | (facts.absorbs ? absorbs : 0u) |
                          (facts.display_harmonics ? display_harmonics : 0u) |
                          (order == RowOrder::id ? by_id : 0u) | flag_of(part);
    for_each_column([&](auto, SplatColumn which) {
        if (has(flags | flag_of(which), which) && holds(which)) flags |= flag_of(which);
    });
    return flags;
}

std::string text_of(const SplatSetFacts& facts) {
    return facts.recipe.empty() ? facts.credit : facts.credit + '\0' + facts.recipe;
}

std::string header_bytes(const SplatSetFacts& facts, std::uint32_t flags, std::int64_t splats) {
    const std::string text = text_of(facts);
    Header header{};
    std::memcpy(header.magic, magic.data(), sizeof header.magic);
    header.version = version;
    header.flags = flags;
    header.splats = static_cast<std::uint64_t>(splats);
    header.block = splats_per_block;
    header.credit_bytes = static_cast<std::uint32_t>(text.size());
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
