// LookUniforms as the shaders' uniform block holds it.
#pragma once

#include <cstddef>
#include <vector>

#include "look/shared_uniforms.h"

namespace astrosplat {

/// The bytes of "layout(std140) uniform LookBlock { LookUniforms look; }" (OpenGL 4.1 specification, 2.11.4).
std::vector<std::byte> look_block(const LookUniforms& look);

}  // namespace astrosplat
