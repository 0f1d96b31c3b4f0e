// Files within a ZIP archive, stored or deflated; archives and files of less than 4 GB.
#pragma once

#include "core/buffer.h"
#include "core/standard.h"

namespace astrosplat {

/// The bytes of the file `name` in the archive `bytes`, unpacked; `file` names it in messages. Throws
/// InputError where there is none, or its sizes are not those that the archive says.
Buffer<char> zipped_file(const fs::path& file, std::string_view bytes, std::string_view name);

}  // namespace astrosplat
