// A parameter's value as a scene file writes it: what TOML can say, without the tables. The description
// (describe.h) converts fields of the scene to Values and back; load, save, --set, animation and the window
// speak only Values.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace astrosplat {

struct Value {
    using List = std::vector<Value>;
    std::variant<bool, std::int64_t, double, std::string, List> data;

    Value() : data(List{}) {}
    Value(bool b) : data(b) {}
    Value(std::int64_t i) : data(i) {}
    Value(double d) : data(d) {}
    Value(const char* text) : data(std::string(text)) {}
    Value(std::string text) : data(std::move(text)) {}
    Value(List list) : data(std::move(list)) {}

    const std::string* text() const { return std::get_if<std::string>(&data); }
    const List* list() const { return std::get_if<List>(&data); }
    bool is_number() const { return data.index() == 1 || data.index() == 2; }
    double number() const;  // of an integer or a number
};
bool operator==(const Value& a, const Value& b);

/// TOML text: numbers shortest round-trip and with a point, strings quoted and escaped, lists in brackets.
std::string to_toml(const Value& value);
std::string to_toml(const std::string& text);

/// A value as written, for messages: "a number", "the text 'abc'", "a list of 2".
std::string kind_of(const Value& value);

/// Shortest text that reads back as `number`; "12" for whole numbers.
std::string short_number(double number);

/// A float as the double with the same shortest decimal text: 0.35f becomes 0.35, not 0.3499999940395355.
double widen(float number);

}  // namespace astrosplat
