// shaders/shared/lens.glsl as C++: a camera's projection with floats (Lens), as splats are projected, and
// with doubles (ExactLens), as rays are. External linkage, so that kernels for several instruction sets
// share them.
#pragma once

#include "core/shared_maths.h"

namespace astrosplat::shared_types {
using Real = float;
#include "lens.glsl"
}  // namespace astrosplat::shared_types

namespace astrosplat::exact_types {
using Real = double;
#include "lens.glsl"
}  // namespace astrosplat::exact_types

namespace astrosplat {
using shared_types::Lens;
using ExactLens = exact_types::Lens;
}  // namespace astrosplat
