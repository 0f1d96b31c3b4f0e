// Files that gzip or bzip2 packed, known by how they begin, whatever their names. In: a path. Out: the bytes
// that were packed.
#pragma once

#include "core/progress.h"

namespace astrosplat {

bool is_packed(std::string_view bytes);

/// Several packed one after the other are one; bytes that are not packed are returned as they are. `name`
/// begins messages. Throws InputError for damaged data, for what is larger than the memory left, and beyond
/// 256 MiB for 200 times as many bytes as there are; Cancelled.
std::string unpacked(std::string bytes, const std::string& name, const Progress& progress = {});

/// The same of a file. Throws InputError as read_file() does, too.
std::string read_unpacked(const fs::path& file, const Progress& progress = {});

}  // namespace astrosplat
