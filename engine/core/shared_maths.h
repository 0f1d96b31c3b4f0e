// shaders/shared/maths.glsl as C++: astrosplat::shared::as_exp, as_log, as_pow, as_hash, as_uniform and the
// purposes. GLSL has no "inline", so each translation unit gets its own copy with internal linkage.
#pragma once

#include "core/glsl.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"

namespace astrosplat::shared {
using namespace astrosplat::glsl;
namespace {
#include "maths.glsl"
}
}  // namespace astrosplat::shared

#pragma GCC diagnostic pop
