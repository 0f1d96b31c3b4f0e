// The look of single splats of a set by the preview's own arithmetic, for those who need a splat's chances
// rather than its fate. In: a run and an index. Out: what look.glsl makes of it.
#pragma once

#include <cstdint>

#include "look/kernel.h"
#include "look/shared_look.h"

namespace astrosplat {

/// Under `uniforms`, which need not be the run's own.
shared::LookOutput look_at(const LookRun& run, const LookUniforms& uniforms, std::int64_t i);

}  // namespace astrosplat
