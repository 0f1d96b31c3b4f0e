// The renderer's maths that a card's programs share, as C++: projections, falloffs, blending, level of detail
// and footprints in astrosplat::shared; projections and footprints with doubles in astrosplat::exact.
#pragma once

#include "camera/projection.h"
#include "render/frame.h"
#include "render/lod.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
namespace astrosplat::shared {
namespace {
#include "blend.glsl"
#include "falloff.glsl"
#include "footprint.glsl"
// before what needs it
#include "children.glsl"
// The tables of a falloff with the functions that read them.
struct ChildTables {
    const float *child_radius, *child_fading;
    const double* child_steady;
    explicit ChildTables(const LodTable::Numbers& numbers)
        : child_radius(numbers.radius.data()),
          child_fading(numbers.fading.data()),
          child_steady(numbers.steady.data()) {}
    static vec2 on_circle(float turns) { return real::on_circle(turns); }
#include "child_tables.glsl"
};
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
