// Structure for the children of a split splat, so that clouds close by show clouds and not blur (DEPTH 6).
// In: the splat's radius, the level, a child's place. Out: the factor of its light, e^(strength n), n =
// octaves of noise in layer space between the splat's size and the child's.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

namespace astrosplat {

/// Noise for the children of one splat at one level. It depends on nothing but the splat's radius, the level
/// and the layer's seed: a child keeps its light however near the camera is.
struct ChildNoise {
    struct Octave {
        float frequency;  // per scene unit, a power of two: the same field for splats of every size
        float amplitude;  // factor of the noise in the exponent
        glm::vec3 shift;  // of the field, cells
        std::uint32_t seed;
    };
    std::array<Octave, 12> octaves;
    int count = 0;
    float limit = 0.0f;   // of the exponent
    float offset = 0.0f;  // of the exponent: makes the mean over space 1
};

/// `strength` is lod.noise, 0..2; `radius` in layer space, > 0; `level` as in LevelChoice. Level 0 has none.
ChildNoise make_child_noise(float strength, float radius, int level, std::uint32_t seed);

/// Factor of the light of a child at `p` in layer space: > 0, 1 on average over space, and at most
/// largest_child_light.
float child_light(const ChildNoise& noise, const glm::vec3& p);
float largest_child_light(float strength);

}  // namespace astrosplat
