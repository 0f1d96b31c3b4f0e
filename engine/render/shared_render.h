// The renderer's maths that the preview's shaders share, as C++: projections, falloffs, blending and
// footprints in astrosplat::shared; projections and footprints with doubles in astrosplat::exact.
#pragma once

#include "camera/projection.h"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
namespace astrosplat::shared {
namespace {
#include "blend.glsl"
#include "falloff.glsl"
#include "footprint.glsl"
}  // namespace
}  // namespace astrosplat::shared

namespace astrosplat::exact {
using Int = int;
namespace {
int min(int a, int b) { return b < a ? b : a; }
int max(int a, int b) { return a < b ? b : a; }
double mix(double a, double b, bool take_b) { return take_b ? b : a; }
int floatBitsToInt(double x) { return glsl::floatBitsToInt(static_cast<float>(x)); }
#include "footprint.glsl"
}  // namespace
}  // namespace astrosplat::exact
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
