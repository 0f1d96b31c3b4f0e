// Rows of numbers in text, one row a line, read in parallel: PDA's data and ASCII PLY. The text is cut at
// line ends into chunks whose rows are counted first, so that a wrong count is answered before any memory is
// taken.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "splat_files/splat_table.h"

namespace astrosplat {

/// A run of whole lines.
struct TextChunk {
    std::string_view text;
    std::int64_t first_row = 0;   // blank lines are no rows
    std::int64_t first_line = 0;  // of the file, from 1
};

struct TextRows {
    std::vector<TextChunk> chunks;
    std::int64_t rows = 0;
};

/// Cuts and counts; `first_line` is the file's line where `text` begins. Blank lines count as lines, not as
/// rows.
TextRows split_rows(std::string_view text, std::int64_t first_line);

/// Reads rows [begin, end) of `rows` into the table's columns as its rows 0 .. end-begin. The lowest bad row
/// decides the InputError, whatever the threads do.
void read_text_rows(const TextRows& rows, std::int64_t begin, std::int64_t end, const SplatTable& table,
                    const std::filesystem::path& file, const Progress& progress);

/// Text of a file for a message: one line, quoted, shortened to 32 characters, others than printable ASCII as
/// \xNN.
std::string quoted(std::string_view text);

}  // namespace astrosplat
