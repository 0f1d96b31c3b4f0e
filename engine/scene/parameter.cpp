// Values to text (by fmt and from_chars, which know no locale), a parameter's range in words, numbers per
// component for animation, and paths.
#include "scene/parameter.h"

#include <fmt/format.h>

#include <charconv>

namespace astrosplat {

double Value::number() const {
    if (const auto* i = std::get_if<std::int64_t>(&data)) return double(*i);
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
            quoted += fmt::format("\\u{:04X}", int(c));
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

std::string range_words(const ParameterSpec& spec) {
    // The limits of all numbers are not repeated with each.
    const bool low = spec.min != -largest_number, high = spec.max != largest_number;
    if (low && high && !spec.below_max)
        return fmt::format(" from {} to {}", short_number(spec.min), short_number(spec.max));
    std::string words;
    if (low) words += fmt::format(" of at least {}", short_number(spec.min));
    if (low && high) words += " and";
    if (high) words += fmt::format(" {} {}", spec.below_max ? "below" : "of at most", short_number(spec.max));
    return words;
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

using Type = ParameterType;

bool is_numeric(Type type) {
    return type == Type::integer || type == Type::number || type == Type::vector || type == Type::position ||
           type == Type::color || type == Type::rotation || type == Type::curve;
}

bool has_effect(const ParameterSpec& spec, const std::function<const Parameter*(const ParameterKey&)>& find) {
    return std::ranges::all_of(spec.conditions, [&](const Condition& condition) {
        const Parameter* other = find(condition.key);
        if (!other) return true;
        const auto& values = condition.values;
        const bool met = std::ranges::find(values, other->get()) != values.end();
        return met == condition.wanted;
    });
}

std::string expectation(const ParameterSpec& spec) {
    const std::string or_nothing = spec.nothing.text() ? " or \"" + *spec.nothing.text() + "\"" : "";
    const std::string in_range = range_words(spec) + or_nothing, choices = alternatives(spec.choices);
    if (spec.type == Type::boolean) return "true or false";
    if (spec.type == Type::integer) return "a whole number" + in_range;
    if (spec.type == Type::number) return "a number" + in_range;
    if (spec.type == Type::text && spec.choices.empty()) return "a string" + or_nothing;
    if (spec.type == Type::text || spec.type == Type::choice) return choices;
    if (spec.type == Type::words) return "a list of " + choices;
    if (spec.type == Type::file) return "a file name";
    if (spec.type == Type::files) return "a file name or a list of them";
    if (spec.type == Type::pattern) return "a file name with a frame token such as ####";
    if (spec.type == Type::curve) return "a list of points [[x, y], ...]";
    return fmt::format("{} numbers", spec.components) + in_range;
}

std::vector<double> to_numbers(const ParameterSpec& spec, const Value& value) {
    if (spec.type == Type::choice) {
        const std::string name = value.text() ? *value.text() : to_toml(value);
        const auto found = std::ranges::find(spec.choices, name);
        return {double(found - spec.choices.begin())};
    }
    if (const auto* b = std::get_if<bool>(&value.data)) return {*b ? 1.0 : 0.0};
    if (value.is_number()) return {value.number()};
    std::vector<double> numbers;
    if (const auto* list = value.list()) {
        for (const Value& element : *list) {
            const std::vector<double> inner = to_numbers(spec, element);
            numbers.insert(numbers.end(), inner.begin(), inner.end());
        }
    }
    return numbers;
}

static Value curve_from(const std::vector<double>& numbers) {
    Value::List points;
    float last = 0.0f;
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
        float x = float(numbers[i]);
        // Points that move at different speeds may touch; the curve needs ascending x.
        if (i > 0 && x <= last) x = std::nextafter(last, std::numeric_limits<float>::infinity());
        last = x;
        points.push_back(Value::List{widen(x), numbers[i + 1]});
    }
    return points;
}

Value from_numbers(const ParameterSpec& spec, const std::vector<double>& numbers) {
    const double first = numbers.empty() ? 0.0 : numbers[0];
    const auto clamped = [&](double x) {
        const double hi = spec.below_max ? std::nextafter(spec.max, spec.min) : spec.max;
        return std::clamp(x, spec.min, hi);
    };
    if (spec.type == Type::boolean) return first >= 0.5;
    if (spec.type == Type::integer) return std::int64_t(std::floor(clamped(first) + 0.5));
    if (spec.type == Type::number) return clamped(first);
    if (spec.type == Type::curve) return curve_from(numbers);
    if (spec.type == Type::choice) {
        const double last = double(spec.choices.size()) - 1.0;
        return spec.choices[std::size_t(std::clamp(std::floor(first + 0.5), 0.0, last))];
    }
    Value::List list;
    for (const double x : numbers) list.emplace_back(clamped(x));
    return list;
}

// Paths are handled as text: no file needs to exist.

namespace {

/// `text` with every ${NAME} replaced. Throws ValueError for an undefined variable or a missing brace.
std::string expand_environment(const std::string& text) {
    std::string expanded;
    std::size_t from = 0;
    for (;;) {
        const std::size_t open = text.find("${", from);
        if (open == std::string::npos) return expanded + text.substr(from);
        const std::size_t close = text.find('}', open);
        if (close == std::string::npos) throw ValueError("expected '}' after '${', found none");
        const std::string name = text.substr(open + 2, close - open - 2);
        const char* value = std::getenv(name.c_str());
        if (!value)
            throw ValueError(
                fmt::format("expected the environment variable {} to be set, found it undefined", name));
        expanded += text.substr(from, open - from) + value;
        from = close + 1;
    }
}

bool stands_for_itself(const std::string& text, const ParameterSpec& spec) {
    return text.empty() || std::ranges::find(spec.choices, text) != spec.choices.end();
}

std::string resolve(const std::string& text, const ParameterSpec& spec, const fs::path& folder) {
    if (stands_for_itself(text, spec)) return text;
    const std::string path = (folder / expand_environment(text)).lexically_normal().string();
    return stands_for_itself(path, spec) ? "./" + path : path;  // a file that is called "plane"
}

std::string unresolve(const std::string& text, const ParameterSpec& spec, const fs::path& folder) {
    if (stands_for_itself(text, spec)) return text;
    const fs::path path(text), base = folder.lexically_normal();
    std::string written = text;
    if (path.is_absolute() == base.is_absolute()) {
        const fs::path relative = path.lexically_relative(base.empty() ? "." : base);
        const bool below = !relative.empty() && *relative.begin() != "..";
        if (!relative.empty() && (below || !path.is_absolute())) written = relative.string();
    }
    if (stands_for_itself(written, spec)) written = "./" + written;
    const bool lost = path.is_relative() && resolve(written, spec, folder) != text;
    return lost ? fs::absolute(path).lexically_normal().string() : written;
}

template <class Change>
Value changed(const Value& value, Change change) {
    if (const auto* text = value.text()) return change(*text);
    if (const auto* list = value.list()) {
        Value::List result;
        for (const Value& element : *list) result.push_back(changed(element, change));
        return result;
    }
    return value;
}

}  // namespace

Value resolve_paths(const Value& value, const ParameterSpec& spec, const fs::path& folder,
                    bool absolute_patterns) {
    const bool file = spec.type == Type::file || spec.type == Type::files;
    if (file) return changed(value, [&](const std::string& text) { return resolve(text, spec, folder); });
    if (spec.type != Type::pattern) return value;
    return changed(value, [&](const std::string& text) {
        const std::string pattern = expand_environment(text);
        return absolute_patterns && !pattern.empty() ? fs::absolute(folder / pattern).string() : pattern;
    });
}

Value unresolve_paths(const Value& value, const ParameterSpec& spec, const fs::path& folder) {
    const bool file = spec.type == Type::file || spec.type == Type::files;
    if (!file) return value;
    return changed(value, [&](const std::string& text) { return unresolve(text, spec, folder); });
}

}  // namespace astrosplat
