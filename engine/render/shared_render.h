// The renderer's maths that the preview's shaders share, as C++: projections, falloffs, blending and
// footprints in astrosplat::shared; projections and footprints with doubles in astrosplat::exact.
#pragma once

#include "camera/projection.h"
#include "render/layer_render.h"

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
static_assert(static_cast<int>(Falloff::Shape::constant) == FALLOFF_CONSTANT);
static_assert(static_cast<int>(Falloff::Shape::linear) == FALLOFF_LINEAR);
static_assert(static_cast<int>(Falloff::Shape::trapezoid) == FALLOFF_TRAPEZOID);
static_assert(static_cast<int>(Falloff::Shape::gaussian) == FALLOFF_GAUSSIAN);
static_assert(static_cast<int>(Falloff::Shape::exponential) == FALLOFF_EXPONENTIAL);
static_assert(static_cast<int>(Blend::over) == BLEND_OVER);
static_assert(static_cast<int>(Blend::add) == BLEND_ADD);
static_assert(static_cast<int>(Blend::screen) == BLEND_SCREEN);
static_assert(static_cast<int>(Blend::lighten) == BLEND_LIGHTEN);
static_assert(static_cast<int>(Blend::hybrid) == BLEND_HYBRID);
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
