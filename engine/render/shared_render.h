// The renderer's maths that the preview's shaders share: falloffs and blending, as C++.
#pragma once

#include "core/shared_maths.h"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
namespace astrosplat::shared {
namespace {
#include "falloff.glsl"

#include "blend.glsl"
}  // namespace
}  // namespace astrosplat::shared
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
