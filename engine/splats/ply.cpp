// See ply.h. Every number of a row goes through one loop over the properties, whatever the format; ASCII
// shares its loop with PDA (text_rows).
#include "splats/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/color.h"
#include "core/error.h"
#include "core/parallel.h"
#include "splats/mapped_file.h"
#include "splats/ordered_writer.h"
#include "splats/ply_header.h"
#include "splats/splat_table.h"
#include "splats/text_rows.h"

namespace astrosplat {

namespace {

constexpr std::int64_t rows_per_chunk = 1 << 15;

// ---- which property is which field

struct KnownProperty {
    std::string_view name;
    Field field;
};
constexpr KnownProperty known_properties[] = {
    {"x", Field::x},           {"y", Field::y},
    {"z", Field::z},           {"red", Field::red},
    {"green", Field::green},   {"blue", Field::blue},
    {"alpha", Field::alpha},   {"distance", Field::distance},
    {"radius", Field::radius}, {"s", Field::s},
    {"t", Field::t},           {"mesh", Field::mesh},
    {"id", Field::id},         {"id_high", Field::id_high},
};

/// Fields that mean something only together.
constexpr std::string_view groups[][3] = {{"red", "green", "blue"}, {"s", "t", ""}, {"id", "", ""}};

bool has_scalar(const PlyElement& element, std::string_view name) {
    return std::any_of(element.properties.begin(), element.properties.end(),
                       [&](const Column& c) { return c.name == name && !c.list; });
}

/// False for a property that lacks its companions: red without green, id_high without id.
bool is_complete(const PlyElement& vertex, std::string_view name) {
    for (const auto& group : groups) {
        const bool member = std::find(std::begin(group), std::end(group), name) != std::end(group) ||
                            (name == "id_high" && group[0] == "id");
        if (!member) continue;
        for (const std::string_view other : group)
            if (!other.empty() && !has_scalar(vertex, other)) return false;
    }
    return true;
}

/// Values of integer codes: sRGB light, or fractions of the largest code.
std::vector<float> code_table(std::size_t codes, bool srgb) {
    std::vector<float> values(codes);
    for (std::size_t code = 0; code < codes; ++code) {
        const double fraction = static_cast<double>(code) / static_cast<double>(codes - 1);
        values[code] = static_cast<float>(srgb ? real::srgb_to_linear(fraction) : fraction);
    }
    return values;
}

std::span<const float> codes_for(Field field, NumberType type) {
    const bool srgb = field != Field::alpha;
    if (type == NumberType::u8) {
        static const std::vector<float> light = code_table(256, true), fraction = code_table(256, false);
        return srgb ? light : fraction;
    }
    static const std::vector<float> light = code_table(65536, true), fraction = code_table(65536, false);
    return srgb ? light : fraction;
}

bool is_float(NumberType type) { return type == NumberType::f32 || type == NumberType::f64; }

void assign_field(Column& column, const PlyElement& vertex, const std::filesystem::path& file) {
    const auto* const known = std::find_if(std::begin(known_properties), std::end(known_properties),
                                           [&](const KnownProperty& k) { return k.name == column.name; });
    if (known == std::end(known_properties) || column.list || !is_complete(vertex, column.name)) return;
    column.field = known->field;
    const bool light = column.field == Field::red || column.field == Field::green ||
                       column.field == Field::blue || column.field == Field::alpha;
    if (!light || is_float(column.type)) return;
    if (column.type != NumberType::u8 && column.type != NumberType::u16)
        bad_input(file.string(), "", fmt::format("{} as float, double, uchar or ushort", column.name),
                  "another type");
    column.codes = codes_for(column.field, column.type);
}

std::vector<Column> columns_of(const PlyElement& vertex, const std::filesystem::path& file) {
    for (const std::string_view name : {"x", "y", "z"})
        if (!has_scalar(vertex, name))
            bad_input(file.string(), "", "vertex properties x, y and z", "no " + std::string(name));
    std::vector<Column> columns = vertex.properties;
    for (Column& column : columns) assign_field(column, vertex, file);
    return columns;
}

std::size_t find_vertex(const PlyHeader& header, const std::filesystem::path& file) {
    for (std::size_t i = 0; i < header.elements.size(); ++i)
        if (header.elements[i].name == "vertex") return i;
    bad_input(file.string(), "", "an element vertex", "none");
}

// ---- binary numbers

template <class T>
T load(const char* p, bool swap) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, p, sizeof(T));
    if (swap) std::reverse(bytes, bytes + sizeof(T));
    return std::bit_cast<T>(bytes);
}

