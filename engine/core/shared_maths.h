// shaders/shared as C++: GLSL's names, so that its files compile here as in a shader, and of these files
// maths.glsl and noise.glsl as astrosplat::shared::as_exp, as_log, as_pow, as_hash, as_noise and so on. GLSL
// has no "inline": each translation unit gets its own copy. Others include the shared files inside a
// namespace that says `using namespace astrosplat::glsl;`.
#pragma once

#include <cstring>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/standard.h"

namespace astrosplat::glsl {

using glm::ivec2;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;
// These may be vectors of lanes: core/lanes-inl.h.
using Float = float;
using Int = int;
using Bool = bool;
using Vec3 = vec3;

inline float intBitsToFloat(int bits) {
    float f;
    std::memcpy(&f, &bits, sizeof f);
    return f;
}
inline int floatBitsToInt(float f) {
    int bits;
    std::memcpy(&bits, &f, sizeof bits);
    return bits;
}
/// Division has a name, for drivers whose own has other bits.
inline float as_div(float a, float b) { return a / b; }
inline float floor(float x) { return std::floor(x); }
inline float sqrt(float x) { return std::sqrt(x); }
inline float abs(float x) { return std::fabs(x); }
inline float min(float a, float b) { return b < a ? b : a; }
inline float max(float a, float b) { return a < b ? b : a; }
inline int min(int a, int b) { return b < a ? b : a; }
inline int max(int a, int b) { return a < b ? b : a; }
inline float clamp(float x, float lo, float hi) { return min(max(x, lo), hi); }
inline float mix(float a, float b, float t) { return a * (1.0f - t) + b * t; }
inline float mix(float a, float b, bool take_b) { return take_b ? b : a; }
inline vec3 mix(vec3 a, vec3 b, float t) { return a * (1.0f - t) + b * t; }
inline float dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

}  // namespace astrosplat::glsl

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"

namespace astrosplat::shared {
using namespace astrosplat::glsl;
namespace {
#include "maths.glsl"
// before what needs it
#include "noise.glsl"
// Of a splat's id, which has 64 bits.
uint as_hash_of_id(uint seed, std::uint64_t id, uint purpose) {
    return as_hash(seed, static_cast<uint>(id), static_cast<uint>(id >> 32), purpose);
}
}  // namespace
}  // namespace astrosplat::shared

#pragma GCC diagnostic pop
