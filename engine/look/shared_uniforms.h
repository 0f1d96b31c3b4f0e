// shaders/shared/look_uniforms.glsl as C++. The types have a namespace of their own and external linkage, so
// that kernels compiled for several instruction sets share them.
#pragma once

#include "core/glsl.h"

namespace astrosplat::shared_types {
using namespace astrosplat::glsl;
#include "look_uniforms.glsl"
}  // namespace astrosplat::shared_types

namespace astrosplat {
using shared_types::LookCurve;
using shared_types::LookProfile;
using shared_types::LookUniforms;
}  // namespace astrosplat
