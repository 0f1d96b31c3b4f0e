// A table in text, line by line. In: text whose first line names the columns, separated by commas,
// semicolons, tabs or blanks; fields may stand in quotes. Out: the fields of one row after the other, found
// by their columns' names. Rows are not kept.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace astrosplat {

/// Lines that hold anything, without their newlines (of "\r\n" the former stays), without those that begin
/// with #; a byte order mark before the first is skipped.
class TextLines {
  public:
    explicit TextLines(std::string_view text);
    /// To the next line, the first at first; false at the end.
    bool next();
    std::string_view line() const { return line_; }
    std::int64_t number() const { return number_; }  // from 1, of the text's lines

  private:
    std::string_view rest_, line_;
    std::int64_t number_ = 0;
};

/// Fields between separators, without blanks and quotes around them. A separator inside quotes separates
/// nothing. Of blanks many are as one, so that no field is empty.
void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields);

/// Whether a field is a finite number, or says that there is none: nothing, "-", "~", "null", "nan".
bool read_number(std::string_view field, std::optional<double>& number);

class TextTable {
  public:
    static constexpr int none = -1;

    /// Reads the line of names. `text` must outlive the table.
    explicit TextTable(std::string_view text);
    /// The names as they stand, for messages.
    std::string_view header() const { return header_; }
    /// The first column with one of these names, in lower case; capitals do not matter.
    int column(std::initializer_list<std::string_view> names) const;
    /// To the next row, the first at first; false at the end.
    bool next();
    std::int64_t line() const { return lines_.number(); }
    /// Of this row; empty for `none` and where the row is too short.
    std::string_view field(int column) const;

  private:
    TextLines lines_;
    std::string_view header_;
    char separator_ = ',';
    std::vector<std::string> names_;
    std::vector<std::string_view> fields_;
};

}  // namespace astrosplat
