// The header line by line; a line is split at blanks, and carriage returns are blanks, so files from Windows
// read the same. Binary rows of equal length are read column by column, a few hundred at a time; rows with
// lists, and those among which a number is wrong, number by number.
#include "splat_files/ply_bytes.h"

#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <tuple>
#include <type_traits>

#include "core/error.h"
#include "core/parallel.h"
#include "core/text.h"
#include "splat_files/file_bytes.h"
#include "splat_files/number_text.h"

namespace astrosplat {
namespace {

/// By NumberType.
constexpr std::string_view type_names[][2] = {
    {"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"}, {"ushort", "uint16"},
    {"int", "int32"},     {"uint", "uint32"},   {"int64", "int64"}, {"uint64", "uint64"},
    {"float", "float32"}, {"double", "float64"}};

constexpr std::string_view credit_begins = "comment credit: ", origin_begins = "comment origin: ";

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
        words.emplace_back(p, std::size_t(stop - p));
        p = scan::skip_blanks(stop, end);
    }
    return words;
}

NumberType number_type(const HeaderReader& reader, std::string_view name) {
    const auto* const found = std::ranges::find_if(
        type_names, [&](const auto& names) { return names[0] == name || names[1] == name; });
    if (found == std::end(type_names)) reader.fail("a number type such as float or uchar", name);
    return static_cast<NumberType>(found - type_names);
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

/// The next line that is not empty or a comment; of those it takes what the header keeps.
std::string_view next_line(HeaderReader& reader, PlyHeader& header) {
    while (true) {
        const std::string_view line = reader.next();
        const auto words = words_of(line);
        if (line.starts_with(credit_begins)) header.credit = trim(line.substr(credit_begins.size()));
        if (line.starts_with(origin_begins)) header.origin = trim(line.substr(origin_begins.size()));
        if (!words.empty() && words[0] != "comment" && words[0] != "obj_info") return line;
    }
}

/// Takes one line behind "format"; false at end_header.
bool read_line(HeaderReader& reader, PlyHeader& header) {
    const std::string_view line = next_line(reader, header);
    const auto words = words_of(line);
    if (words[0] == "end_header") return false;
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

std::string ply_comments(const std::string& credit, const std::string& origin) {
    std::string text;
    for (auto [begin, words] : {std::pair(credit_begins, credit), std::pair(origin_begins, origin)}) {
        std::ranges::replace_if(
            words, [](char c) { return c == '\n' || c == '\r'; }, ' ');
        if (!words.empty()) text += fmt::format("{}{}\n", begin, words);
    }
    return text;
}

PlyHeader read_ply_header(const fs::path& file, std::string_view bytes) {
    HeaderReader reader{file.string(), bytes, 0};
    PlyHeader header;
    if (bytes.substr(0, 3) != "ply") bad_input(reader.file, "1", "'ply'", quoted(bytes.substr(0, 3)));
    const std::string_view magic = reader.next();
    if (trim(magic) != "ply") reader.fail("'ply'", magic);
    header.format = read_format(reader, next_line(reader, header));
    while (read_line(reader, header)) {
    }
    header.data = reader.rest;
    header.data_line = reader.line + 1;
    return header;
}

namespace {

constexpr std::int64_t rows_read_at_once = 1 << 14;

template <class T>
T load(const char* p, bool swap) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, p, sizeof(T));
    if (swap) std::reverse(bytes, bytes + sizeof(T));
    return std::bit_cast<T>(bytes);
}

using NumberTypes = std::tuple<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::int32_t,
                               std::uint32_t, std::int64_t, std::uint64_t, float, double>;

/// Calls use(value) with the number at p in its own type.
template <std::size_t first = 0, class Use>
auto with_number(NumberType type, const char* p, bool swap, Use&& use) {
    if constexpr (first + 1 < std::tuple_size_v<NumberTypes>)
        if (type != static_cast<NumberType>(first)) return with_number<first + 1>(type, p, swap, use);
    return use(load<std::tuple_element_t<first, NumberTypes>>(p, swap));
}

/// Bytes of one number.
std::size_t size_of(NumberType type) {
    constexpr char any[sizeof(double)] = {};
    return with_number(type, any, false, [](auto value) { return sizeof value; });
}

template <class T>
bool store_value(const Column& column, std::size_t row, T value) {
    if (!is_whole(column)) return store(column, row, float(value));
    if (!(value >= 0)) return false;
    if constexpr (std::is_floating_point_v<T>) {
        constexpr double exact = 9007199254740992.0;  // 2^53
        if (!(value <= exact) || value != std::floor(value)) return false;
    }
    return store_whole(column, row, std::uint64_t(value));
}

bool store_number(const Column& column, std::size_t row, const char* p, bool swap) {
    return with_number(column.type, p, swap, [&](auto value) { return store_value(column, row, value); });
}

/// Some rows of equal length.
struct Rows {
    std::size_t first, count;
    const char* p;  // the column's number in the first row
    std::size_t bytes;
};

/// Floats as they are in memory: most of most files. False when one lies outside of the field's limits.
bool store_floats(const Column& column, const Rows& rows) {
    float* const out = column.out + rows.first * column.stride;
    const std::size_t stride = column.stride;
    const float lowest = column.lowest, highest = column.highest;
    bool inside = true;
    for (std::size_t i = 0; i < rows.count; ++i) {
        const auto value = load<float>(rows.p + i * rows.bytes, false);
        inside &= value >= lowest && value <= highest;
        out[i * stride] = value;
    }
    return inside;
}

/// False when the field cannot take one of the values.
bool store_column(const Column& column, const Rows& rows, bool swap) {
    const bool plain = column.type == NumberType::f32 && !swap && column.codes.empty();
    if (plain && !is_whole(column) && store_floats(column, rows)) return true;
    return with_number(column.type, rows.p, swap, [&]<class T>(T) {
        bool stored = true;
        for (std::size_t i = 0; i < rows.count; ++i)
            stored &= store_value(column, rows.first + i, load<T>(rows.p + i * rows.bytes, swap));
        return stored;
    });
}

/// Bytes of a row, 0 when lists make rows differ.
std::size_t fixed_row_bytes(const std::vector<Column>& columns) {
    std::size_t bytes = 0;
    for (const Column& column : columns) {
        if (column.list) return 0;
        bytes += size_of(column.type);
    }
    return bytes;
}

struct BinaryReader {
    std::string file;
    std::string_view data;
    bool swap;

    [[noreturn]] void truncated(const std::string& element, std::uint64_t count) const {
        bad_input(file, fmt::format("{} {} elements, as the header says", count, element),
                  "the end of the file");
    }

    /// Bytes of the property at `at`; data.size() + 1 when it does not fit into the data or its
    /// count is negative.
    std::size_t property_bytes(const Column& column, std::size_t at) const {
        const std::size_t too_many = data.size() + 1, size = size_of(column.type);
        const std::size_t left = data.size() - at;
        if (!column.list) return size <= left ? size : too_many;
        const std::size_t head = size_of(column.list_count);
        if (head > left) return too_many;
        const auto count = with_number(column.list_count, data.data() + at, swap, [](auto value) {
            return value >= 0 ? std::uint64_t(value) : ~std::uint64_t{0};
        });
        return count <= (left - head) / size ? head + std::size_t(count) * size : too_many;
    }

    /// Where the row behind the one at `at` begins, for rows with lists.
    std::size_t after_row(const PlyElement& element, std::size_t at) const {
        for (const Column& column : element.properties) {
            const std::size_t bytes = property_bytes(column, at);
            if (bytes > data.size() - at) truncated(element.name, element.count);
            at += bytes;
        }
        return at;
    }

    /// Starts of every rows_read_at_once-th row from `at` on, and the end behind the last row.
    std::vector<std::size_t> chunk_starts(const PlyElement& element, std::size_t at) const {
        std::vector<std::size_t> starts;
        const std::size_t row_bytes = fixed_row_bytes(element.properties);
        if (element.properties.empty()) return {at};
        if (row_bytes != 0) {
            if (element.count > (data.size() - at) / row_bytes) truncated(element.name, element.count);
            for (std::uint64_t row = 0; row < element.count; row += rows_read_at_once)
                starts.push_back(at + row * row_bytes);
            at += element.count * row_bytes;
        } else {
            for (std::uint64_t row = 0; row < element.count; ++row) {
                if (row % rows_read_at_once == 0) starts.push_back(at);
                at = after_row(element, at);
            }
        }
        starts.push_back(at);
        return starts;
    }

    /// Reads rows [begin, end) whose first byte is at `at`; all of them are known to lie within the data.
    void read_rows(const SplatTable& table, std::int64_t begin, std::int64_t end, std::size_t at) const {
        constexpr std::int64_t in_cache = 256;  // rows
        const std::size_t row_bytes = fixed_row_bytes(table.columns);
        if (row_bytes == 0) return read_one_by_one(table, begin, end, at);
        for (; begin < end; begin += in_cache, at += in_cache * row_bytes) {
            const std::int64_t stop = std::min(end, begin + in_cache);
            if (!read_by_column(table, begin, stop, at, row_bytes)) read_one_by_one(table, begin, stop, at);
        }
    }

    bool read_by_column(const SplatTable& table, std::int64_t begin, std::int64_t end, std::size_t at,
                        std::size_t row_bytes) const {
        Rows rows{std::size_t(begin), std::size_t(end - begin), data.data() + at, row_bytes};
        bool stored = true;
        for (const Column& column : table.columns) {
            if (column.field) stored &= store_column(column, rows, swap);
            rows.p += size_of(column.type);
        }
        return stored;
    }

    /// Any rows, also those with lists. Throws InputError with the first wrong number.
    void read_one_by_one(const SplatTable& table, std::int64_t begin, std::int64_t end,
                         std::size_t at) const {
        for (std::int64_t row = begin; row < end; ++row) {
            for (const Column& column : table.columns) {
                if (column.field && !store_number(column, std::size_t(row), data.data() + at, swap))
                    bad_input(file, fmt::format("vertex {}", row), expectation(column), describe(column, at));
                at += column.list ? property_bytes(column, at) : size_of(column.type);
            }
        }
    }

    std::string describe(const Column& column, std::size_t at) const {
        return with_number(column.type, data.data() + at, swap,
                           [](auto value) { return fmt::format("{}", value); });
    }
};

}  // namespace

void read_binary_rows(const PlyHeader& header, std::size_t vertex, SplatTable& table, const fs::path& file,
                      const Progress& progress) {
    const BinaryReader reader{file.string(), header.data, header.format == PlyFormat::big_endian};
    std::size_t at = 0;
    for (std::size_t i = 0; i < vertex; ++i) at = reader.chunk_starts(header.elements[i], at).back();
    const std::vector<std::size_t> starts = reader.chunk_starts(header.elements[vertex], at);
    const auto count = std::int64_t(header.elements[vertex].count);
    open_table(table, count, file);
    parallel_parts(starts.size() - 1, progress, [&](std::size_t chunk) {
        const std::int64_t first = std::int64_t(chunk) * rows_read_at_once;
        reader.read_rows(table, first, std::min(first + rows_read_at_once, count), starts[chunk]);
        forget_pages(header.data.substr(starts[chunk], starts[chunk + 1] - starts[chunk]));
    });
}

}  // namespace astrosplat
