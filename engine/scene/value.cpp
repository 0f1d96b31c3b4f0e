// Values to text. Numbers go through fmt and from_chars, which know no locale.
#include "scene/value.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace astrosplat {

double Value::number() const {
    if (const auto* i = std::get_if<std::int64_t>(&data)) return static_cast<double>(*i);
    return std::get<double>(data);
}

bool operator==(const Value& a, const Value& b) { return a.data == b.data; }

std::string short_number(double number) {
    return fmt::format("{}", number == std::trunc(number) && std::fabs(number) < 1e15
                                 ? fmt::format("{:.0f}", number)
                                 : fmt::format("{}", number));
}

double widen(float number) {
    const std::string text = fmt::format("{}", number);
    double wide = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), wide);
    return wide;
}

std::string to_toml(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            quoted += {'\\', c};
        } else if (c == '\n') {
            quoted += "\\n";
        } else if (c == '\t') {
            quoted += "\\t";
        } else if ((c >= 0 && c < 0x20) || c == 0x7f) {
            quoted += fmt::format("\\u{:04X}", static_cast<int>(c));
        } else {
            quoted += c;
        }
    }
    return quoted + '"';
}

namespace {

std::string number_to_toml(double number) {
    std::string text = fmt::format("{}", number);
    if (text.find_first_of(".en") == std::string::npos) text += ".0";  // 24 would be an integer
    return text;
}

std::string list_to_toml(const Value::List& list) {
    std::string text = "[";
    for (const Value& element : list) text += (text.size() > 1 ? ", " : "") + to_toml(element);
    return text + "]";
}

}  // namespace

std::string to_toml(const Value& value) {
    if (const auto* b = std::get_if<bool>(&value.data)) return *b ? "true" : "false";
    if (const auto* i = std::get_if<std::int64_t>(&value.data)) return fmt::format("{}", *i);
    if (const auto* d = std::get_if<double>(&value.data)) return number_to_toml(*d);
    if (const auto* text = value.text()) return to_toml(*text);
    return list_to_toml(*value.list());
}

std::string kind_of(const Value& value) {
    if (std::holds_alternative<bool>(value.data)) return std::get<bool>(value.data) ? "true" : "false";
    if (value.is_number()) return "a number";
    if (value.text()) return "a string";
    return fmt::format("a list of {}", value.list()->size());
}

}  // namespace astrosplat
