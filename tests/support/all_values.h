// All values of an enum that has names, in order: a test over them needs no hand when one is added.
#pragma once

#include "core/text.h"

namespace astrosplat::test {

template <NamedEnum E>
inline constexpr auto all_values = [] {
    std::array<E, names_of(E{}).size()> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = E(i);
    return values;
}();

}  // namespace astrosplat::test