/// Calls use(value) with the number at p in its own type.
template <class Use>
auto with_number(NumberType type, const char* p, bool swap, Use&& use) {
    switch (type) {
        case NumberType::i8:
            return use(load<std::int8_t>(p, swap));
        case NumberType::u8:
            return use(load<std::uint8_t>(p, swap));
        case NumberType::i16:
            return use(load<std::int16_t>(p, swap));
        case NumberType::u16:
            return use(load<std::uint16_t>(p, swap));
        case NumberType::i32:
            return use(load<std::int32_t>(p, swap));
        case NumberType::u32:
            return use(load<std::uint32_t>(p, swap));
        case NumberType::i64:
            return use(load<std::int64_t>(p, swap));
        case NumberType::u64:
            return use(load<std::uint64_t>(p, swap));
        case NumberType::f32:
            return use(load<float>(p, swap));
        default:
            return use(load<double>(p, swap));
    }
}

template <class T>
bool store_value(const Column& column, std::size_t row, T value) {
    if (!is_whole(column.field)) return store(column, row, static_cast<float>(value));
    if (!(value >= 0)) return false;
    if constexpr (std::is_floating_point_v<T>) {
        constexpr double exact = 9007199254740992.0;  // 2^53
        if (!(value <= exact) || value != std::floor(value)) return false;
    }
    return store_whole(column, row, static_cast<std::uint64_t>(value));
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
    if (plain && !is_whole(column.field) && store_floats(column, rows)) return true;
    return with_number(column.type, rows.p, swap, [&]<class T>(T) {
        bool stored = true;
        for (std::size_t i = 0; i < rows.count; ++i)
            stored &= store_value(column, rows.first + i, load<T>(rows.p + i * rows.bytes, swap));
        return stored;
    });
}

