#include "stars/text_table.h"

#include <algorithm>
#include <cmath>

#include "core/text.h"

namespace astrosplat {
namespace {

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

// The one that the line of names holds most of; blanks where it has no other.
char separator_of(std::string_view header) {
    char best = ',';
    for (const char c : {';', '\t'})
        if (std::ranges::count(header, c) > std::ranges::count(header, best)) best = c;
    return header.find(best) == header.npos ? ' ' : best;
}

std::string_view without_quotes(std::string_view field) {
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
        field = trim(field.substr(1, field.size() - 2));
    return field;
}

}  // namespace

TextLines::TextLines(std::string_view text) : rest_(text) {
    if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
}

bool TextLines::next() {
    while (!rest_.empty()) {
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        line_ = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        ++number_;
        const std::string_view content = trim(line_);
        if (!content.empty() && content.front() != '#') return true;
    }
    return false;
}

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
        if (line[i] == separator && !quoted) add(i);
    }
    add(line.size());
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

TextTable::TextTable(std::string_view text) : lines_(text) {
    if (!lines_.next()) return;
    header_ = trim(lines_.line());
    separator_ = separator_of(header_);
    split_fields(header_, separator_, fields_);
    for (const std::string_view name : fields_) names_.push_back(lower_case(std::string(name)));
}

int TextTable::column(std::initializer_list<std::string_view> names) const {
    for (const std::string_view name : names)
        if (const auto found = std::ranges::find(names_, name); found != names_.end())
            return static_cast<int>(found - names_.begin());
    return none;
}

bool TextTable::next() {
    if (!lines_.next()) return false;
    split_fields(lines_.line(), separator_, fields_);
    return true;
}

std::string_view TextTable::field(int column) const {
    const auto index = static_cast<std::size_t>(column);
    return column >= 0 && index < fields_.size() ? fields_[index] : std::string_view();
}

}  // namespace astrosplat
