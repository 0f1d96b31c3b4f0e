// Field<T>: how a C++ field of type T is written as a Value and read back, with the checks of its
// ParameterSpec. A new kind of field needs one more specialisation here and nothing elsewhere.
#pragma once

#include <concepts>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>

#include "core/enum_names.h"
#include "scene/parameter.h"

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
std::vector<std::filesystem::path> files_of(const Value& value, const ParameterSpec& spec);
std::vector<glm::vec2> curve_of(const Value& value, const ParameterSpec& spec);
Value choice_value(const std::string& name);  // "true" and "false" as booleans
Value files_value(const std::vector<std::filesystem::path>& files, const ParameterSpec& spec);
Value curve_value(const std::vector<glm::vec2>& points);

inline double widened(double x) { return x; }
inline double widened(float x) { return widen(x); }

template <class T>
struct Field;

/// Fields of one type and one way in.
template <ParameterType kind, auto read>
struct PlainField {
    static void describe(ParameterSpec& spec) { spec.type = kind; }
    static auto set(const Value& value, const ParameterSpec& spec) { return read(value, spec); }
};

template <>
struct Field<bool> : PlainField<ParameterType::boolean, boolean_of> {
    static Value get(bool field, const ParameterSpec&) { return field; }
};

template <std::integral T>
requires(!std::same_as<T, bool>) struct Field<T> {
    static void describe(ParameterSpec& spec) {
        spec.type = ParameterType::integer;
        spec.min = std::max(spec.min, static_cast<double>(std::numeric_limits<T>::min()));
        spec.max = std::min(spec.max, static_cast<double>(std::numeric_limits<T>::max()));
    }
    static Value get(T field, const ParameterSpec&) { return static_cast<std::int64_t>(field); }
    static T set(const Value& value, const ParameterSpec& spec) {
        return static_cast<T>(integer_of(value, spec));
    }
};

template <>
struct Field<double> : PlainField<ParameterType::number, number_of> {
    static Value get(double field, const ParameterSpec&) { return field; }
};

template <>
struct Field<float> : PlainField<ParameterType::number, float_of> {
    static Value get(float field, const ParameterSpec&) { return widen(field); }
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
struct Field<std::vector<std::string>> : PlainField<ParameterType::words, words_of> {
    static Value get(const std::vector<std::string>& field, const ParameterSpec&) {
        return Value::List(field.begin(), field.end());
    }
};

template <>
struct Field<std::filesystem::path> : PlainField<ParameterType::file, text_of> {
    static Value get(const std::filesystem::path& field, const ParameterSpec&) { return field.string(); }
};

template <>
struct Field<std::vector<std::filesystem::path>> : PlainField<ParameterType::files, files_of> {
    static Value get(const std::vector<std::filesystem::path>& field, const ParameterSpec& spec) {
        return files_value(field, spec);
    }
};

template <>
struct Field<std::vector<glm::vec2>> : PlainField<ParameterType::curve, curve_of> {
    static Value get(const std::vector<glm::vec2>& field, const ParameterSpec&) { return curve_value(field); }
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
                list.emplace_back(static_cast<std::int64_t>(field[i]));
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

}  // namespace astrosplat