// ---- binary rows

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
        bad_input(file, "", fmt::format("{} {} elements, as the header says", count, element),
                  "the end of the file");
    }

    /// Bytes of the property at `at`; data.size() + 1 when it does not fit into the data or its count is
    /// negative.
    std::size_t property_bytes(const Column& column, std::size_t at) const {
        const std::size_t too_many = data.size() + 1, size = size_of(column.type);
        const std::size_t left = data.size() - at;
        if (!column.list) return size <= left ? size : too_many;
        const std::size_t head = size_of(column.list_count);
        if (head > left) return too_many;
        const auto count = with_number(column.list_count, data.data() + at, swap, [](auto value) {
            return value >= 0 ? static_cast<std::uint64_t>(value) : ~std::uint64_t{0};
        });
        return count <= (left - head) / size ? head + static_cast<std::size_t>(count) * size : too_many;
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

    /// Starts of every rows_per_chunk-th row from `at` on, and the end behind the last row.
    std::vector<std::size_t> chunk_starts(const PlyElement& element, std::size_t at) const {
        std::vector<std::size_t> starts;
        const std::size_t row_bytes = fixed_row_bytes(element.properties);
        if (element.properties.empty()) return {at};
        if (row_bytes != 0) {
            if (element.count > (data.size() - at) / row_bytes) truncated(element.name, element.count);
            for (std::uint64_t row = 0; row < element.count; row += rows_per_chunk)
                starts.push_back(at + row * row_bytes);
            at += element.count * row_bytes;
        } else {
            for (std::uint64_t row = 0; row < element.count; ++row) {
                if (row % rows_per_chunk == 0) starts.push_back(at);
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
        Rows rows{static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin), data.data() + at,
                  row_bytes};
        bool stored = true;
        for (const Column& column : table.columns) {
            if (column.field != Field::skip) stored &= store_column(column, rows, swap);
            rows.p += size_of(column.type);
        }
        return stored;
    }

    /// Any rows, and says what is wrong with the first wrong number.
    void read_one_by_one(const SplatTable& table, std::int64_t begin, std::int64_t end,
                         std::size_t at) const {
        for (std::int64_t row = begin; row < end; ++row) {
            for (const Column& column : table.columns) {
                if (column.field != Field::skip &&
                    !store_number(column, static_cast<std::size_t>(row), data.data() + at, swap))
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

void read_binary(const PlyHeader& header, std::size_t vertex, SplatTable& table,
                 const std::filesystem::path& file, const Progress& progress) {
    const BinaryReader reader{file.string(), header.data, header.format == PlyFormat::big_endian};
    std::size_t at = 0;
    for (std::size_t i = 0; i < vertex; ++i) at = reader.chunk_starts(header.elements[i], at).back();
    const std::vector<std::size_t> starts = reader.chunk_starts(header.elements[vertex], at);
    const auto count = static_cast<std::int64_t>(header.elements[vertex].count);
    open_table(table, count, file);
    std::vector<std::string> errors(starts.size() - 1);
    std::atomic<std::size_t> done{0};
    parallel_for(static_cast<std::int64_t>(errors.size()), [&](std::int64_t chunk, int) {
        progress.check();
        const auto i = static_cast<std::size_t>(chunk);
        const std::int64_t first = chunk * rows_per_chunk;
        try {
            reader.read_rows(table, first, std::min(first + rows_per_chunk, count), starts[i]);
        } catch (const InputError& error) {
            errors[i] = error.what();
        }
        progress.at(static_cast<double>(++done) / static_cast<double>(errors.size()));
    });
    for (const std::string& error : errors)
        if (!error.empty()) throw InputError(error);
}

void read_ascii(const PlyHeader& header, std::size_t vertex, SplatTable& table,
                const std::filesystem::path& file, const Progress& progress) {
    const TextRows rows = split_rows(header.data, header.data_line);
    std::uint64_t left = static_cast<std::uint64_t>(rows.rows);
    std::int64_t first = 0;
    for (std::size_t i = 0; i < header.elements.size(); ++i) {
        const PlyElement& element = header.elements[i];
        if (element.count > left)
            bad_input(file.string(), "", fmt::format("{} rows of element {}", element.count, element.name),
                      std::to_string(left));
        if (i < vertex) first += static_cast<std::int64_t>(element.count);
        left -= element.count;
    }
    if (left > 0)
        bad_input(file.string(), "", "as many rows as the header says", std::to_string(left) + " more");
    const auto count = static_cast<std::int64_t>(header.elements[vertex].count);
    open_table(table, count, file);
    read_text_rows(rows, first, first + count, table, file, progress);
}

// ---- writing

template <class T>
char* put(char* out, const T& value) {
    std::memcpy(out, &value, sizeof value);
    return out + sizeof value;
}

char* put_row(char* out, const SplatSet& set, bool wide_ids, std::size_t i) {
    out = put(out, set.position[i]);
    out = put(out, set.color[i]);
    out = put(out, set.alpha[i]);
    out = put(out, set.distance[i]);
    if (!set.radius.empty()) out = put(out, set.radius[i]);
    if (!set.uv.empty()) out = put(out, set.uv[i]);
    if (!set.mesh.empty()) out = put(out, set.mesh[i]);
    out = put(out, static_cast<std::uint32_t>(set.id[i]));
    if (wide_ids) out = put(out, static_cast<std::uint32_t>(set.id[i] >> 32));
    return out;
}

std::string header_text(const SplatSet& set, bool wide_ids) {
    std::string text = "ply\nformat binary_little_endian 1.0\n";
    std::string credit = set.credit;
    std::replace_if(
        credit.begin(), credit.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    if (!credit.empty()) text += "comment credit: " + credit + "\n";
    text += fmt::format("element vertex {}\n", set.size());
    for (const char* name : {"x", "y", "z", "red", "green", "blue", "alpha", "distance"})
        text += fmt::format("property float {}\n", name);
    if (!set.radius.empty()) text += "property float radius\n";
    if (!set.uv.empty()) text += "property float s\nproperty float t\n";
    if (!set.mesh.empty()) text += "property uint mesh\n";
    text += "property uint id\n";
    if (wide_ids) text += "property uint id_high\n";
    return text + "end_header\n";
}

}  // namespace

SplatSet read_ply(const std::filesystem::path& file, const Progress& progress) {
    const MappedFile mapped(file);
    const PlyHeader header = read_ply_header(file, mapped.bytes());
    const std::size_t vertex = find_vertex(header, file);
    SplatTable table;
    table.columns = columns_of(header.elements[vertex], file);
    if (header.format == PlyFormat::ascii)
        read_ascii(header, vertex, table, file, progress);
    else
        read_binary(header, vertex, table, file, progress);
    SplatSet set = finish_table(table, file);
    set.credit = header.credit;
    return set;
}

void write_ply(const std::filesystem::path& file, const SplatSet& set, const Progress& progress) {
    static_assert(std::endian::native == std::endian::little);
    check_consistent(set);
    const bool wide_ids =
        std::any_of(set.id.begin(), set.id.end(), [](std::uint64_t id) { return id >> 32 != 0; });
    constexpr std::size_t longest_row = 17 * sizeof(float);
    write_ordered(file, header_text(set, wide_ids), set.size(), rows_per_chunk, longest_row, progress,
                  [&](std::int64_t begin, std::int64_t end, char* out) {
                      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
                          out = put_row(out, set, wide_ids, i);
                      return out;
                  });
}

}  // namespace astrosplat
