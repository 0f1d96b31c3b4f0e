// The projections of shaders/shared as C++: astrosplat::shared with floats, astrosplat::exact with doubles.
// Each translation unit gets its own copy with internal linkage.
#pragma once

#include "camera/lens.h"
#include "core/real.h"
#include "core/shared_maths.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"

namespace astrosplat::shared {
using namespace astrosplat::shared_types;
namespace {
#include "angles.glsl"
// before what needs it
#include "projections.inc"
}  // namespace
}  // namespace astrosplat::shared

namespace astrosplat::exact {
using namespace astrosplat::exact_types;
using exact_types::Lens, exact_types::Real;  // not those of floats
using Float = double;
using Bool = bool;
using Vec3 = glm::dvec3;
namespace {
double sqrt(double x) { return std::sqrt(x); }
double abs(double x) { return std::fabs(x); }
double floor(double x) { return std::floor(x); }
double as_div(double a, double b) { return a / b; }
double min(double a, double b) { return b < a ? b : a; }
double max(double a, double b) { return a < b ? b : a; }
double mix(double a, double b, bool take_b) { return take_b ? b : a; }
double angle_of(double y, double x) { return real::atan2(y, x); }
double sine_of(double angle) { return real::sin(angle); }
double cosine_of(double angle) { return real::cos(angle); }
double dot(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
#include "projections.inc"
}  // namespace
}  // namespace astrosplat::exact

#pragma GCC diagnostic pop
