// Rows of text: lines that hold anything, their fields, and tables whose first row names the columns. In: a
// file's text. Out: one row after the other, which knows its line for every message. Rows are not kept.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace astrosplat {

/// Fields between separators, without blanks and quotes around them. A separator inside quotes separates
/// nothing. ' ' is any number of blanks of any kind, so that no field is empty.
void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields);

/// Of comma, semicolon and tab the one that a line holds most of; ' ' where it has none of them.
char separator_of(std::string_view line);

/// Whether a field is a finite number, or says that there is none: nothing, "-", "~", "null", "nan".
bool read_number(std::string_view field, std::optional<double>& number);

/// Goes from line to line; skips empty ones, comments (a '#' at the beginning) and a byte order mark.
class TextRows {
  public:
    /// `text` outlives this; `file` begins messages.
    explicit TextRows(std::string_view text, std::string file = "") : file_(std::move(file)), rest_(text) {}

    /// To the next row, the first at first; false at the end.
    bool next();
    std::int64_t line() const { return line_; }     // from 1, of all lines
    std::string_view text() const { return row_; }  // without blanks at its ends
    const std::vector<std::string_view>& fields(char separator = ' ');

    /// A finite number. Throws InputError "FILE:LINE: expected a number for WHAT, found 'x'".
    double number(std::string_view field, std::string_view what) const;
    /// Throws InputError with the file and this line.
    [[noreturn]] void fail(const std::string& expected, const std::string& found) const;

  private:
    std::string file_;
    std::string_view rest_, whole_row_, row_;
    std::int64_t line_ = 0;
    std::vector<std::string_view> fields_;
};

class TextTable {
  public:
    static constexpr int none = -1;

    /// Reads the row of names. `text` outlives the table.
    explicit TextTable(std::string_view text);
    /// The names as they stand, for messages.
    std::string_view header() const { return header_; }
    /// The first column with one of these names, in lower case; capitals do not matter.
    int column(std::initializer_list<std::string_view> names) const;
    /// To the next row, the first at first; false at the end.
    bool next();
    std::int64_t line() const { return rows_.line(); }
    /// Of this row; empty for `none` and where the row is too short.
    std::string_view field(int column) const;

  private:
    TextRows rows_;
    std::string_view header_;
    char separator_ = ',';
    std::vector<std::string> names_;
    std::vector<std::string_view> fields_;  // of this row
};

}  // namespace astrosplat
