// See ply.h. Which property is which field, and writing; rows are read by text_rows, which PDA shares, and by
// ply_binary.
#include "splat_files/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/color.h"
#include "core/error.h"
#include "splat_files/finish_gaussians.h"
#include "splat_files/mapped_file.h"
#include "splat_files/ordered_writer.h"
#include "splat_files/ply_binary.h"
#include "splat_files/ply_gaussians.h"
#include "splat_files/ply_header.h"
#include "splat_files/splat_table.h"
#include "splat_files/text_rows.h"

namespace astrosplat {

namespace {

constexpr std::int64_t rows_written_at_once = 1 << 15;

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
    {"r", Field::red},         {"diffuse_red", Field::red},
    {"g", Field::green},       {"diffuse_green", Field::green},
    {"b", Field::blue},        {"diffuse_blue", Field::blue},
    {"a", Field::alpha},       {"diffuse_alpha", Field::alpha},
};

/// Properties that mean something only together. Of the colours the first that are complete are read.
constexpr std::string_view groups[][3] = {{"red", "green", "blue"},
                                          {"diffuse_red", "diffuse_green", "diffuse_blue"},
                                          {"r", "g", "b"},
                                          {"s", "t", ""},
                                          {"id", "", ""}};
constexpr std::span color_groups(groups, 3);
/// The opacity that goes with each of them.
constexpr std::string_view opacities[] = {"alpha", "diffuse_alpha", "a"};

bool has_scalar(const PlyElement& element, std::string_view name) {
    return std::ranges::any_of(element.properties,
                               [&](const Column& c) { return c.name == name && !c.list; });
}

bool has_all(const PlyElement& vertex, std::span<const std::string_view> names) {
    return std::ranges::all_of(
        names, [&](std::string_view name) { return name.empty() || has_scalar(vertex, name); });
}

/// False for a property that lacks its companions (red without green, id_high without id), and for a second
/// colour or opacity.
bool is_read(const PlyElement& vertex, std::string_view name) {
    if (name == "id_high") return has_scalar(vertex, "id");
    const auto opacity = std::ranges::find(opacities, name);
    if (opacity != std::end(opacities))
        return std::none_of(std::begin(opacities), opacity,
                            [&](std::string_view other) { return has_scalar(vertex, other); });
    const auto holds = [&](const auto& group) { return std::ranges::find(group, name) != std::end(group); };
    const auto group = std::ranges::find_if(groups, holds);
    if (group == std::end(groups)) return true;
    const auto first_color =
        std::ranges::find_if(color_groups, [&](const auto& colors) { return has_all(vertex, colors); });
    const bool is_color = group - std::begin(groups) < static_cast<std::ptrdiff_t>(color_groups.size());
    return is_color ? first_color != color_groups.end() && holds(*first_color) : has_all(vertex, *group);
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
    const auto* const known =
        std::ranges::find_if(known_properties, [&](const KnownProperty& k) { return k.name == column.name; });
    if (known == std::end(known_properties) || column.list || !is_read(vertex, column.name)) return;
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
    if (holds_gaussians(vertex)) return gaussian_columns(vertex, file);
    if (has_scalar(vertex, "packed_position"))
        bad_input(file.string(), "", "Gaussians that are not compressed", "packed_position and others");
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
char* put_bytes(char* out, const T& value) {
    std::memcpy(out, &value, sizeof value);
    return out + sizeof value;
}

char* put_row(char* out, const SplatSet& set, bool wide_ids, std::size_t i) {
    out = put_bytes(out, set.position[i]);
    out = put_bytes(out, set.color[i]);
    out = put_bytes(out, set.alpha[i]);
    out = put_bytes(out, set.distance[i]);
    if (!set.radius.empty()) out = put_bytes(out, set.radius[i]);
    if (!set.uv.empty()) out = put_bytes(out, set.uv[i]);
    if (!set.mesh.empty()) out = put_bytes(out, set.mesh[i]);
    out = put_bytes(out, static_cast<std::uint32_t>(set.id[i]));
    if (wide_ids) out = put_bytes(out, static_cast<std::uint32_t>(set.id[i] >> 32));
    return out;
}

std::string header_text(const SplatSet& set, bool wide_ids) {
    std::string text = "ply\nformat binary_little_endian 1.0\n";
    std::string credit = set.credit;
    std::ranges::replace_if(
        credit, [](char c) { return c == '\n' || c == '\r'; }, ' ');
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

SplatSet read_ply_bytes(const std::filesystem::path& file, std::string_view bytes, const Progress& progress) {
    const PlyHeader header = read_ply_header(file, bytes);
    const std::size_t vertex = find_vertex(header, file);
    SplatTable table;
    table.columns = columns_of(header.elements[vertex], file);
    if (header.format == PlyFormat::ascii)
        read_ascii(header, vertex, table, file, progress);
    else
        read_binary_rows(header, vertex, table, file, progress);
    const bool gaussians = table.has(Field::scale_x);
    SplatSet set = finish_table(table, file);
    set.credit = header.credit;
    return gaussians ? finish_gaussians(std::move(set), {.trained = true, .display = true}, file)
                     : std::move(set);
}

}  // namespace

std::vector<std::string> ply_attributes(const std::filesystem::path& file) {
    return read_mapped(file, [&](std::string_view bytes) {
        const PlyHeader header = read_ply_header(file, bytes);
        const PlyElement& vertex = header.elements[find_vertex(header, file)];
        std::vector<std::string> names = attribute_names(columns_of(vertex, file));
        if (holds_gaussians(vertex)) {
            if (std::ranges::find(names, "color") == names.end()) names.emplace_back("color");
            names.emplace_back("radius");
        }
        return names;
    });
}

std::int64_t ply_splat_count(const std::filesystem::path& file) {
    return read_mapped(file, [&](std::string_view bytes) {
        constexpr std::uint64_t most = std::numeric_limits<std::int64_t>::max();
        const PlyHeader header = read_ply_header(file, bytes);
        return static_cast<std::int64_t>(std::min(most, header.elements[find_vertex(header, file)].count));
    });
}

SplatSet read_ply(const std::filesystem::path& file, const Progress& progress) {
    return read_mapped(file, [&](std::string_view bytes) { return read_ply_bytes(file, bytes, progress); });
}

void write_ply(const WriteTarget& target, const SplatSet& set, const Progress& progress) {
    static_assert(std::endian::native == std::endian::little);
    check_consistent(set);
    const bool wide_ids = std::ranges::any_of(set.id, [](std::uint64_t id) { return id >> 32 != 0; });
    constexpr std::size_t longest_row = 17 * sizeof(float);
    write_ordered(target, header_text(set, wide_ids), set.size(), rows_written_at_once, longest_row, progress,
                  [&](std::int64_t begin, std::int64_t end, char* out) {
                      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
                          out = put_row(out, set, wide_ids, i);
                      return out;
                  });
}

}  // namespace astrosplat
