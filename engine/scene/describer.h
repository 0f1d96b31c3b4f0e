// Builds a Description: a place in the tree of keys plus one call per field. Field<T> says how a C++ field of
// type T is written as a Value and read back, with the checks of its ParameterSpec; a new kind of field needs
// one more specialisation here and nothing elsewhere.
#pragma once

#include <fmt/format.h>

#include <concepts>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/text.h"
#include "scene/parameter.h"
#include "scene/scene.h"

namespace astrosplat {

// The checks, without templates. Each throws ValueError.
bool boolean_of(const Value& value, const ParameterSpec& spec);
std::int64_t integer_of(const Value& value, const ParameterSpec& spec);  // whole floats such as 2e6 count
double number_of(const Value& value, const ParameterSpec& spec);         // finite and in range
float float_of(const Value& value, const ParameterSpec& spec);
std::vector<double> numbers_of(const Value& value, const ParameterSpec& spec);  // spec.components of them
std::string text_of(const Value& value, const ParameterSpec& spec);
std::size_t choice_of(const Value& value, const ParameterSpec& spec);  // index into spec.choices
std::vector<std::string> words_of(const Value& value, const ParameterSpec& spec);
std::vector<fs::path> files_of(const Value& value, const ParameterSpec& spec);
std::vector<glm::vec2> curve_of(const Value& value, const ParameterSpec& spec);
Value choice_value(const std::string& name);  // "true" and "false" as booleans
Value files_value(const std::vector<fs::path>& files, const ParameterSpec& spec);
Value curve_value(const std::vector<glm::vec2>& points);
Value words_value(const std::vector<std::string>& words);
Value path_value(const fs::path& file);

inline double widened(double x) { return x; }
inline double widened(float x) { return widen(x); }

template <class T>
struct Field;

/// Fields of one type, read and written by one function each.
template <ParameterType kind, auto read, auto write>
struct PlainField {
    static void describe(ParameterSpec& spec) { spec.type = kind; }
    static Value get(const auto& field, const ParameterSpec&) { return write(field); }
    static auto set(const Value& value, const ParameterSpec& spec) { return read(value, spec); }
};

template <class T>
Value as_value(const T& field) {
    return field;
}

template <>
struct Field<bool> : PlainField<ParameterType::boolean, boolean_of, as_value<bool>> {};
template <>
struct Field<double> : PlainField<ParameterType::number, number_of, as_value<double>> {};
template <>
struct Field<float> : PlainField<ParameterType::number, float_of, widen> {};
template <>
struct Field<fs::path> : PlainField<ParameterType::file, text_of, path_value> {};
template <>
struct Field<std::vector<std::string>> : PlainField<ParameterType::words, words_of, words_value> {};
template <>
struct Field<std::vector<glm::vec2>> : PlainField<ParameterType::curve, curve_of, curve_value> {};

template <std::integral T>
requires(!std::same_as<T, bool>) struct Field<T> {
    static void describe(ParameterSpec& spec) {
        spec.type = ParameterType::integer;
        spec.min = std::max(spec.min, double(std::numeric_limits<T>::min()));
        spec.max = std::min(spec.max, double(std::numeric_limits<T>::max()));
    }
    static Value get(T field, const ParameterSpec&) { return std::int64_t(field); }
    static T set(const Value& value, const ParameterSpec& spec) {
        return static_cast<T>(integer_of(value, spec));
    }
};

template <class T>
requires NamedEnum<T>
struct Field<T> {
    static void describe(ParameterSpec& spec) {
        spec.type = ParameterType::choice;
        spec.choices = all_names<T>();
    }
    static Value get(T field, const ParameterSpec&) { return choice_value(std::string(name_of(field))); }
    static T set(const Value& value, const ParameterSpec& spec) {
        return static_cast<T>(choice_of(value, spec));
    }
};

template <>
struct Field<std::string> {
    static void describe(ParameterSpec& spec) {
        if (spec.type == ParameterType::number) spec.type = ParameterType::text;
    }
    static Value get(const std::string& field, const ParameterSpec&) { return field; }
    static std::string set(const Value& value, const ParameterSpec& spec) { return text_of(value, spec); }
};

template <>
struct Field<std::vector<fs::path>> {
    static void describe(ParameterSpec& spec) { spec.type = ParameterType::files; }
    static Value get(const std::vector<fs::path>& field, const ParameterSpec& spec) {
        return files_value(field, spec);
    }
    static auto set(const Value& value, const ParameterSpec& spec) { return files_of(value, spec); }
};

template <int N, class T>
struct Field<glm::vec<N, T>> {
    using Vector = glm::vec<N, T>;
    static void describe(ParameterSpec& spec) {
        if (spec.type == ParameterType::number) spec.type = ParameterType::vector;
        spec.components = N;
    }
    static Value get(const Vector& field, const ParameterSpec&) {
        Value::List list;
        for (int i = 0; i < N; ++i) {
            if constexpr (std::integral<T>)
                list.emplace_back(std::int64_t(field[i]));
            else
                list.emplace_back(widened(field[i]));
        }
        return list;
    }
    static Vector set(const Value& value, const ParameterSpec& spec) {
        const std::vector<double> numbers = numbers_of(value, spec);
        Vector field;
        for (int i = 0; i < N; ++i) {
            if constexpr (std::integral<T>)
                field[i] = integer_of(numbers[i], spec);
            else if constexpr (std::same_as<T, float>)
                field[i] = float_of(numbers[i], spec);
            else
                field[i] = numbers[i];
        }
        return field;
    }
};

template <class T>
struct Field<std::optional<T>> {
    static void describe(ParameterSpec& spec) { Field<T>::describe(spec); }
    static Value get(const std::optional<T>& field, const ParameterSpec& spec) {
        return field ? Field<T>::get(*field, spec) : spec.nothing;
    }
    static std::optional<T> set(const Value& value, const ParameterSpec& spec) {
        if (value == spec.nothing) return std::nullopt;
        return Field<T>::set(value, spec);
    }
};

/// Traits of a parameter besides its words; each writes itself into the spec.
namespace traits {

template <class T>
auto sets(T ParameterSpec::*member, T value) {
    return [member, value](ParameterSpec& s) { s.*member = value; };
}
/// The numbers allowed.
inline auto at_least(double lo) { return sets(&ParameterSpec::min, lo); }
inline auto within(double lo, double hi) {
    return [lo, hi](ParameterSpec& s) { s.min = lo, s.max = hi; };
}
inline auto below(double hi) {
    return [hi](ParameterSpec& s) { s.max = hi, s.below_max = true; };
}
inline auto slider(double lo, double hi) {
    return [lo, hi](ParameterSpec& s) { s.slider_min = lo, s.slider_max = hi; };
}
/// Both of them.
inline auto range(double lo, double hi) {
    return [lo, hi](ParameterSpec& s) { within(lo, hi)(s), slider(lo, hi)(s); };
}
inline auto logarithmic() { return sets(&ParameterSpec::scale, Scale::logarithmic); }
inline auto as(ParameterType type) { return sets(&ParameterSpec::type, type); }
inline auto components(int count) { return sets(&ParameterSpec::components, count); }
inline auto one_of(std::vector<std::string> names) { return sets(&ParameterSpec::choices, std::move(names)); }
/// How nothing is written.
inline auto or_auto() { return sets(&ParameterSpec::nothing, Value("auto")); }
inline auto or_no_text() { return sets(&ParameterSpec::nothing, Value("")); }
inline auto zero_is(std::string_view words) { return sets(&ParameterSpec::zero, words); }
/// Points that need not ascend.
inline auto in_any_order() { return sets(&ParameterSpec::any_order, true); }
inline auto shown_as(std::string short_label) {
    return sets(&ParameterSpec::row_label, std::move(short_label));
}
/// It does something only with, or never with, one of these values of its neighbour `name`.
inline auto condition(const char* name, std::vector<Value> values, bool wanted) {
    return [=](ParameterSpec& s) { s.conditions.push_back({name, values, wanted}); };
}
inline auto only_with(const char* name, std::vector<Value> values) {
    return condition(name, std::move(values), true);
}
inline auto never_with(const char* name, std::vector<Value> values) {
    return condition(name, std::move(values), false);
}

}  // namespace traits

/// A spec with its words; the describer puts the section before the key.
template <class... Traits>
ParameterSpec spec(const char* key, const char* label, const char* unit, const char* help,
                   const Traits&... traits) {
    ParameterSpec result;
    result.key = key;
    result.label = label;
    result.unit = unit;
    result.help = help;
    (traits(result), ...);
    return result;
}

class Describer {
  public:
    Describer(Description& description, ParameterKey group, bool animated)
        : description_(&description), group_(std::move(group)), animated_(animated) {}

