// Rows of numbers in a text file: goes from line to line, skips empty ones and comments, and knows the line
// for every message.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace astrosplat::camera_files {

class TextRows {
  public:
    /// `text` outlives this. A byte order mark is skipped.
    TextRows(std::string file, std::string_view text);

    /// Goes on to the next line that holds anything but blanks and a comment ('#'); false at the end.
    bool next();
    std::int64_t line() const { return line_; }
    std::string_view text() const { return row_; }  // without blanks at its ends
    /// Splits the line at blanks, or at `separator` (then a word may be empty).
    const std::vector<std::string_view>& words(char separator = ' ');

    /// A finite number. Throws InputError "FILE:LINE: expected a number for WHAT, found 'x'".
    double number(std::string_view word, std::string_view what) const;
    /// Throws InputError with the file and this line.
    [[noreturn]] void fail(const std::string& expected, const std::string& found) const;

  private:
    std::string file_;
    std::string_view rest_, row_;
    std::int64_t line_ = 0;
    std::vector<std::string_view> words_;
};

}  // namespace astrosplat::camera_files
