// The checks behind Field<T>: a Value either fits a parameter or is refused with what was expected and found.
#include "scene/describer.h"

namespace astrosplat {
namespace {

[[noreturn]] void refuse(const std::string& expected, const std::string& found) {
    throw ValueError(fmt::format("expected {}, found {}", expected, found));
}

bool in_range(double x, const ParameterSpec& spec) {
    return x >= spec.min && (spec.below_max ? x < spec.max : x <= spec.max);
}

const Value::List& list_of(const Value& value, const ParameterSpec& spec) {
    if (!value.list()) refuse(expectation(spec), kind_of(value));
    return *value.list();
}

}  // namespace

bool boolean_of(const Value& value, const ParameterSpec&) {
    if (const auto* b = std::get_if<bool>(&value.data)) return *b;
    refuse("true or false", kind_of(value));
}

double number_of(const Value& value, const ParameterSpec& spec) {
    if (!value.is_number()) {
        const bool plain = spec.type == ParameterType::number && !spec.nothing.text();
        refuse(plain ? "a number" : expectation(spec), kind_of(value));
    }
    const double x = value.number();
    if (!std::isfinite(x)) refuse("a finite number", std::isnan(x) ? "nan" : "inf");
    if (in_range(x, spec)) return x;
    const bool beyond_all = x > largest_number ? spec.max == largest_number : spec.min == -largest_number;
    refuse(expectation(spec) + (beyond_all && std::fabs(x) > largest_number
                                    ? fmt::format(" within {:g} of 0", largest_number)
                                    : ""),
           short_number(x));
}

float float_of(const Value& value, const ParameterSpec& spec) {
    const double x = number_of(value, spec);
    const float narrow = float(x);
    if (!in_range(double(narrow), spec) && x != spec.min && x != spec.max)
        refuse(expectation(spec), short_number(x));  // 1 - 1e-12 is below 1 but becomes 1
    return narrow;
}

std::int64_t integer_of(const Value& value, const ParameterSpec& spec) {
    if (!value.is_number())
        refuse(spec.nothing.text() ? expectation(spec) : "a whole number", kind_of(value));
    const double x = value.number();
    if (!std::isfinite(x) || x != std::floor(x)) refuse("a whole number", short_number(x));
    if (!in_range(x, spec)) refuse(expectation(spec), short_number(x));
    if (const auto* exact = std::get_if<std::int64_t>(&value.data)) return *exact;
    if (std::fabs(x) >= 9.2e18) refuse("a whole number of 64 bits", short_number(x));
    return std::int64_t(x);
}

std::vector<double> numbers_of(const Value& value, const ParameterSpec& spec) {
    const Value::List& list = list_of(value, spec);
    if (list.size() != std::size_t(spec.components)) refuse(expectation(spec), kind_of(value));
    std::vector<double> numbers;
    for (const Value& element : list) {
        if (!element.is_number()) refuse(expectation(spec), kind_of(element) + " among them");
        numbers.push_back(number_of(element, spec));
    }
    return numbers;
}

std::string text_of(const Value& value, const ParameterSpec& spec) {
    if (!value.text()) refuse(expectation(spec), kind_of(value));
    if (spec.type == ParameterType::text && !spec.choices.empty()) choice_of(value, spec);
    if (value.text()->find('\0') != std::string::npos) refuse(expectation(spec), "a zero byte");
    return *value.text();
}

std::size_t choice_of(const Value& value, const ParameterSpec& spec) {
    const bool scalar = value.data.index() <= 1 || value.text();  // depth = 16 and unpremultiply = true count
    if (!scalar) refuse(expectation(spec), kind_of(value));
    const std::string name = value.text() ? *value.text() : to_toml(value);
    const auto found = std::ranges::find(spec.choices, name);
    if (found == spec.choices.end())
        refuse(expectation(spec), fmt::format("'{}'{}", name, did_you_mean(name, spec.choices)));
    return std::size_t(found - spec.choices.begin());
}

std::vector<std::string> words_of(const Value& value, const ParameterSpec& spec) {
    std::vector<std::string> words;
    for (const Value& element : list_of(value, spec)) {
        words.push_back(spec.choices[choice_of(element, spec)]);
        if (std::ranges::count(words, words.back()) > 1)
            refuse(expectation(spec), fmt::format("'{}' twice", words.back()));
    }
    return words;
}

std::vector<fs::path> files_of(const Value& value, const ParameterSpec& spec) {
    if (value.text()) {
        if (value.text()->empty()) return {};
        return {text_of(value, spec)};
    }
    std::vector<fs::path> files;
    for (const Value& element : list_of(value, spec)) {
        files.emplace_back(text_of(element, spec));
        if (files.back().empty()) refuse(expectation(spec), "an empty file name");
    }
    return files;
}

std::vector<glm::vec2> curve_of(const Value& value, const ParameterSpec& spec) {
    ParameterSpec coordinate = spec;
    coordinate.components = 2;
    std::vector<glm::vec2> points;
    for (const Value& element : list_of(value, spec)) {
        if (!element.list() || element.list()->size() != 2) refuse(expectation(spec), kind_of(element));
        points.push_back(Field<glm::vec2>::set(element, coordinate));
        if (!spec.any_order && points.size() > 1 && points.back().x <= points[points.size() - 2].x)
            refuse("points with ascending x", short_number(widen(points.back().x)) + " after " +
                                                  short_number(widen(points[points.size() - 2].x)));
    }
    if (points.size() == 1) refuse("at least 2 points", "1");
    return points;
}

Value choice_value(const std::string& name) {
    if (name == "true" || name == "false") return name == "true";
    return name;
}

Value words_value(const std::vector<std::string>& words) { return Value::List(words.begin(), words.end()); }

Value path_value(const fs::path& file) { return file.string(); }

Value files_value(const std::vector<fs::path>& files, const ParameterSpec& spec) {
    if (files.empty()) return spec.nothing;
    if (files.size() == 1) return files[0].string();
    Value::List list;
    for (const fs::path& file : files) list.emplace_back(file.string());
    return list;
}

Value curve_value(const std::vector<glm::vec2>& points) {
    Value::List list;
    for (const glm::vec2& point : points) list.emplace_back(Value::List{widen(point.x), widen(point.y)});
    return list;
}

}  // namespace astrosplat
