// Enums carry their names: beside each enum whose values people write or read stands one function with the
// names in order, found by argument lookup (in a struct it is a friend):
//
//     enum class Shape { constant, linear };
//     friend constexpr auto names_of(Shape) { return names_up_to<Shape::linear>("constant", "linear"); }
//
// Scene files, the manual, the window and messages all read these.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace astrosplat {

/// The names of all values up to `last`, which are numbered from 0 without gaps.
template <auto last, class... Names>
constexpr std::array<std::string_view, sizeof...(Names)> names_up_to(Names... names) {
    static_assert(sizeof...(Names) == static_cast<std::size_t>(last) + 1, "one name for every value");
    return {std::string_view(names)...};
}

template <class E>
concept NamedEnum = std::is_enum_v<E> && requires(E value) {
    names_of(value);
};

template <NamedEnum E>
constexpr std::string_view name_of(E value) {
    return names_of(value)[static_cast<std::size_t>(value)];
}

/// Whether the values are numbered as the constants of a shader, all of them.
template <NamedEnum E, class... Numbers>
constexpr bool numbered_as(Numbers... numbers) {
    int value = 0;
    return ((numbers == value++) && ...) && sizeof...(Numbers) == names_of(E{}).size();
}

/// All names, in order.
template <NamedEnum E>
std::vector<std::string> all_names() {
    constexpr auto names = names_of(E{});
    return {names.begin(), names.end()};
}

}  // namespace astrosplat
