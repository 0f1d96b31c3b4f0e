// Text without a locale: numbers by <charconv>.
#include "core/text.h"

#include <fmt/format.h>

#include <charconv>

#include "core/error.h"

namespace astrosplat {
namespace {

template <class T>
std::optional<T> parse(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    T value{};
    const char* end = text.data() + text.size();
    const std::from_chars_result result = std::from_chars(text.data(), end, value);
    if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
    return value;
}

template <class T>
std::string print_shortest(T value) {
    std::array<char, 40> text;
    const std::to_chars_result result = std::to_chars(text.data(), text.data() + text.size(), value);
    return std::string(text.data(), result.ptr);
}

constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

std::string_view without_quotes(std::string_view field) {
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
        field = trim(field.substr(1, field.size() - 2));
    return field;
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }

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

}  // namespace

std::string_view trim(std::string_view text) {
    const char* blanks = " \t\r\n";
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string printable(std::string_view text) {
    std::string shown;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        // In UTF-8 the control characters 0x80 to 0x9f, some of which terminals act on, follow a byte 0xc2.
        const bool wide = c == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0;
        if (c == '\n')
            shown += "\\n";
        else if (wide)
            shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[++i]));
        else if (c < 0x20 || c == 0x7f)
            shown += fmt::format("\\x{:02x}", c);
        else
            shown += text[i];
    }
    return shown;
}

