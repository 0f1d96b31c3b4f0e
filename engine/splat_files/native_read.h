// Some of the rows of native files, for a cache that keeps more than is to be seen. In: files as native.h has
// them. Out: SplatSets of those rows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "core/buffer.h"
#include "core/progress.h"
#include "splat_files/native.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// Some rows of a file, ascending, and what of them is wanted.
struct NativeRows {
    std::span<const std::int64_t> rows;
    OptionalColumns wanted;
};

/// Several choices of rows of one file, which is read and checked once, as by read_native().
std::vector<SplatSet> read_native_rows(const std::filesystem::path& file, NativePart part,
                                       std::span<const NativeRows> choices, const Progress& progress = {});

/// The rows of a file of colours whose alpha is not 0, and how many rows it has. Its blocks are not checked.
/// Throws InputError.
struct LitRows {
    Buffer<std::int64_t> rows;
    std::int64_t of = 0;
};
LitRows native_lit_rows(const std::filesystem::path& file, const Progress& progress = {});

}  // namespace astrosplat