    /// Describes what lies in the group `name` below this one; no name: in this one.
    Describer in(const std::string& name, bool animated) const {
        Describer inner = *this;
        if (!name.empty()) inner.group_ = group_ / name;
        inner.animated_ = animated;
        return inner;
    }

    /// The same place, shown in another section of the window.
    Describer shown_in(std::string_view tab, std::string_view section) const {
        Describer shown = *this;
        shown.tab_ = tab;
        shown.section_ = section;
        return shown;
    }

    /// The same place, where nothing has an effect unless the neighbour `name` has one of these values.
    Describer only_with(const std::string& name, std::vector<Value> values) const {
        return limited({group_ / name, std::move(values), true});
    }

    /// The same place, where nothing has an effect while the neighbour `name` has one of these values.
    Describer never_with(const std::string& name, std::vector<Value> values) const {
        return limited({group_ / name, std::move(values), false});
    }

    /// The same place, where parameters are animated whatever the group says.
    Describer animated() const { return in({}, true); }

    /// The same place, where no parameter is.
    Describer still() const { return in({}, false); }

    /// Describes one field, by its words and traits as in spec(). Its type follows from the field, unless a
    /// trait says more (color, position, ...).
    template <class T, class... Traits>
    void operator()(T& field, const char* key, const char* label, const char* unit, const char* help,
                    const Traits&... traits) const {
        describe_field(field, spec(key, label, unit, help, traits...));
    }