namespace {

// Bytes of the character at the beginning of a text; 0: none of UTF-8 (RFC 3629).
std::size_t utf8_bytes(std::string_view text) {
    const auto byte = [&](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
    };
    const int lead = byte(0), second = byte(1);
    if (lead < 0x80) return 1;
    const std::size_t bytes = lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
    for (std::size_t i = 1; i < bytes; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    const bool too_long = lead < 0xc2 || (lead == 0xe0 && second < 0xa0) || (lead == 0xf0 && second < 0x90);
    const bool no_character =
        (lead == 0xed && second > 0x9f) || lead > 0xf4 || (lead == 0xf4 && second > 0x8f);
    return too_long || no_character ? 0 : bytes;
}

}  // namespace

std::string utf8_line(std::string_view text, std::size_t most) {
    std::string line;
    while (!text.empty()) {
        std::string character(text.substr(0, utf8_bytes(text)));
        const auto first = static_cast<unsigned char>(text[0]);
        text.remove_prefix(std::max<std::size_t>(1, character.size()));
        if (character.empty() && first >= 0xa0)
            character = {static_cast<char>(0xc0 | first >> 6), static_cast<char>(0x80 | (first & 0x3f))};
        else if (character.empty() || first < 0x20 || character == "\xef\xbf\xbe" ||
                 character == "\xef\xbf\xbf")
            character = " ";
        if (line.size() + character.size() > most) break;
        line += character;
    }
    return line;
}

std::string counted(std::int64_t count, std::string_view noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string light_years_text(double light_years) {
    constexpr double to_next = 999.5;  // which would be written "1e+03"
    constexpr std::array<const char*, 4> units{"ly", "kly", "Mly", "Gly"};
    std::size_t unit = 0;
    for (; unit + 1 < units.size() && light_years >= to_next; ++unit) light_years *= 1e-3;
    return fmt::format("{:.3g} {}", light_years, units[unit]);
}

std::string joined_once(const std::vector<std::string>& texts) {
    std::vector<std::string> known;
    for (const std::string& text : texts)
        if (!text.empty() && std::ranges::find(known, text) == known.end()) known.push_back(text);
    return fmt::format("{}", fmt::join(known, "; "));
}

std::string alternatives(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
        text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i];
    return text;
}

std::string lower_case(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

std::optional<double> parse_double(std::string_view text) { return parse<double>(text); }
std::optional<std::int64_t> parse_int64(std::string_view text) { return parse<std::int64_t>(text); }

std::string shortest(double value) { return print_shortest(value); }
std::string shortest(float value) { return print_shortest(value); }

std::string shown(std::string_view word) {
    constexpr std::size_t most = 40;
    return "'" + printable(word.substr(0, most)) + (word.size() > most ? "...'" : "'");
}

std::string base64(std::string_view bytes) {
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k)
            three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k <= bytes.size() ? letters[three >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

std::optional<std::string> bytes_of_base64(std::string_view text) {
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    if (text.size() % 4 == 1) return std::nullopt;
    std::string bytes;
    bytes.reserve(text.size() * 3 / 4);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const std::size_t value = letters.find(c);
        if (value == std::string_view::npos) return std::nullopt;
        bits = bits << 6 | std::uint32_t(value);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += static_cast<char>(bits >> count & 255);
    }
    return bytes;
}

char separator_of(std::string_view line) {
    char best = ',';
    for (const char c : {';', '\t', '|'})
        if (std::ranges::count(line, c) > std::ranges::count(line, best)) best = c;
    return line.find(best) == line.npos ? ' ' : best;
}

bool read_number(std::string_view field, std::optional<double>& number) {
    number.reset();
    field = trim(field);
    if (field.find_first_not_of("-") == field.npos || field == "~") return true;
    number = parse_double(field);
    if (number && std::isfinite(*number)) return true;
    number.reset();
    const std::string word = lower_case(std::string(field));
    return word == "null" || word == "nan" || word == "n/a" || word == "na" || word == "none";
}

bool TextRows::next() {
    if (line_ == 0 && rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
    while (!rest_.empty()) {
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        whole_row_ = rest_.substr(0, end);
        row_ = trim(whole_row_);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        ++line_;
        if (line_ == 1 && (row_.starts_with("\xff\xfe") || row_.starts_with("\xfe\xff")))
            fail("text as UTF-8", "UTF-16");
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

int RowTable::column(std::initializer_list<std::string_view> names) const {
    for (const std::string_view name : names)
        if (const auto found = std::ranges::find(columns_, name, &NamedColumn::name); found != columns_.end())
            return int(found - columns_.begin());
    return none;
}

TextTable::TextTable(std::string_view text) : rows_(text) {
    if (!rows_.next()) return;
    header_ = rows_.text();
    separator_ = separator_of(header_);
    for (const std::string_view name : rows_.fields(separator_)) {
        const std::size_t open = name.find_first_of("[("), close = name.find_last_of(")]");
        const bool has_unit = open != name.npos && open > 0 && close + 1 == name.size() && close > open;
        columns_.push_back({lower_case(std::string(trim(name.substr(0, has_unit ? open : name.size())))),
                            std::string(has_unit ? name.substr(open + 1, close - open - 1) : "")});
    }
}

bool TextTable::next() {
    if (!rows_.next()) return false;
    fields_ = rows_.fields(separator_);
    return true;
}

std::string_view TextTable::field(int column) const {
    const auto index = std::size_t(column);
    return column >= 0 && index < fields_.size() ? fields_[index] : std::string_view();
}

void TextTable::take_units() {
    for (std::size_t i = 0; i < std::min(columns_.size(), fields_.size()); ++i)
        if (fields_[i].find_first_not_of('-') != fields_[i].npos) columns_[i].unit = fields_[i];
}

void TextTable::take_units(std::string_view comments) {
    while (comments.starts_with('#')) {
        const std::string_view line = comments.substr(0, comments.find('\n'));
        const auto said = [&](std::string_view key) {
            const std::size_t at = line.find(key);
            if (at == line.npos) return std::string_view();
            const std::string_view rest = line.substr(at + key.size());
            return trim(rest.substr(0, rest.find_first_of(",}")));
        };
        for (NamedColumn& column : columns_)
            if (lower_case(std::string(said("{name: "))) == column.name) column.unit = said("unit: ");
        comments.remove_prefix(std::min(line.size() + 1, comments.size()));
    }
}

}  // namespace astrosplat
