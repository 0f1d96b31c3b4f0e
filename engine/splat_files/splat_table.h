// Row-wise files (PDA, PLY) to a SplatSet. The reader says which number of a row goes into which column of
// the set; this allocates the arrays, checks and stores each number where it belongs, and fills in what the
// file does not say. Rows of text, one a line, are read here in parallel: the text is cut at line ends into
// chunks whose rows are counted first, so that a wrong count is answered before any memory is taken.
#pragma once

#include <atomic>
#include <cfloat>

#include "core/progress.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// Where numbers of a file go.
struct Field {
    SplatColumn column;
    /// Of its vector; of harmonics 3 times the coefficient, and the channel; of the id 1: its upper half.
    int component = 0;
};

/// How a file stores a number of a binary row (PLY); text files leave it alone.
enum class NumberType : std::uint8_t { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

/// One column of a row: what it is, and where its numbers go (set by open_table).
struct Column {
    std::string name;            // as in the file, for messages
    std::optional<Field> field;  // empty: skipped
    bool any_number = false;     // also those that are not finite
    NumberType type = NumberType::f32;
    bool list = false;  // a count (of list_count type), then so many numbers: always skipped
    NumberType list_count = NumberType::u8;
    std::span<const float> codes;  // not empty: the file holds whole numbers that index this table

    float* out = nullptr;                        // first row's element
    std::size_t stride = 1;                      // floats between rows
    float lowest = -FLT_MAX, highest = FLT_MAX;  // outside: an error, or clamped where `clamped` counts
    std::atomic<std::int64_t>* clamped = nullptr;
    std::uint64_t* id = nullptr;
    std::uint32_t* whole = nullptr;  // the mesh, or the upper half of an id
};

struct SplatTable {
    std::vector<Column> columns;
    SplatSet set;
    Buffer<std::uint32_t> id_high;         // upper halves of ids, where a column holds them
    std::atomic<std::int64_t> clamped{0};  // opacities outside of 0..1
    bool has(SplatColumn column) const;
};

/// The part of a set that these columns hold.
SplatColumns columns_held(const std::vector<Column>& columns);

/// Allocates the arrays for `rows` rows (memory is claimed first) and points the columns at them.
void open_table(SplatTable& table, std::int64_t rows, const fs::path& file);

/// Fills in what the file lacks (white, opacity 1, distance 0, row number), finds the largest distance, warns
/// about clamped opacities, and hands out the set.
SplatSet finish_table(SplatTable& table, const fs::path& file);

/// The values allowed in place of `value`, behind "expected"; called only when `store` failed.
std::string expectation(const Column& column);

/// The rare part of `store`: clamps where that is allowed.
bool store_outside(const Column& column, std::size_t row, float value);

/// Stores a real field. False when the field cannot take the value (not finite, negative radius or distance).
inline bool store(const Column& column, std::size_t row, float value) {
    if (!column.codes.empty()) {
        if (!(value >= 0.0f && value < float(column.codes.size()))) return false;
        const auto code = std::size_t(value);
        if (float(code) != value) return false;
        value = column.codes[code];
    }
    if (!(value >= column.lowest && value <= column.highest)) return store_outside(column, row, value);
    column.out[row * column.stride] = value;
    return true;
}

/// Stores a whole field: id, its upper half or mesh. False when the value does not fit.
inline bool store_whole(const Column& column, std::size_t row, std::uint64_t value) {
    if (column.id) {
        column.id[row] = value;
        return true;
    }
    if (value > 0xffffffffu) return false;
    column.whole[row] = std::uint32_t(value);
    return true;
}

inline bool is_whole(const Column& column) {
    return column.field &&
           (column.field->column == SplatColumn::mesh || column.field->column == SplatColumn::id);
}

/// A run of whole lines.
struct TextChunk {
    std::string_view text;
    std::int64_t first_row = 0;   // blank lines are no rows
    std::int64_t first_line = 0;  // of the file, from 1
};

struct SplitRows {
    std::vector<TextChunk> chunks;
    std::int64_t rows = 0;
};

/// Cuts and counts; `first_line` is the file's line where `text` begins. Blank lines count as lines,
/// not as rows.
SplitRows split_rows(std::string_view text, std::int64_t first_line);

/// Reads rows [begin, end) of `rows` into the table's columns as its rows 0 .. end-begin. The lowest bad row
/// decides the InputError, whatever the threads do.
void read_text_rows(const SplitRows& rows, std::int64_t begin, std::int64_t end, const SplatTable& table,
                    const fs::path& file, const Progress& progress);

/// Text of a file for a message: one line, quoted, shortened to 32 characters,
/// others than printable ASCII as \xNN.
std::string quoted(std::string_view text);

}  // namespace astrosplat
