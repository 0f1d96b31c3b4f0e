// What native files hold beside their blocks, as bytes (native.h): for their writers. In: what is known of a
// set, and which columns are there. Out: flags, header and table.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "splat_files/native_layout.h"

namespace astrosplat::native {

/// `holds` says which columns the set has.
std::uint32_t flags_of(const SplatSetFacts& facts, const std::function<bool(SplatColumn)>& holds,
                       RowOrder order, NativePart part);

/// What stands behind the header: the credit, and behind a zero the recipe.
std::string text_of(const SplatSetFacts& facts);

/// Header, texts, padding and their checksum, of a file of so many splats.
std::string header_bytes(const SplatSetFacts& facts, std::uint32_t flags, std::int64_t splats);

/// The table and its checksum.
std::string table_bytes(const std::vector<BlockEntry>& table);

}  // namespace astrosplat::native
