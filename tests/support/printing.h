// How parameters of tests are written in their names and messages, for types that do not print themselves.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <ostream>

#include "render/layer_render.h"

namespace glm {

inline void PrintTo(const dvec3& v, std::ostream* out) { *out << v.x << " " << v.y << " " << v.z; }

}  // namespace glm

namespace astrosplat {

inline void PrintTo(Falloff::Shape shape, std::ostream* out) {
    *out << std::array{"constant", "linear", "trapezoid", "gaussian", "exponential"}.at(
        static_cast<std::size_t>(shape));
}

inline void PrintTo(Blend blend, std::ostream* out) {
    *out << std::array{"over", "add", "screen", "lighten", "hybrid"}.at(static_cast<std::size_t>(blend));
}

}  // namespace astrosplat
