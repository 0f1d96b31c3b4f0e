// Gradient noise on hashed lattices, in the manner of Perlin's "Improving Noise" (2002), and its fractal
// sums.
#include "noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/real.h"
#include "core/shared_maths.h"

namespace astrosplat::assets {
namespace {

float fade(float t) { return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f); }

float lerp(float a, float b, float t) { return a + (b - a) * t; }

std::uint32_t lattice_hash(std::uint32_t seed, int i, int j, int k) {
    return shared::as_hash(seed, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j),
                           static_cast<std::uint32_t>(k));
}

// Dot product of the offset with one of sixteen directions (2-D) or of the twelve edges of a cube (3-D).
float corner(std::uint32_t seed, int i, int j, float x, float y) {
    static constexpr std::array<float, 8> c = {1.0f, 0.92388f,  0.70711f,  0.38268f,
                                               0.0f, -0.38268f, -0.70711f, -0.92388f};
    const std::uint32_t h = lattice_hash(seed, i, j, 0) & 15u;
    const float cosine = h < 8 ? c[h] : -c[h - 8];
    const std::uint32_t s = (h + 12u) & 15u;
    const float sine = s < 8 ? c[s] : -c[s - 8];
    return cosine * x + sine * y;
}

float corner(std::uint32_t seed, int i, int j, int k, float x, float y, float z) {
    const std::uint32_t h = lattice_hash(seed, i, j, k) & 15u;
    const float u = h < 8 ? x : y;
    const float v = h < 4 ? y : (h == 12 || h == 14 ? x : z);
    return ((h & 1u) != 0 ? -u : u) + ((h & 2u) != 0 ? -v : v);
}

int wrapped(int i, int period) { return period > 0 ? ((i % period) + period) % period : i; }

// Shared by the fractal sums: calls octave(i, frequency) and returns the sum normalised by its weights.
template <class Octave>
float fractal(int octaves, float gain, Octave octave) {
    float sum = 0.0f, weight = 1.0f, total = 0.0f;
    int frequency = 1;
    for (int i = 0; i < octaves; ++i) {
        sum += weight * octave(static_cast<std::uint32_t>(i), frequency);
        total += weight;
        weight *= gain;
        frequency *= 2;
    }
    return sum / total;
}

float crest(float n) {
    const float r = 1.0f - std::min(1.0f, std::fabs(n) * 1.6f);
    return r * r;
}

}  // namespace

float uniform(std::uint32_t seed, std::uint32_t index, std::uint32_t purpose) {
    return shared::as_uniform(shared::as_hash(seed, index, 0u, purpose));
}

float normal(std::uint32_t seed, std::uint32_t index, std::uint32_t purpose) {
    const float u = std::max(uniform(seed, index, purpose), 1e-7f);
    const float v = uniform(seed, index, purpose + 0x8000u);
    return std::sqrt(-2.0f * shared::as_log(u)) * static_cast<float>(real::cos(2.0 * real::pi * v));
}

float noise(glm::vec2 p, std::uint32_t seed, int period_x) {
    const float fx = std::floor(p.x), fy = std::floor(p.y);
    const int j = static_cast<int>(fy);
    const int i0 = wrapped(static_cast<int>(fx), period_x), i1 = wrapped(static_cast<int>(fx) + 1, period_x);
    const float x = p.x - fx, y = p.y - fy;
    const float u = fade(x), v = fade(y);
    const float low = lerp(corner(seed, i0, j, x, y), corner(seed, i1, j, x - 1.0f, y), u);
    const float high =
        lerp(corner(seed, i0, j + 1, x, y - 1.0f), corner(seed, i1, j + 1, x - 1.0f, y - 1.0f), u);
    return 1.4f * lerp(low, high, v);
}

float noise(glm::vec3 p, std::uint32_t seed) {
    const float fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
    const int i = static_cast<int>(fx), j = static_cast<int>(fy), k = static_cast<int>(fz);
    const float x = p.x - fx, y = p.y - fy, z = p.z - fz;
    const float u = fade(x), v = fade(y), w = fade(z);
    std::array<float, 4> edge{};
    for (int e = 0; e < 4; ++e) {
        const int dj = e & 1, dk = e >> 1;
        const float ey = y - static_cast<float>(dj), ez = z - static_cast<float>(dk);
        edge[e] = lerp(corner(seed, i, j + dj, k + dk, x, ey, ez),
                       corner(seed, i + 1, j + dj, k + dk, x - 1.0f, ey, ez), u);
    }
    return lerp(lerp(edge[0], edge[1], v), lerp(edge[2], edge[3], v), w);
}

float fbm(glm::vec2 p, std::uint32_t seed, int octaves, float gain, int period_x) {
    return fractal(octaves, gain, [&](std::uint32_t i, int f) {
        return noise(p * static_cast<float>(f), seed + i, period_x * f);
    });
}

float fbm(glm::vec3 p, std::uint32_t seed, int octaves, float gain) {
    return fractal(octaves, gain,
                   [&](std::uint32_t i, int f) { return noise(p * static_cast<float>(f), seed + i); });
}

float ridged(glm::vec2 p, std::uint32_t seed, int octaves, float gain, int period_x) {
    return fractal(octaves, gain, [&](std::uint32_t i, int f) {
        return crest(noise(p * static_cast<float>(f), seed + i, period_x * f));
    });
}

float ridged(glm::vec3 p, std::uint32_t seed, int octaves, float gain) {
    return fractal(octaves, gain,
                   [&](std::uint32_t i, int f) { return crest(noise(p * static_cast<float>(f), seed + i)); });
}

float smoothstep(float from, float to, float x) {
    const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

}  // namespace astrosplat::assets
