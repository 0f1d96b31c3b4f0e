// The renderer's maths that a card's programs share, as C++: projections, falloffs, blending and
// footprints in astrosplat::shared; projections and footprints with doubles in astrosplat::exact.
#pragma once

#include "camera/projection.h"
#include "render/frame.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
namespace astrosplat::shared {
namespace {
#include "blend.glsl"
#include "falloff.glsl"
#include "footprint.glsl"
}  // namespace
static_assert(numbered_as<Falloff::Shape>(FALLOFF_CONSTANT, FALLOFF_LINEAR, FALLOFF_TRAPEZOID,
                                          FALLOFF_GAUSSIAN, FALLOFF_EXPONENTIAL));
static_assert(numbered_as<Blend>(BLEND_OVER, BLEND_ADD, BLEND_SCREEN, BLEND_LIGHTEN, BLEND_HYBRID,
                                 BLEND_ABSORB));
}  // namespace astrosplat::shared

namespace astrosplat::exact {
using Int = int;
namespace {
int min(int a, int b) { return b < a ? b : a; }
int max(int a, int b) { return a < b ? b : a; }
int floatBitsToInt(double x) { return glsl::floatBitsToInt(float(x)); }
#include "footprint.glsl"
}  // namespace
}  // namespace astrosplat::exact
#pragma GCC diagnostic pop
