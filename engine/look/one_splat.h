// The look of single splats of a set by the preview's own arithmetic, for those who need a splat's chances
// rather than its fate. In: a run and an index. Out: what look.glsl makes of it.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "look/kernel.h"

namespace astrosplat {

struct OneSplat {
    bool keep = false;
    float probability = 0.0f;  // of being kept
    glm::vec3 color{0.0f};
    float alpha = 0.0f, radius = 0.0f;
};

/// Under `uniforms`, which need not be the run's own.
OneSplat look_at(const LookRun& run, const LookUniforms& uniforms, std::int64_t i);

}  // namespace astrosplat
