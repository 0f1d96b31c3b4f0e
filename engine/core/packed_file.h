// Files that gzip or bzip2 packed, known by how they begin, whatever their names. In: a path. Out: the bytes
// that were packed.
#pragma once

#include "core/progress.h"

namespace astrosplat {

bool is_packed(std::string_view bytes);

/// Where unpacking ends.
struct UnpackBounds {
    std::size_t most_times = 200;            // as many bytes as there are, refused beyond 64 MiB
    std::size_t enough = std::string::npos;  // bytes: what follows them may be missing
};
inline constexpr UnpackBounds table_bounds{.most_times = 30};  // text of numbers: 3 to 15

/// Several packed one after the other are one; bytes that are not packed are returned as they are. `name`
/// begins messages. Throws InputError for damaged data, for what is larger than the memory left or beyond the
/// bounds; Cancelled.
std::string unpacked(std::string bytes, const std::string& name, const Progress& progress = {},
                     const UnpackBounds& bounds = {});

/// The same of a file. Throws InputError as read_file() does, too.
std::string read_unpacked(const fs::path& file, const Progress& progress = {},
                          const UnpackBounds& bounds = {});

}  // namespace astrosplat
