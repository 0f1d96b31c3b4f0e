// Filtered lookup in a texture. In: a place on it. Out: straight colour and alpha.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "source/texture.h"

namespace astrosplat {

/// Straight colour and alpha at one place of a picture.
struct TextureSample {
    glm::vec3 color;  // linear, straight; 0 where alpha is 0
    float alpha;      // 0..1
};

/// Filtered lookup at uv (v = 0 is the bottom row). `box_texels` is the side, in texels along u and v, of the
/// box averaged by Filter::area; the other filters ignore it. Alpha of exactly 0 comes back as exactly 0.
TextureSample sample(const Texture& texture, glm::vec2 uv, glm::vec2 box_texels = glm::vec2(0.0f));

}  // namespace astrosplat
