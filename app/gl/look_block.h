// LookUniforms as the shaders' uniform block holds it.
#pragma once

#include <compare>
#include <cstddef>
#include <vector>

#include "look/shared_uniforms.h"

namespace astrosplat {

/// Sizes of the arrays in a shader that is made for the look at hand; as the shared files have them
/// by default.
struct LookLimits {
    int keys = shared_types::LOOK_MAX_KEYS;
    int noises = shared_types::LOOK_MAX_NOISES;
    int points = shared_types::LOOK_MAX_POINTS;
    int octaves = 16;  // of a noise
    auto operator<=>(const LookLimits&) const = default;
};

/// Small limits that hold this look, of few different ones, since each is a program to be compiled.
LookLimits limits_for(const LookUniforms& look);

/// The bytes of "layout(std140) uniform LookBlock { LookUniforms look; }" (OpenGL 4.1 specification, 2.11.4).
std::vector<std::byte> look_block(const LookUniforms& look, const LookLimits& limits = {});

}  // namespace astrosplat
