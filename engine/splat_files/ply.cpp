// Which property of a PLY file is which field, of plain splats and of Gaussians; and writing. Rows are read
// by splat_table, which PDA shares, and by ply_bytes.
#include "splat_files/formats.h"

#include <fmt/format.h>

#include <cstring>

#include "core/color.h"
#include "core/error.h"
#include "core/log.h"
#include "core/text.h"
#include "splat_files/file_bytes.h"
#include "splat_files/gaussian_rows.h"
#include "splat_files/ply_bytes.h"
#include "splat_files/splat_table.h"
#include "splats/harmonics.h"

namespace astrosplat {
namespace {

constexpr std::int64_t rows_written_at_once = 1 << 15;

// ---- which property is which field

struct KnownProperty {
    std::string_view name;
    Field field;
};
constexpr KnownProperty known_properties[] = {
    {"x", {SplatColumn::position, 0}},  {"y", {SplatColumn::position, 1}},
    {"z", {SplatColumn::position, 2}},  {"red", {SplatColumn::color, 0}},
    {"green", {SplatColumn::color, 1}}, {"blue", {SplatColumn::color, 2}},
    {"alpha", {SplatColumn::alpha}},    {"distance", {SplatColumn::distance}},
    {"radius", {SplatColumn::radius}},  {"s", {SplatColumn::uv, 0}},
    {"t", {SplatColumn::uv, 1}},        {"mesh", {SplatColumn::mesh}},
    {"id", {SplatColumn::id, 0}},       {"id_high", {SplatColumn::id, 1}},
    {"r", {SplatColumn::color, 0}},     {"diffuse_red", {SplatColumn::color, 0}},
    {"g", {SplatColumn::color, 1}},     {"diffuse_green", {SplatColumn::color, 1}},
    {"b", {SplatColumn::color, 2}},     {"diffuse_blue", {SplatColumn::color, 2}},
    {"a", {SplatColumn::alpha}},        {"diffuse_alpha", {SplatColumn::alpha}},
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
    const bool is_color = group - std::begin(groups) < std::ptrdiff_t(color_groups.size());
    return is_color ? first_color != color_groups.end() && holds(*first_color) : has_all(vertex, *group);
}

/// Values of integer codes: sRGB light, or fractions of the largest code.
std::vector<float> code_table(std::size_t codes, bool srgb) {
    std::vector<float> values(codes);
    for (std::size_t code = 0; code < codes; ++code) {
        const double fraction = double(code) / double(codes - 1);
        values[code] = float(srgb ? real::srgb_to_linear(fraction) : fraction);
    }
    return values;
}

std::span<const float> codes_for(SplatColumn column, NumberType type) {
    const bool srgb = column != SplatColumn::alpha;
    if (type == NumberType::u8) {
        static const std::vector<float> light = code_table(256, true), fraction = code_table(256, false);
        return srgb ? light : fraction;
    }
    static const std::vector<float> light = code_table(65536, true), fraction = code_table(65536, false);
    return srgb ? light : fraction;
}

bool is_float(NumberType type) { return type == NumberType::f32 || type == NumberType::f64; }

void assign_field(Column& column, const PlyElement& vertex, const fs::path& file) {
    const auto* const known =
        std::ranges::find_if(known_properties, [&](const KnownProperty& k) { return k.name == column.name; });
    if (known == std::end(known_properties) || column.list || !is_read(vertex, column.name)) return;
    column.field = known->field;
    const SplatColumn to = known->field.column;
    if ((to != SplatColumn::color && to != SplatColumn::alpha) || is_float(column.type)) return;
    if (column.type != NumberType::u8 && column.type != NumberType::u16)
        bad_input(file, fmt::format("{} as float, double, uchar or ushort", column.name), "another type");
    column.codes = codes_for(to, column.type);
}

// ---- Gaussians

constexpr KnownProperty gaussian_properties[] = {
    {"x", {SplatColumn::position, 0}},     {"y", {SplatColumn::position, 1}},
    {"z", {SplatColumn::position, 2}},     {"opacity", {SplatColumn::alpha}},
    {"scale_0", {SplatColumn::scale, 0}},  {"scale_1", {SplatColumn::scale, 1}},
    {"scale_2", {SplatColumn::scale, 2}},  {"rot_0", {SplatColumn::rotation, 3}},
    {"rot_1", {SplatColumn::rotation, 0}}, {"rot_2", {SplatColumn::rotation, 1}},
    {"rot_3", {SplatColumn::rotation, 2}},
};
/// Mip-Splatting's smallest size of each, which finish_gaussians() takes as the radius.
constexpr KnownProperty filter_property = {"filter_3D", {SplatColumn::radius}};
constexpr std::string_view mean_names[] = {"f_dc_0", "f_dc_1", "f_dc_2"};
constexpr std::string_view rest_prefix = "f_rest_";

/// Their names are numbered from 0 on.
int rest_count(const PlyElement& vertex, const fs::path& file) {
    const auto found = std::ranges::count_if(
        vertex.properties, [](const Column& c) { return c.name.starts_with(rest_prefix) && !c.list; });
    if (found != 0 && found != 9 && found != 24 && found != 45)
        bad_input(file, "0, 9, 24 or 45 properties f_rest_*", std::to_string(found));
    for (int i = 0; i < found; ++i)
        if (!has_scalar(vertex, fmt::format("{}{}", rest_prefix, i)))
            bad_input(file, fmt::format("properties f_rest_0 to f_rest_{}", found - 1),
                      fmt::format("no {}{}", rest_prefix, i));
    return int(found) / 3;
}

/// `rest`: coefficients beyond degree 0 that the vertex has a channel.
void assign_gaussian(Column& column, const PlyElement& vertex, int rest, const fs::path& file) {
    if (column.list) return;
    if (!has_scalar(vertex, mean_names[0])) {  // colours, as floats or codes of them
        assign_field(column, vertex, file);
        if (!column.field || column.field->column != SplatColumn::color) column.field.reset();
        if (!column.codes.empty()) column.codes = codes_for(SplatColumn::alpha, column.type);
    }
    const auto set = [&](const Field& field) {
        column.field = field;
        column.any_number = true;
    };
    for (const auto& [name, field] : gaussian_properties)
        if (column.name == name) set(field);
    if (column.name == filter_property.name) set(filter_property.field);
    for (int k = 0; k < 3; ++k)
        if (column.name == mean_names[k]) set({rest == 0 ? SplatColumn::color : SplatColumn::harmonics, k});
    if (!column.name.starts_with(rest_prefix)) return;
    const auto number = int(parse_int64(column.name.substr(rest_prefix.size())).value_or(0));
    set({SplatColumn::harmonics, 3 * (1 + number % rest) + number / rest});
}

/// Whether the vertices are Gaussians as training stores them: colours of degree 0 and some of the rest, or
/// all of the rest, which mean nothing else.
bool holds_gaussians(const PlyElement& vertex) {
    const auto has = [&](std::string_view name) { return has_scalar(vertex, name); };
    if (has(mean_names[0])) return has("scale_0") || has("rot_0");
    return std::ranges::all_of(gaussian_properties, has, &KnownProperty::name);
}

/// The columns of such a vertex. Throws InputError where some of them are missing.
std::vector<Column> gaussian_columns(const PlyElement& vertex, const fs::path& file) {
    const auto require = [&](std::string_view name) {
        if (!has_scalar(vertex, name))
            bad_input(file, "Gaussians with x y z, f_dc_0 to 2, opacity, scale_0 to 2 and rot_0 to 3",
                      fmt::format("no {}", name));
    };
    for (const auto& [name, field] : gaussian_properties) require(name);
    const bool has_colors =
        std::ranges::any_of(color_groups, [&](const auto& colors) { return has_all(vertex, colors); });
    if (has_scalar(vertex, mean_names[0]) || !has_colors)
        for (const std::string_view name : mean_names) require(name);
    const int rest = rest_count(vertex, file);
    if (rest > 0) require(mean_names[0]);
    std::vector<Column> columns = vertex.properties;
    for (Column& column : columns) assign_gaussian(column, vertex, rest, file);
    return columns;
}

// ---- reading

std::vector<Column> columns_of(const PlyElement& vertex, const fs::path& file) {
    if (holds_gaussians(vertex)) return gaussian_columns(vertex, file);
    for (const std::string_view name : {"x", "y", "z"})
        if (!has_scalar(vertex, name))
            bad_input(file, "vertex properties x, y and z", "no " + std::string(name));
    std::vector<Column> columns = vertex.properties;
    for (Column& column : columns) assign_field(column, vertex, file);
    return columns;
}

std::size_t find_vertex(const PlyHeader& header, const fs::path& file) {
    for (std::size_t i = 0; i < header.elements.size(); ++i)
        if (header.elements[i].name == "vertex") return i;
    bad_input(file, "an element vertex", "none");
}

void read_ascii(const PlyHeader& header, std::size_t vertex, SplatTable& table, const fs::path& file,
                const Progress& progress) {
    const SplitRows rows = split_rows(header.data, header.data_line);
    std::uint64_t left = std::uint64_t(rows.rows);
    std::int64_t first = 0;
    for (std::size_t i = 0; i < header.elements.size(); ++i) {
        const PlyElement& element = header.elements[i];
        if (element.count > left)
            bad_input(file, fmt::format("{} rows of element {}", element.count, element.name),
                      std::to_string(left));
        if (i < vertex) first += std::int64_t(element.count);
        left -= element.count;
    }
    if (left > 0) bad_input(file, "as many rows as the header says", std::to_string(left) + " more");
    const auto count = std::int64_t(header.elements[vertex].count);
    open_table(table, count, file);
    read_text_rows(rows, first, first + count, table, file, progress);
}

// ---- writing

template <class T>
char* put_bytes(char* out, const T& value) {
    std::memcpy(out, &value, sizeof value);
    return out + sizeof value;
}

char* put_row(char* out, const SplatSet& set, bool wide_ids, std::int64_t i) {
    out = put_bytes(out, set.position[i]);
    out = put_bytes(out, set.color[i]);
    out = put_bytes(out, set.alpha[i]);
    out = put_bytes(out, set.distance[i]);
    if (!set.radius.empty()) out = put_bytes(out, set.radius[i]);
    if (!set.uv.empty()) out = put_bytes(out, set.uv[i]);
    if (!set.mesh.empty()) out = put_bytes(out, set.mesh[i]);
    out = put_bytes(out, std::uint32_t(set.id[i]));
    if (wide_ids) out = put_bytes(out, std::uint32_t(set.id[i] >> 32));
    return out;
}

std::string header_text(const SplatSet& set, bool wide_ids) {
    std::string text = "ply\nformat binary_little_endian 1.0\n";
    text += ply_comments(set.credit, set.origin);
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

/// Normals, which splats have no use for, pass.
void warn_of_unread(const PlyHeader& header, const std::vector<Column>& columns, const fs::path& file) {
    std::vector<std::string> names;
    for (const Column& column : columns)
        if (!column.field && column.name != "nx" && column.name != "ny" && column.name != "nz")
            names.push_back(column.name);
    for (const PlyElement& element : header.elements)
        if (element.name != "vertex" && element.count > 0) names.push_back("element " + element.name);
    constexpr std::size_t most_named = 8;
    const std::size_t more = names.size() - std::min(names.size(), most_named);
    names.resize(names.size() - more);
    if (!names.empty())
        log_warning(fmt::format("{}: its {}{} {} not followed", file.string(), fmt::join(names, ", "),
                                more > 0 ? fmt::format(" and {} more", more) : "",
                                names.size() > 1 ? "are" : "is"));
}

SplatSet read_vertices(const PlyHeader& header, std::size_t vertex, const fs::path& file,
                       const Progress& progress) {
    const PlyElement& element = header.elements[vertex];
    SplatTable table;
    table.columns = columns_of(element, file);
    warn_of_unread(header, table.columns, file);
    if (header.format == PlyFormat::ascii)
        read_ascii(header, vertex, table, file, progress);
    else
        read_binary_rows(header, vertex, table, file, progress);
    const bool gaussians = table.has(SplatColumn::scale), filtered = table.has(SplatColumn::radius);
    SplatSet set = finish_table(table, file);
    if (!gaussians) return set;
    if (!has_scalar(element, mean_names[0]))
        for (glm::vec3& color : set.color) color = mean_coefficient(color);
    return finish_gaussians(std::move(set), {.trained = true, .display = true, .filtered = filtered}, file);
}

SplatSet read_ply_bytes(const fs::path& file, std::string_view bytes, const Progress& progress) {
    const PlyHeader header = read_ply_header(file, bytes);
    const std::size_t vertex = find_vertex(header, file);
    SplatSet set = is_compressed_ply(header.elements[vertex]) ? read_compressed_ply(header, file, progress)
                                                              : read_vertices(header, vertex, file, progress);
    set.credit = header.credit;
    set.origin = header.origin;
    if (header.elements[vertex].count == 0) log_warning(file.string() + ": holds no splats");
    return set;
}

}  // namespace

SplatColumns ply_columns(const fs::path& file) {
    return read_mapped(file, [&](std::string_view bytes) {
        const PlyHeader header = read_ply_header(file, bytes);
        const PlyElement& vertex = header.elements[find_vertex(header, file)];
        if (is_compressed_ply(vertex)) return compressed_ply_columns(header, file);
        const SplatColumns columns = columns_held(columns_of(vertex, file));
        return holds_gaussians(vertex) ? columns | gaussian_set_columns(false) : columns;
    });
}

std::int64_t ply_splat_count(const fs::path& file) {
    return read_mapped(file, [&](std::string_view bytes) {
        constexpr std::uint64_t most = std::numeric_limits<std::int64_t>::max();
        const PlyHeader header = read_ply_header(file, bytes);
        return std::int64_t(std::min(most, header.elements[find_vertex(header, file)].count));
    });
}

SplatSet read_ply(const fs::path& file, const Progress& progress) {
    return read_mapped(file, [&](std::string_view bytes) { return read_ply_bytes(file, bytes, progress); });
}

void write_ply(const WriteTarget& target, const SplatSet& set, const Progress& progress) {
    static_assert(std::endian::native == std::endian::little);
    check_consistent(set);
    const bool wide_ids = std::ranges::any_of(set.id, [](std::uint64_t id) { return id >> 32 != 0; });
    constexpr std::size_t longest_row = 17 * sizeof(float);
    write_rows(target, header_text(set, wide_ids), set.size(), rows_written_at_once, longest_row, progress,
               [&](char* out, std::int64_t i) { return put_row(out, set, wide_ids, i); });
}

}  // namespace astrosplat
