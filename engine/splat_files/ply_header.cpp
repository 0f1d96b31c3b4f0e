// Line by line; a line is split at blanks. Carriage returns are blanks, so files from Windows read the same.
#include "splat_files/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "splat_files/number_scan.h"
#include "splat_files/text_rows.h"

namespace astrosplat {

namespace {

constexpr std::array<std::pair<std::string_view, NumberType>, 18> type_names = {
    {{"char", NumberType::i8},
     {"int8", NumberType::i8},
     {"uchar", NumberType::u8},
     {"uint8", NumberType::u8},
     {"short", NumberType::i16},
     {"int16", NumberType::i16},
     {"ushort", NumberType::u16},
     {"uint16", NumberType::u16},
     {"int", NumberType::i32},
     {"int32", NumberType::i32},
     {"uint", NumberType::u32},
     {"uint32", NumberType::u32},
     {"int64", NumberType::i64},
     {"uint64", NumberType::u64},
     {"float", NumberType::f32},
     {"float32", NumberType::f32},
     {"double", NumberType::f64},
     {"float64", NumberType::f64}}};

struct HeaderReader {
    std::string file;
    std::string_view rest;
    std::int64_t line = 0;

    [[noreturn]] void fail(const std::string& expected, std::string_view found) const {
        bad_input(file, std::to_string(line), expected, quoted(found));
    }
    /// The next line without its end.
    std::string_view next() {
        ++line;
        const std::size_t newline = rest.find('\n');
        if (newline == rest.npos)
            bad_input(file, std::to_string(line), "'end_header'", "the end of the file");
        const std::string_view text = rest.substr(0, newline);
        rest.remove_prefix(newline + 1);
        return text;
    }
};

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    const char* const end = line.data() + line.size();
    for (const char* p = scan::skip_blanks(line.data(), end); p < end;) {
        const char* const stop = scan::token_end(p, end);
        words.emplace_back(p, static_cast<std::size_t>(stop - p));
        p = scan::skip_blanks(stop, end);
    }
    return words;
}

NumberType number_type(const HeaderReader& reader, std::string_view name) {
    const auto* const found =
        std::ranges::find_if(type_names, [&](const auto& entry) { return entry.first == name; });
    if (found == type_names.end()) reader.fail("a number type such as float or uchar", name);
    return found->second;
}

PlyFormat read_format(const HeaderReader& reader, std::string_view line) {
    const auto words = words_of(line);
    if (words.size() == 3 && words[0] == "format" && words[2] == "1.0") {
        if (words[1] == "ascii") return PlyFormat::ascii;
        if (words[1] == "binary_little_endian") return PlyFormat::little_endian;
        if (words[1] == "binary_big_endian") return PlyFormat::big_endian;
    }
    reader.fail("'format ascii 1.0', binary_little_endian or binary_big_endian", line);
}

PlyElement read_element(const HeaderReader& reader, const std::vector<std::string_view>& words,
                        std::string_view line) {
    PlyElement element;
    if (words.size() != 3) reader.fail("'element NAME COUNT'", line);
    element.name = words[1];
    const char* const end = words[2].data() + words[2].size();
    const auto [after, error] = std::from_chars(words[2].data(), end, element.count);
    if (error != std::errc() || after != end) reader.fail("a number of elements", words[2]);
    return element;
}

Column read_property(const HeaderReader& reader, const std::vector<std::string_view>& words,
                     std::string_view line) {
    Column column;
    column.list = words.size() == 5 && words[1] == "list";
    if (!column.list && words.size() != 3) reader.fail("'property TYPE NAME'", line);
    column.name = words.back();
    column.type = number_type(reader, words[words.size() - 2]);
    if (column.list) column.list_count = number_type(reader, words[2]);
    if (column.list_count == NumberType::f32 || column.list_count == NumberType::f64)
        reader.fail("a whole number as the list's count", words[2]);
    return column;
}

bool has_property(const PlyElement& element, std::string_view name) {
    return std::ranges::any_of(element.properties, [&](const Column& column) { return column.name == name; });
}

/// Takes one line behind "format"; false at end_header.
bool read_line(HeaderReader& reader, PlyHeader& header) {
    const std::string_view line = reader.next();
    const auto words = words_of(line);
    if (words.empty()) return true;
    if (words[0] == "end_header") return false;
    constexpr std::string_view credit = "comment credit: ";
    if (line.substr(0, credit.size()) == credit) header.credit = trim(line.substr(credit.size()));
    if (words[0] == "comment" || words[0] == "obj_info") return true;
    if (words[0] == "element") {
        header.elements.push_back(read_element(reader, words, line));
    } else if (words[0] == "property" && !header.elements.empty()) {
        PlyElement& element = header.elements.back();
        Column column = read_property(reader, words, line);
        if (has_property(element, column.name)) reader.fail("each property once", column.name);
        element.properties.push_back(std::move(column));
    } else {
        reader.fail("element, property, comment or end_header", line);
    }
    return true;
}

}  // namespace

PlyHeader read_ply_header(const std::filesystem::path& file, std::string_view bytes) {
    HeaderReader reader{file.string(), bytes, 0};
    PlyHeader header;
    if (bytes.substr(0, 3) != "ply") bad_input(reader.file, "1", "'ply'", quoted(bytes.substr(0, 3)));
    const std::string_view magic = reader.next();
    if (trim(magic) != "ply") reader.fail("'ply'", magic);
    header.format = read_format(reader, reader.next());
    while (read_line(reader, header)) {
    }
    header.data = reader.rest;
    header.data_line = reader.line + 1;
    return header;
}

std::size_t size_of(NumberType type) {
    switch (type) {
        case NumberType::i8:
        case NumberType::u8:
            return 1;
        case NumberType::i16:
        case NumberType::u16:
            return 2;
        case NumberType::i32:
        case NumberType::u32:
        case NumberType::f32:
            return 4;
        default:
            return 8;
    }
}

}  // namespace astrosplat
