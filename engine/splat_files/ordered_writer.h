// Writes a file whose rows are formatted in parallel and come out in order: threads format chunks of rows
// into memory of a few chunks, and one of them at a time appends what is complete. The bytes do not depend on
// threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "core/atomic_file.h"
#include "core/progress.h"

namespace astrosplat {

/// Writes rows [begin, end) to `out` and returns the end of what it wrote.
using FormatRows = std::function<char*(std::int64_t begin, std::int64_t end, char* out)>;
/// Text behind the rows; asked for once all of them are formatted.
using Footer = std::function<std::string()>;

/// `header`, then `count` rows in chunks of `chunk`, each row at most `row_bytes` long. Atomic: the file
/// appears whole or not at all. Throws OutputError, Cancelled.
void write_ordered(const WriteTarget& target, std::string_view header, std::int64_t count, std::int64_t chunk,
                   std::size_t row_bytes, const Progress& progress, const FormatRows& format,
                   const Footer& footer = {});

}  // namespace astrosplat
