#include "splat_files/ply_gaussians.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "splats/harmonics.h"

namespace astrosplat {
namespace {

constexpr std::pair<std::string_view, Field> properties[] = {
    {"x", Field::x},
    {"y", Field::y},
    {"z", Field::z},
    {"opacity", Field::alpha},
    {"scale_0", Field::scale_x},
    {"scale_1", Field::scale_y},
    {"scale_2", Field::scale_z},
    {"rot_0", Field::rotation_w},
    {"rot_1", Field::rotation_x},
    {"rot_2", Field::rotation_y},
    {"rot_3", Field::rotation_z},
};
constexpr std::string_view mean_names[] = {"f_dc_0", "f_dc_1", "f_dc_2"};
constexpr std::string_view rest_prefix = "f_rest_";

bool has(const PlyElement& vertex, std::string_view name) {
    return std::ranges::any_of(vertex.properties, [&](const Column& c) { return c.name == name && !c.list; });
}

/// Coefficients beyond degree 0 that the vertex has a channel; their names are numbered from 0 on.
int rest_count(const PlyElement& vertex, const std::filesystem::path& file) {
    const auto found = std::ranges::count_if(
        vertex.properties, [](const Column& c) { return c.name.starts_with(rest_prefix) && !c.list; });
    if (found != 0 && found != 9 && found != 24 && found != 45)
        bad_input(file.string(), "", "0, 9, 24 or 45 properties f_rest_*", std::to_string(found));
    for (int i = 0; i < found; ++i)
        if (!has(vertex, fmt::format("{}{}", rest_prefix, i)))
            bad_input(file.string(), "", fmt::format("properties f_rest_0 to f_rest_{}", found - 1),
                      fmt::format("no {}{}", rest_prefix, i));
    return static_cast<int>(found) / 3;
}

void assign(Column& column, int rest) {
    if (column.list) return;
    const auto set = [&](Field field) {
        column.field = field;
        column.any_number = true;
    };
    for (const auto& [name, field] : properties)
        if (column.name == name) set(field);
    for (int k = 0; k < 3; ++k) {
        if (column.name != mean_names[k]) continue;
        set(rest == 0 ? static_cast<Field>(static_cast<int>(Field::red) + k) : Field::harmonic);
        column.component = k;
    }
    if (!column.name.starts_with(rest_prefix)) return;
    const auto number = static_cast<int>(parse_int64(column.name.substr(rest_prefix.size())).value_or(0));
    set(Field::harmonic);
    column.component = 3 * (1 + number % rest) + number / rest;
}

}  // namespace

bool holds_gaussians(const PlyElement& vertex) {
    return has(vertex, mean_names[0]) && (has(vertex, "scale_0") || has(vertex, "rot_0"));
}

std::vector<Column> gaussian_columns(const PlyElement& vertex, const std::filesystem::path& file) {
    const auto require = [&](std::string_view name) {
        if (!has(vertex, name))
            bad_input(file.string(), "",
                      "Gaussians with x y z, f_dc_0 to 2, opacity, scale_0 to 2 and rot_0 to 3",
                      fmt::format("no {}", name));
    };
    for (const auto& [name, field] : properties) require(name);
    for (const std::string_view name : mean_names) require(name);
    const int rest = rest_count(vertex, file);
    std::vector<Column> columns = vertex.properties;
    for (Column& column : columns) assign(column, rest);
    return columns;
}

}  // namespace astrosplat
