// shaders/shared/noise.glsl as C++: astrosplat::shared::as_noise, as_noise_octave and as_fbm. Each
// translation unit gets its own copy with internal linkage, like the maths.
#pragma once

#include "core/shared_maths.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"

namespace astrosplat::shared {
namespace {
#include "noise.glsl"
}
}  // namespace astrosplat::shared

#pragma GCC diagnostic pop