    /// A parameter that is not one field: with its own way in and out; the spec names its type.
    void custom(ParameterSpec field_spec, std::function<Value(const ParameterSpec&)> get,
                std::function<void(const Value&, const ParameterSpec&)> set) const;

    /// A list of tables, each element described by `describe_element(describer, element)`.
    template <class T, class DescribeElement>
    void list(const std::string& key, std::vector<T>& elements, DescribeElement describe_element) const {
        std::vector<T>* const list = &elements;
        const ParameterKey place = group_ / key;
        description_->lists.push_back({place, place.generic(), [list] { return list->size(); },
                                       [list](std::size_t size) { list->resize(size); }});
        for (std::size_t i = 0; i < elements.size(); ++i)
            describe_element(in(fmt::format("{}.{}", key, i), animated_), elements[i]);
    }

  private:
    // Compiled once for a type, not for every set of words and traits.
    template <class T>
    void describe_field(T& field, ParameterSpec field_spec) const {
        Field<T>::describe(field_spec);
        T* const target = &field;
        custom(
            std::move(field_spec), [target](const ParameterSpec& own) { return Field<T>::get(*target, own); },
            [target](const Value& value, const ParameterSpec& own) { *target = Field<T>::set(value, own); });
    }

    Describer limited(Condition condition) const {
        Describer result = *this;
        result.conditions_.push_back(std::move(condition));
        return result;
    }

    Description* description_;
    ParameterKey group_;
    std::string_view tab_, section_;  // literals
    std::vector<Condition> conditions_;
    bool animated_;
};

}  // namespace astrosplat
