// Numbers, names and bytes as text, the same in every locale, foreign text made fit for messages, rows of
// text files and the names of enums.
#pragma once

#include <initializer_list>
#include <type_traits>

#include "core/standard.h"

namespace astrosplat {

/// `text` without spaces, tabs and line ends at both ends.
std::string_view trim(std::string_view text);

/// `text` fit for one line of a terminal: control characters, as of file names, as "\\n", "\\x1b".
std::string printable(std::string_view text);

/// `text` as one line of UTF-8 that XML can hold: bytes that are none are taken for Latin 1, control
/// characters become blanks; what is longer than `most` bytes is cut off behind a character.
std::string utf8_line(std::string_view text, std::size_t most = std::string_view::npos);

/// "1 frame", "12 frames", of a noun that takes an s.
std::string counted(std::int64_t count, std::string_view noun);

/// A length in the sky, of three digits: "4.2 ly", "31.1 kly", "29.4 Mly", "13 Gly".
std::string light_years_text(double light_years);

/// The texts that are not empty, each once, joined with "; ".
std::string joined_once(const std::vector<std::string>& texts);

/// "over, add or screen".
std::string alternatives(const std::vector<std::string>& names);

/// With a to z for A to Z; other letters stay as they are.
std::string lower_case(std::string text);

/// The whole of `text` as a number, with '.' as the decimal point; a leading '+' is allowed. Empty for
/// anything else, and for values too large for a double. "inf" and "nan" are numbers here: callers that need
/// finite ones check.
std::optional<double> parse_double(std::string_view text);
std::optional<std::int64_t> parse_int64(std::string_view text);

/// The shortest decimal that reads back as the same bits.
std::string shortest(double value);
std::string shortest(float value);

/// A word of a file for a message: in quotes, control characters written out, cut after 40 bytes.
std::string shown(std::string_view word);

/// Bytes as text of 64 letters (RFC 4648).
std::string base64(std::string_view bytes);

/// The bytes of such a text, with or without the padding at its end; nothing where it is none.
std::optional<std::string> bytes_of_base64(std::string_view text);

// Enums carry their names: next to each enum whose values people write or read stands one function with the
// names in order, found by argument lookup (in a struct it is a friend):
//
//     enum class Shape { constant, linear };
//     friend constexpr auto names_of(Shape) { return names_up_to<Shape::linear>("constant", "linear"); }
//
// Scene files, the manual, the window and messages all read these.

/// The names of all values up to `last`, which are numbered from 0 without gaps.
template <auto last, class... Names>
constexpr std::array<std::string_view, sizeof...(Names)> names_up_to(Names... names) {
    static_assert(sizeof...(Names) == std::size_t(last) + 1, "one name for every value");
    return {std::string_view(names)...};
}

template <class E>
concept NamedEnum = std::is_enum_v<E> && requires(E value) {
    names_of(value);
};

template <NamedEnum E>
constexpr std::string_view name_of(E value) {
    return names_of(value)[std::size_t(value)];
}

/// Whether the values are numbered as the constants of a shader, all of them.
template <NamedEnum E, class... Numbers>
constexpr bool numbered_as(Numbers... numbers) {
    int value = 0;
    return ((numbers == value++) && ...) && sizeof...(Numbers) == names_of(E{}).size();
}

/// All names, in order.
template <NamedEnum E>
std::vector<std::string> all_names() {
    constexpr auto names = names_of(E{});
    return {names.begin(), names.end()};
}

// Rows of text: lines that hold anything, their fields, and tables whose first row names the columns. In: a
// file's text. Out: one row after the other, which knows its line for every message. Rows are not kept.

/// Of comma, semicolon, tab and | the one that a line holds most of; ' ' where it has none of them.
char separator_of(std::string_view line);

/// Whether a field is a finite number, or says that there is none: nothing, "--", "~", "null", "nan", "n/a".
bool read_number(std::string_view field, std::optional<double>& number);

/// Goes from line to line; skips empty ones, comments (a '#' at the beginning) and a byte order mark.
class TextRows {
  public:
    /// `text` outlives this; `file` begins messages.
    explicit TextRows(std::string_view text, std::string file = "") : file_(std::move(file)), rest_(text) {}

    /// To the next row, the first at first; false at the end. Throws InputError for UTF-16.
    bool next();
    std::int64_t line() const { return line_; }     // from 1, of all lines
    std::string_view text() const { return row_; }  // without blanks at its ends
    /// Fields between separators, without blanks and quotes around them. A separator inside quotes separates
    /// nothing. ' ' is any number of blanks of any kind, so that no field is empty.
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

struct NamedColumn {
    std::string name;       // in lower case; empty: of what is no single number or text
    std::string unit = {};  // as it stands; empty: not said
    std::string ucd = {};   // what it holds, in the words of the Virtual Observatory, in lower case
};

/// A table of any format, one row after the other.
class RowTable {
  public:
    static constexpr int none = -1;

    virtual ~RowTable() = default;
    const std::vector<NamedColumn>& columns() const { return columns_; }
    /// The first column with one of these names, in lower case; capitals do not matter.
    int column(std::initializer_list<std::string_view> names) const;
    /// To the next row, the first at first; false at the end.
    virtual bool next() = 0;
    virtual std::int64_t line() const = 0;  // of a text the line, else the row, from 1
    /// Of this row, until the next; empty for `none` and where there is nothing.
    virtual std::string_view field(int column) const = 0;

  protected:
    std::vector<NamedColumn> columns_;
};

class TextTable final : public RowTable {
  public:
    /// Reads the row of names, which may have units behind them: "ra [deg]", "dist (pc)". `text` outlives the
    /// table.
    explicit TextTable(std::string_view text);
    /// The names as they stand, for messages.
    std::string_view header() const { return header_; }
    bool next() override;
    std::int64_t line() const override { return rows_.line(); }
    std::string_view field(int column) const override;
    /// This row tells the units; dashes are none.
    void take_units();
    /// Comments above the names do, as astropy's ECSV has them: "# - {name: ra, unit: rad, ...}".
    void take_units(std::string_view comments);

  private:
    TextRows rows_;
    std::string_view header_;
    char separator_ = ',';
    std::vector<std::string_view> fields_;  // of this row
};

}  // namespace astrosplat
