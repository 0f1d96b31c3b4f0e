// shaders/shared/look.glsl as C++, in astrosplat::shared like the maths: the look of one splat as a card
// computes it. Each translation unit gets its own copy with internal linkage.
#pragma once

#include "core/shared_maths.h"
#include "look/shared_uniforms.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // weights beyond stop_count, which nothing reads

namespace astrosplat::shared {
using namespace astrosplat::shared_types;
namespace {
#include "look.glsl"
}  // namespace
}  // namespace astrosplat::shared

#pragma GCC diagnostic pop
