#include "render/child_noise.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "core/shared_noise.h"

namespace astrosplat {
namespace {

constexpr float octave_gain = 0.75f;          // amplitude of an octave over that of the one twice as wide
constexpr float unit_gain = 0.66143783f;      // sqrt(1 - octave_gain^2): all octaves have variance 1 together
constexpr float noise_deviation = 0.260521f;  // of as_noise over space
constexpr float farthest_cell = 0x1p30f;      // as_noise counts cells in 32 bits
constexpr float largest_exponent = 3.5f;      // times the strength; rarer than once in 2000 children

// ln of the mean of e^(x N) over space, N = as_noise over its deviation: by its cumulants of order 2, 4 and
// 6, within 0.002 for x <= 1.3.
float log_mean_exponential(float x) {
    const float x2 = x * x;
    return x2 * (0.5f + x2 * (-0.019142f + x2 * 0.00179f));
}

// Share of an octave whose cells are 2^-t diameters of the splat wide: all from the diameter down to that of
// the children, (level - 1) octaves below, and less over one octave beyond either, so that a growing splat
// takes octaves up and drops them smoothly.
float octave_share(float t, int level) {
    const float last = static_cast<float>(level - 2);
    return std::clamp(std::min(t + 1.0f, last + 1.0f - t), 0.0f, 1.0f);
}

}  // namespace

ChildNoise make_child_noise(float strength, float radius, int level, std::uint32_t seed) {
    ChildNoise noise;
    if (!(strength > 0.0f)) return noise;
    noise.limit = largest_exponent * strength;
    const float octaves_per_unit = 1.44269504f;  // 1 / ln 2
    const float size = octaves_per_unit * shared::as_log(2.0f * radius);
    const int first = static_cast<int>(std::floor(-1.0f - size)) + 1;
    for (int i = 0; i < static_cast<int>(noise.octaves.size()); ++i) {
        const float t = static_cast<float>(first + i) + size;
        const float share = octave_share(t, level);
        if (!(share > 0.0f)) continue;
        const float deviation =
            strength * share * unit_gain * shared::as_exp(t * shared::as_log(octave_gain));
        const auto octave = static_cast<std::uint32_t>(first + i);
        const auto hash = [&](std::uint32_t n) {
            return shared::as_hash(seed, octave, n, shared::PURPOSE_CHILD_NOISE);
        };
        noise.octaves[noise.count++] = {
            std::ldexp(1.0f, first + i),
            deviation / noise_deviation,
            {shared::as_uniform(hash(0)), shared::as_uniform(hash(1)), shared::as_uniform(hash(2))},
            hash(3)};
        noise.offset -= log_mean_exponential(deviation);
    }
    return noise;
}

float child_light(const ChildNoise& noise, const glm::vec3& p) {
    float exponent = 0.0f;
    for (int i = 0; i < noise.count; ++i) {
        const ChildNoise::Octave& octave = noise.octaves[i];
        const glm::vec3 q = glm::clamp(p * octave.frequency + octave.shift, -farthest_cell, farthest_cell);
        exponent += octave.amplitude * shared::as_noise(q.x, q.y, q.z, octave.seed);
    }
    return shared::as_exp(std::min(exponent, noise.limit) + noise.offset);
}

float largest_child_light(float strength) { return shared::as_exp(largest_exponent * strength); }

}  // namespace astrosplat
