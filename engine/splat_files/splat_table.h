// Row-wise files (PDA, PLY) to a SplatSet. The reader says which column of a row holds which field; this
// allocates the arrays, checks and stores each number where it belongs, and fills in what the file does not
// say.
#pragma once

#include <atomic>
#include <cfloat>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "splats/splat_set.h"

namespace astrosplat {

enum class Field : std::uint8_t {
    skip,
    x,
    y,
    z,
    red,
    green,
    blue,
    alpha,
    distance,
    radius,
    s,
    t,
    mesh,
    id,
    id_high,
    scale_x,
    scale_y,
    scale_z,
    rotation_x,
    rotation_y,
    rotation_z,
    rotation_w,
    harmonic  // number Column::component of the 48
};

/// How a file stores a number of a binary row (PLY); text files leave it alone.
enum class NumberType : std::uint8_t { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

/// One column of a row: what it is, and where its numbers go (set by open_table).
struct Column {
    std::string name;  // as in the file, for messages
    Field field = Field::skip;
    int component = 0;        // Field::harmonic: 3 times the coefficient, and the channel
    bool any_number = false;  // also those that are not finite
    NumberType type = NumberType::f32;
    bool list = false;  // a count (of list_count type), then so many numbers: always skipped
    NumberType list_count = NumberType::u8;
    std::span<const float> codes;  // not empty: the file holds whole numbers that index this table

    float* out = nullptr;                        // first row's element
    std::size_t stride = 1;                      // floats between rows
    float lowest = -FLT_MAX, highest = FLT_MAX;  // outside: an error, or clamped where `clamped` counts
    std::atomic<std::int64_t>* clamped = nullptr;
    std::uint64_t* id = nullptr;
    std::uint32_t* whole = nullptr;  // mesh, id_high
};

struct SplatTable {
    std::vector<Column> columns;
    SplatSet set;
    Buffer<std::uint32_t> id_high;         // upper halves of ids, where a column holds them
    std::atomic<std::int64_t> clamped{0};  // opacities outside of 0..1
    bool has(Field field) const;
};

/// What columns hold, as splat_attributes() of splat_file.h names it.
std::vector<std::string> attribute_names(const std::vector<Column>& columns);

/// Allocates the arrays for `rows` rows (memory is claimed first) and points the columns at them.
void open_table(SplatTable& table, std::int64_t rows, const std::filesystem::path& file);

/// Fills in what the file lacks (white, opacity 1, distance 0, row number), finds the largest distance, warns
/// about clamped opacities, and hands out the set.
SplatSet finish_table(SplatTable& table, const std::filesystem::path& file);

/// What is wrong with `value`, as "expected ..." wants it; called only when `store` failed.
std::string expectation(const Column& column);

/// The rare part of `store`: clamps where that is allowed.
bool store_outside(const Column& column, std::size_t row, float value);

/// Stores a real field. False when the field cannot take the value (not finite, negative radius or distance).
inline bool store(const Column& column, std::size_t row, float value) {
    if (!column.codes.empty()) {
        if (!(value >= 0.0f && value < static_cast<float>(column.codes.size()))) return false;
        const auto code = static_cast<std::size_t>(value);
        if (static_cast<float>(code) != value) return false;
        value = column.codes[code];
    }
    if (!(value >= column.lowest && value <= column.highest)) return store_outside(column, row, value);
    column.out[row * column.stride] = value;
    return true;
}

/// Stores a whole field: id, id_high or mesh. False when the value does not fit.
inline bool store_whole(const Column& column, std::size_t row, std::uint64_t value) {
    if (column.id) {
        column.id[row] = value;
        return true;
    }
    if (value > 0xffffffffu) return false;
    column.whole[row] = static_cast<std::uint32_t>(value);
    return true;
}

inline bool is_whole(Field field) {
    return field == Field::mesh || field == Field::id || field == Field::id_high;
}

}  // namespace astrosplat
