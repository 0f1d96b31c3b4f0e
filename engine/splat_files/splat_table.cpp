// Allocation, defaults and checks that PDA and PLY share.
#include "splat_files/splat_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"

namespace astrosplat {

namespace {

constexpr std::int64_t rows_per_chunk = 1 << 16;

template <class T>
void fill(Buffer<T>& array, std::size_t rows, const T& value) {
    array.resize(rows);
    parallel_chunks(static_cast<std::int64_t>(rows), rows_per_chunk,
                    [&](std::int64_t begin, std::int64_t end, int) {
                        std::fill(array.begin() + begin, array.begin() + end, value);
                    });
}

std::int64_t bytes_per_row(const SplatTable& table) {
    std::size_t bytes = bytes_per_splat([&](SplatColumn column) {
        return !is_optional(column) || (column == SplatColumn::radius && table.has(Field::radius)) ||
               (column == SplatColumn::uv && table.has(Field::s)) ||
               (column == SplatColumn::mesh && table.has(Field::mesh)) ||
               (table.has(Field::scale_x) &&
                (column == SplatColumn::scale || column == SplatColumn::rotation ||
                 column == SplatColumn::radius)) ||
               (column == SplatColumn::harmonics && table.has(Field::harmonic));
    });
    if (table.has(Field::id_high)) bytes += sizeof(std::uint32_t);
    return static_cast<std::int64_t>(bytes);
}

void allocate(SplatTable& table, std::size_t rows) {
    SplatSet& set = table.set;
    set.position.resize(rows);
    set.id.resize(rows);
    if (table.has(Field::red)) set.color.resize(rows);
    if (table.has(Field::alpha)) set.alpha.resize(rows);
    if (table.has(Field::distance)) set.distance.resize(rows);
    if (table.has(Field::radius)) set.radius.resize(rows);
    if (table.has(Field::s)) set.uv.resize(rows);
    if (table.has(Field::mesh)) set.mesh.resize(rows);
    if (table.has(Field::id_high)) table.id_high.resize(rows);
    if (table.has(Field::scale_x)) set.scale.resize(rows);
    if (table.has(Field::rotation_x)) set.rotation.resize(rows);
    if (table.has(Field::harmonic)) fill(set.harmonics, rows, Harmonics{});
}

void bind(Column& column, SplatTable& table) {
    SplatSet& set = table.set;
    const auto point_at = [&](float* array, Field first, std::size_t stride) {
        column.out = array + (static_cast<std::size_t>(column.field) - static_cast<std::size_t>(first));
        column.stride = stride;
    };
    switch (column.field) {
        case Field::skip:
            break;
        case Field::x:
        case Field::y:
        case Field::z:
            point_at(&set.position.data()->x, Field::x, 3);
            break;
        case Field::red:
        case Field::green:
        case Field::blue:
            point_at(&set.color.data()->x, Field::red, 3);
            break;
        case Field::s:
        case Field::t:
            point_at(&set.uv.data()->x, Field::s, 2);
            break;
        case Field::alpha:
            point_at(set.alpha.data(), Field::alpha, 1);
            if (column.any_number) break;
            column.lowest = 0.0f;
            column.highest = 1.0f;
            column.clamped = &table.clamped;
            break;
        case Field::distance:
        case Field::radius:
            column.out = (column.field == Field::radius ? set.radius : set.distance).data();
            column.lowest = 0.0f;
            break;
        case Field::mesh:
            column.whole = set.mesh.data();
            break;
        case Field::id:
            column.id = set.id.data();
            break;
        case Field::id_high:
            column.whole = table.id_high.data();
            break;
        case Field::scale_x:
        case Field::scale_y:
        case Field::scale_z:
            point_at(&set.scale.data()->x, Field::scale_x, 3);
            break;
        case Field::rotation_x:
        case Field::rotation_y:
        case Field::rotation_z:
        case Field::rotation_w:
            point_at(&set.rotation.data()->x, Field::rotation_x, 4);
            break;
        case Field::harmonic:
            column.out = &set.harmonics.data()->c[0].x + column.component;
            column.stride = 3 * Harmonics::count;
            break;
    }
}

float largest(const Buffer<float>& values) {
    std::vector<float> of_chunk((values.size() + rows_per_chunk - 1) / rows_per_chunk, 0.0f);
    parallel_chunks(static_cast<std::int64_t>(values.size()), rows_per_chunk,
                    [&](std::int64_t begin, std::int64_t end, int) {
                        of_chunk[begin / rows_per_chunk] =
                            *std::max_element(values.begin() + begin, values.begin() + end);
                    });
    return of_chunk.empty() ? 0.0f : *std::ranges::max_element(of_chunk);
}

void finish_ids(SplatTable& table) {
    Buffer<std::uint64_t>& id = table.set.id;
    const bool numbered = table.has(Field::id);
    if (numbered && table.id_high.empty()) return;
    parallel_each(id.size(), rows_per_chunk, [&](std::size_t i) {
        id[i] = numbered ? id[i] | std::uint64_t{table.id_high[i]} << 32 : i;
    });
}

}  // namespace

bool SplatTable::has(Field field) const {
    return std::ranges::any_of(columns, [&](const Column& c) { return c.field == field; });
}

std::vector<std::string> attribute_names(const std::vector<Column>& columns) {
    constexpr std::array<std::pair<Field, const char*>, 11> names = {{{Field::x, "position"},
                                                                      {Field::red, "color"},
                                                                      {Field::alpha, "alpha"},
                                                                      {Field::distance, "distance"},
                                                                      {Field::radius, "radius"},
                                                                      {Field::s, "uv"},
                                                                      {Field::mesh, "mesh"},
                                                                      {Field::scale_x, "scale"},
                                                                      {Field::rotation_x, "rotation"},
                                                                      {Field::harmonic, "harmonics"},
                                                                      {Field::id, "id"}}};
    std::vector<std::string> present;
    for (const auto& [field, name] : names)
        if (std::ranges::any_of(columns, [f = field](const Column& c) { return c.field == f; }))
            present.emplace_back(name);
    return present;
}

void open_table(SplatTable& table, std::int64_t rows, const std::filesystem::path& file) {
    if (rows == 0) return;
    claim_memory(rows * bytes_per_row(table), "splats of " + file.string());
    allocate(table, static_cast<std::size_t>(rows));
    for (Column& column : table.columns) bind(column, table);
}

SplatSet finish_table(SplatTable& table, const std::filesystem::path& file) {
    SplatSet& set = table.set;
    const auto rows = static_cast<std::size_t>(set.size());
    if (set.color.empty()) fill(set.color, rows, glm::vec3(1.0f));
    if (set.alpha.empty()) fill(set.alpha, rows, 1.0f);
    if (set.distance.empty()) fill(set.distance, rows, 0.0f);
    finish_ids(table);
    set.max_distance = largest(set.distance);
    if (table.clamped > 0)
        log_warning(fmt::format("{}: {} of {} opacities lie outside 0..1; they are clamped", file.string(),
                                table.clamped.load(), rows));
    return std::move(set);
}

std::string expectation(const Column& column) {
    if (is_whole(column.field))
        return fmt::format("a whole number >= 0{} for {}", column.id ? "" : " and < 2^32", column.name);
    if (!column.codes.empty())
        return fmt::format("a whole number 0..{} for {}", column.codes.size() - 1, column.name);
    if (column.lowest == 0.0f && !column.clamped)
        return fmt::format("a finite number >= 0 for {}", column.name);
    return fmt::format("a finite number for {}", column.name);
}

bool store_outside(const Column& column, std::size_t row, float value) {
    if (column.any_number) {
        column.out[row * column.stride] = value;
        return true;
    }
    if (!column.clamped || !std::isfinite(value)) return false;
    column.out[row * column.stride] = std::clamp(value, column.lowest, column.highest);
    column.clamped->fetch_add(1, std::memory_order_relaxed);
    return true;
}

}  // namespace astrosplat
