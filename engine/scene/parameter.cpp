// Parameter specs: building them, putting their range in words, numbers per component for animation.
#include "scene/parameter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/text.h"

namespace astrosplat {

bool is_numeric(ParameterType type) {
    using Type = ParameterType;
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

namespace {

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

std::string expectation(const ParameterSpec& spec) {
    const std::string or_nothing = spec.nothing.text() ? " or \"" + *spec.nothing.text() + "\"" : "";
    switch (spec.type) {
        case ParameterType::boolean:
            return "true or false";
        case ParameterType::integer:
            return "a whole number" + range_words(spec) + or_nothing;
        case ParameterType::number:
            return "a number" + range_words(spec) + or_nothing;
        case ParameterType::text:
            return spec.choices.empty() ? "a string" + or_nothing : alternatives(spec.choices);
        case ParameterType::choice:
            return alternatives(spec.choices);
        case ParameterType::words:
            return "a list of " + alternatives(spec.choices);
        case ParameterType::file:
            return "a file name";
        case ParameterType::files:
            return "a file name or a list of them";
        case ParameterType::pattern:
            return "a file name with a frame token such as ####";
        case ParameterType::curve:
            return "a list of points [[x, y], ...]";
        default:
            return fmt::format("{} numbers", spec.components) + range_words(spec) + or_nothing;
    }
}

std::vector<double> to_numbers(const ParameterSpec& spec, const Value& value) {
    if (spec.type == ParameterType::choice) {
        const std::string name = value.text() ? *value.text() : to_toml(value);
        const auto found = std::ranges::find(spec.choices, name);
        return {static_cast<double>(found - spec.choices.begin())};
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
        float x = static_cast<float>(numbers[i]);
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
    switch (spec.type) {
        case ParameterType::boolean:
            return first >= 0.5;
        case ParameterType::integer:
            return static_cast<std::int64_t>(std::floor(clamped(first) + 0.5));
        case ParameterType::number:
            return clamped(first);
        case ParameterType::choice: {
            const double last = static_cast<double>(spec.choices.size()) - 1.0;
            return spec.choices[static_cast<std::size_t>(std::clamp(std::floor(first + 0.5), 0.0, last))];
        }
        case ParameterType::curve:
            return curve_from(numbers);
        default: {
            Value::List list;
            for (const double x : numbers) list.emplace_back(clamped(x));
            return list;
        }
    }
}

}  // namespace astrosplat
