// Allocation, defaults and checks that PDA and PLY share, and rows of text. A chunk of text is about a MiB:
// large enough to be cheap to hand out, small enough for the cache.
#include "splat_files/splat_table.h"

#include <fmt/format.h>

#include <cstring>
#include <type_traits>

#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "splat_files/file_bytes.h"
#include "splat_files/number_text.h"

namespace astrosplat {
namespace {

constexpr std::int64_t rows_per_chunk = 1 << 16;

template <class T>
void fill(Buffer<T>& array, std::size_t rows, const T& value) {
    array.resize(rows);
    parallel_chunks(std::int64_t(rows), rows_per_chunk, [&](std::int64_t begin, std::int64_t end, int) {
        std::fill(array.begin() + begin, array.begin() + end, value);
    });
}

bool has_upper_ids(const SplatTable& table) {
    return std::ranges::any_of(table.columns, [](const Column& c) {
        return c.field && c.field->column == SplatColumn::id && c.field->component == 1;
    });
}

std::int64_t bytes_per_row(const SplatTable& table) {
    const std::size_t bytes = bytes_per_splat([&](SplatColumn column) {
        const bool of_gaussians = column == SplatColumn::radius && table.has(SplatColumn::scale);
        return !is_optional(column) || table.has(column) || of_gaussians;
    });
    return std::int64_t(bytes + (has_upper_ids(table) ? sizeof(std::uint32_t) : 0));
}

void allocate(SplatTable& table, std::size_t rows) {
    for_each_column([&](auto array, SplatColumn column) {
        if (column == SplatColumn::position || column == SplatColumn::id || table.has(column))
            (table.set.*array).resize(rows);
    });
    if (table.has(SplatColumn::harmonics)) fill(table.set.harmonics, rows, Harmonics{});
    if (has_upper_ids(table)) table.id_high.resize(rows);
}

void bind(Column& column, SplatTable& table) {
    if (!column.field) return;
    const Field field = *column.field;
    for_each_column([&]<class T>(Buffer<T> SplatSet::*array, SplatColumn which) {
        if (which != field.column) return;
        T* const values = (table.set.*array).data();
        if constexpr (std::is_same_v<T, std::uint64_t>) {
            if (field.component == 0)
                column.id = values;
            else
                column.whole = table.id_high.data();
        } else if constexpr (std::is_same_v<T, std::uint32_t>) {
            column.whole = values;
        } else {
            column.out = reinterpret_cast<float*>(values) + field.component;
            column.stride = sizeof(T) / sizeof(float);
        }
    });
    if (column.any_number) return;
    const bool is_alpha = field.column == SplatColumn::alpha;
    if (is_alpha) column.highest = 1.0f, column.clamped = &table.clamped;
    if (is_alpha || field.column == SplatColumn::distance || field.column == SplatColumn::radius)
        column.lowest = 0.0f;
}

float largest(const Buffer<float>& values) {
    std::vector<float> of_chunk((values.size() + rows_per_chunk - 1) / rows_per_chunk, 0.0f);
    parallel_chunks(std::int64_t(values.size()), rows_per_chunk,
                    [&](std::int64_t begin, std::int64_t end, int) {
                        of_chunk[begin / rows_per_chunk] =
                            *std::max_element(values.begin() + begin, values.begin() + end);
                    });
    return of_chunk.empty() ? 0.0f : *std::ranges::max_element(of_chunk);
}

void finish_ids(SplatTable& table) {
    Buffer<std::uint64_t>& id = table.set.id;
    const bool numbered = table.has(SplatColumn::id);
    if (numbered && table.id_high.empty()) return;
    parallel_each(id.size(), rows_per_chunk, [&](std::size_t i) {
        id[i] = numbered ? id[i] | std::uint64_t{table.id_high[i]} << 32 : i;
    });
}

}  // namespace

bool SplatTable::has(SplatColumn column) const { return columns_held(columns)[index_of(column)]; }

SplatColumns columns_held(const std::vector<Column>& columns) {
    SplatColumns held;
    for (const Column& column : columns)
        if (column.field) held.set(index_of(column.field->column));
    return held;
}

void open_table(SplatTable& table, std::int64_t rows, const fs::path& file) {
    if (rows == 0) return;
    claim_memory(rows * bytes_per_row(table), "splats of " + file.string());
    allocate(table, std::size_t(rows));
    for (Column& column : table.columns) bind(column, table);
}

SplatSet finish_table(SplatTable& table, const fs::path& file) {
    SplatSet& set = table.set;
    const auto rows = std::size_t(set.size());
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
    if (is_whole(column))
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

namespace {

constexpr std::size_t chunk_bytes = std::size_t{1} << 20;

/// One line of the file while it is read.
struct Line {
    const char* begin;
    std::int64_t number;  // from 1
};

const char* line_end(const char* p, const char* end) {
    const void* newline = p < end ? std::memchr(p, '\n', std::size_t(end - p)) : nullptr;
    return newline ? static_cast<const char*>(newline) : end;
}

std::vector<TextChunk> cut(std::string_view text) {
    std::vector<TextChunk> chunks;
    while (!text.empty()) {
        const std::size_t newline = text.size() <= chunk_bytes ? text.npos : text.find('\n', chunk_bytes);
        const std::size_t size = newline == text.npos ? text.size() : newline + 1;
        chunks.push_back({text.substr(0, size), 0, 0});
        text.remove_prefix(size);
    }
    return chunks;
}

/// Counts a chunk's rows and lines into its own first_row and first_line;
/// split_rows turns them into running sums.
void count(TextChunk& chunk) {
    const char* p = chunk.text.data();
    const char* const end = p + chunk.text.size();
    while (p < end) {
        const char* const newline = line_end(p, end);
        if (scan::skip_blanks(p, newline) != newline) ++chunk.first_row;
        ++chunk.first_line;
        p = newline + 1;
    }
    forget_pages(chunk.text);
}

std::string describe(const SplatTable& table) {
    std::string names;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const Column& column = table.columns[i];
        if (i > 0 && column.name == table.columns[i - 1].name) continue;  // components of one vector
        names += (names.empty() ? "" : " ") + column.name;
    }
    return names;
}

[[noreturn]] void wrong_length(const SplatTable& table, const fs::path& file, const Line& line,
                               const char* end) {
    std::size_t found = 0;
    const char* const stop = line_end(line.begin, end);
    for (const char* p = scan::skip_blanks(line.begin, stop); p < stop; ++found)
        p = scan::skip_blanks(scan::token_end(p, stop), stop);
    const bool lists = std::ranges::any_of(table.columns, [](const Column& c) { return c.list; });
    bad_input(
        file, std::to_string(line.number),
        fmt::format("{}{} numbers ({})", lists ? "at least " : "", table.columns.size(), describe(table)),
        std::to_string(found));
}

/// Reads one number of a column that is no list; nullptr when it is bad.
const char* read_value(const Column& column, std::size_t row, const char* p, const char* end) {
    if (!column.field) return scan::token_end(p, end);
    bool good = false;
    if (is_whole(column)) {
        std::uint64_t value = 0;
        p = scan::scan_whole(p, end, value);
        good = p && store_whole(column, row, value);
    } else {
        float value = 0.0f;
        p = scan::scan_float(p, end, value);
        good = p && store(column, row, value);
    }
    return good && (p == end || scan::is_space(*p)) ? p : nullptr;
}

/// Skips a list: its count, then so many tokens, as far as the line has them; nullptr when the count is bad
/// or the line ends too early.
const char* skip_list(const char* p, const char* end) {
    std::uint64_t left = 0;
    p = scan::scan_whole(p, end, left);
    for (; p && left > 0; --left) {
        p = scan::skip_blanks(p, end);
        if (p == end || *p == '\n') return nullptr;
        p = scan::token_end(p, end);
    }
    return p;
}

/// Reads the row that begins at line.begin; returns the end of its line.
const char* read_row(const SplatTable& table, std::size_t row, const Line& line, const char* end,
                     const fs::path& file) {
    const char* p = line.begin;
    for (const Column& column : table.columns) {
        p = scan::skip_blanks(p, end);
        if (p == end || *p == '\n') wrong_length(table, file, line, end);
        const char* const token = p;
        p = column.list ? skip_list(p, end) : read_value(column, row, p, end);
        if (p) continue;
        if (column.list) wrong_length(table, file, line, end);
        const char* const stop = scan::token_end(token, end);
        bad_input(file, std::to_string(line.number), expectation(column),
                  quoted({token, std::size_t(stop - token)}));
    }
    p = scan::skip_blanks(p, end);
    if (p < end && *p != '\n') wrong_length(table, file, line, end);
    return p;
}

/// Reads the rows of one chunk that lie in [begin, end).
void read_chunk(const TextChunk& chunk, std::int64_t begin, std::int64_t end, const SplatTable& table,
                const fs::path& file) {
    Line line{chunk.text.data(), chunk.first_line};
    const char* const stop = line.begin + chunk.text.size();
    for (std::int64_t row = chunk.first_row; line.begin < stop && row < end; ++line.number) {
        const char* const first = scan::skip_blanks(line.begin, stop);
        const bool blank = first == stop || *first == '\n';
        const bool wanted = !blank && row >= begin;
        const char* const after =
            wanted ? read_row(table, std::size_t(row - begin), line, stop, file) : line_end(first, stop);
        if (!blank) ++row;
        line.begin = after + 1;
    }
}

}  // namespace

SplitRows split_rows(std::string_view text, std::int64_t first_line) {
    SplitRows result{cut(text), 0};
    parallel_for(std::int64_t(result.chunks.size()), [&](std::int64_t i, int) { count(result.chunks[i]); });
    for (TextChunk& chunk : result.chunks) {
        const TextChunk counted = chunk;
        chunk.first_row = result.rows;
        chunk.first_line = first_line;
        result.rows += counted.first_row;
        first_line += counted.first_line;
    }
    return result;
}

void read_text_rows(const SplitRows& rows, std::int64_t begin, std::int64_t end, const SplatTable& table,
                    const fs::path& file, const Progress& progress) {
    parallel_parts(rows.chunks.size(), progress, [&](std::size_t chunk) {
        read_chunk(rows.chunks[chunk], begin, end, table, file);
        forget_pages(rows.chunks[chunk].text);
    });
}

std::string quoted(std::string_view text) {
    constexpr std::size_t longest = 32;
    std::string result = "'";
    for (const char c : text.substr(0, longest)) {
        if (c >= ' ' && c <= '~')
            result += c;
        else
            result += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
    return result + (text.size() > longest ? "...'" : "'");
}

}  // namespace astrosplat
