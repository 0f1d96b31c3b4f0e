#include "core/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text.h"

namespace astrosplat {
namespace {

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

std::string_view without_quotes(std::string_view field) {
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
        field = trim(field.substr(1, field.size() - 2));
    return field;
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }

}  // namespace

void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields) {
    fields.clear();
    bool quoted = false;
    std::size_t begin = 0;
    const auto add = [&](std::size_t end) {
        const std::string_view field = trim(line.substr(begin, end - begin));
        if (separator != ' ' || !field.empty()) fields.push_back(without_quotes(field));
        begin = end + 1;
    };
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"') quoted = !quoted;
        if (!quoted && (separator == ' ' ? is_blank(line[i]) : line[i] == separator)) add(i);
    }
    add(line.size());
}

char separator_of(std::string_view line) {
    char best = ',';
    for (const char c : {';', '\t'})
        if (std::ranges::count(line, c) > std::ranges::count(line, best)) best = c;
    return line.find(best) == line.npos ? ' ' : best;
}

bool read_number(std::string_view field, std::optional<double>& number) {
    number.reset();
    field = trim(field);
    if (field.empty() || field == "-" || field == "~") return true;
    number = parse_double(field);
    if (number && std::isfinite(*number)) return true;
    number.reset();
    const std::string word = lower_case(std::string(field));
    return word == "null" || word == "nan";
}

bool TextRows::next() {
    if (line_ == 0 && rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
    while (!rest_.empty()) {
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        whole_row_ = rest_.substr(0, end);
        row_ = trim(whole_row_);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        ++line_;
        if (!row_.empty() && row_.front() != '#') return true;
    }
    return false;
}

const std::vector<std::string_view>& TextRows::fields(char separator) {
    split_fields(whole_row_, separator, fields_);
    return fields_;
}

double TextRows::number(std::string_view field, std::string_view what) const {
    const std::optional<double> value = parse_double(field);
    if (!value || !std::isfinite(*value))
        fail(fmt::format("a number for {}", what), field.empty() ? "nothing" : shown(field));
    return *value;
}

void TextRows::fail(const std::string& expected, const std::string& found) const {
    bad_input(file_, std::to_string(line_), expected, found);
}

TextTable::TextTable(std::string_view text) : rows_(text) {
    if (!rows_.next()) return;
    header_ = rows_.text();
    separator_ = separator_of(header_);
    for (const std::string_view name : rows_.fields(separator_))
        names_.push_back(lower_case(std::string(name)));
}

int TextTable::column(std::initializer_list<std::string_view> names) const {
    for (const std::string_view name : names)
        if (const auto found = std::ranges::find(names_, name); found != names_.end())
            return static_cast<int>(found - names_.begin());
    return none;
}

bool TextTable::next() {
    if (!rows_.next()) return false;
    fields_ = rows_.fields(separator_);
    return true;
}

std::string_view TextTable::field(int column) const {
    const auto index = static_cast<std::size_t>(column);
    return column >= 0 && index < fields_.size() ? fields_[index] : std::string_view();
}

}  // namespace astrosplat
