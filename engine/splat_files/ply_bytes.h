// The bytes of a PLY file: its header as data (format, elements, properties), and binary rows into a table
// whose columns know their fields.
#pragma once

#include "core/progress.h"
#include "splat_files/splat_table.h"

namespace astrosplat {

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Column> properties;  // name, type, list, list_count are set
};

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;
    std::string credit, origin;  // of "comment credit: ..." and "comment origin: ..."
    std::string_view data;       // behind end_header
    std::int64_t data_line = 0;  // the file's line where data begins
};

/// The lines of a header that tell them, each on one line; none of what is empty.
std::string ply_comments(const std::string& credit, const std::string& origin);

/// Throws InputError with the line.
PlyHeader read_ply_header(const fs::path& file, std::string_view bytes);

/// Opens the table and stores the rows of element number `vertex`, in parallel. Throws InputError with the
/// first wrong vertex.
void read_binary_rows(const PlyHeader& header, std::size_t vertex, SplatTable& table, const fs::path& file,
                      const Progress& progress);

/// SuperSplat's compressed Gaussians, whose vertices are four packed numbers, between the bounds of an
/// element chunk, and an element sh. Throw InputError.
bool is_compressed_ply(const PlyElement& vertex);
SplatColumns compressed_ply_columns(const PlyHeader& header, const fs::path& file);
SplatSet read_compressed_ply(const PlyHeader& header, const fs::path& file, const Progress& progress);

}  // namespace astrosplat
