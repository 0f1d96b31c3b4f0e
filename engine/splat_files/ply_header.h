// The header of a PLY file as data: format, elements, properties. In: the file's bytes. Out: PlyHeader, or
// one line that says what is wrong.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

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
    std::string credit;          // of "comment credit: ..."
    std::string_view data;       // behind end_header
    std::int64_t data_line = 0;  // the file's line where data begins
};

/// Throws InputError.
PlyHeader read_ply_header(const std::filesystem::path& file, std::string_view bytes);

/// Bytes of one number of a binary file.
std::size_t size_of(NumberType type);

}  // namespace astrosplat
