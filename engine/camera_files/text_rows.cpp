#include "camera_files/text_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/shown.h"
#include "core/text.h"

namespace astrosplat::camera_files {

TextRows::TextRows(std::string file, std::string_view text) : file_(std::move(file)), rest_(text) {
    if (rest_.substr(0, 3) == "\xef\xbb\xbf") rest_.remove_prefix(3);
}

bool TextRows::next() {
    while (!rest_.empty()) {
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        row_ = trim(rest_.substr(0, end));
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        ++line_;
        if (!row_.empty() && row_[0] != '#') return true;
    }
    return false;
}

const std::vector<std::string_view>& TextRows::words(char separator) {
    words_.clear();
    if (separator != ' ') {
        for (std::size_t from = 0, end = 0; from <= row_.size(); from = end + 1) {
            end = std::min(row_.find(separator, from), row_.size());
            words_.push_back(trim(row_.substr(from, end - from)));
        }
        return words_;
    }
    constexpr std::string_view blanks = " \t\r\f\v";
    for (std::size_t from = row_.find_first_not_of(blanks); from < row_.size();) {
        const std::size_t end = std::min(row_.find_first_of(blanks, from), row_.size());
        words_.push_back(row_.substr(from, end - from));
        from = row_.find_first_not_of(blanks, end);
    }
    return words_;
}

double TextRows::number(std::string_view word, std::string_view what) const {
    const std::optional<double> value = parse_double(word);
    if (!value || !std::isfinite(*value))
        fail(fmt::format("a number for {}", what), word.empty() ? "nothing" : shown(word));
    return *value;
}

void TextRows::fail(const std::string& expected, const std::string& found) const {
    bad_input(file_, std::to_string(line_), expected, found);
}

}  // namespace astrosplat::camera_files
