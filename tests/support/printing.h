// How parameters of tests are written in their names and messages, for types that do not print themselves.
#pragma once

#include <glm/vec3.hpp>
#include <ostream>

#include "core/text.h"

namespace glm {

inline void PrintTo(const dvec3& v, std::ostream* out) { *out << v.x << " " << v.y << " " << v.z; }

}  // namespace glm

namespace astrosplat {

template <NamedEnum E>
void PrintTo(const E& value, std::ostream* out) {
    *out << name_of(value);
}

}  // namespace astrosplat
