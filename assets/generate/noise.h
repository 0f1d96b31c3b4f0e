// Noise for painting the demo assets: gradient noise in two and three dimensions, fractal sums of it and
// hashes. In: a place and a seed. Out: a number that is the same on every machine.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace astrosplat::assets {

/// Uniform in [0, 1) for item `index` of the sequence `purpose` of `seed`.
float uniform(std::uint32_t seed, std::uint32_t index, std::uint32_t purpose);

/// Standard normal deviate (Box-Muller), with the arguments of uniform().
float normal(std::uint32_t seed, std::uint32_t index, std::uint32_t purpose);

/// Gradient noise, about [-1, 1], mean 0. `period_x` > 0 repeats it along x after so many cells.
float noise(glm::vec2 p, std::uint32_t seed, int period_x = 0);
float noise(glm::vec3 p, std::uint32_t seed);

/// Sum of `octaves` of noise, each of twice the frequency and `gain` times the height; about [-1, 1].
float fbm(glm::vec2 p, std::uint32_t seed, int octaves, float gain = 0.5f, int period_x = 0);
float fbm(glm::vec3 p, std::uint32_t seed, int octaves, float gain = 0.5f);

/// Ridged fractal: sharp crests of value near 1 between rounded basins near 0.
float ridged(glm::vec2 p, std::uint32_t seed, int octaves, float gain = 0.5f, int period_x = 0);
float ridged(glm::vec3 p, std::uint32_t seed, int octaves, float gain = 0.5f);

float smoothstep(float from, float to, float x);

}  // namespace astrosplat::assets
