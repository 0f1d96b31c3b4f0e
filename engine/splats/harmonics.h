// Colour that depends on the direction it is seen from, as 3D Gaussian Splatting has it. In: coefficients of
// real spherical harmonics and a direction. Out: the colour.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/standard.h"

namespace astrosplat {

/// Coefficients of degree 0 to 3, red, green and blue of each; those of degree l begin at l^2, m from -l
/// to l. Signs with the Condon-Shortley phase, as in Kerbl et al. 2023 and in glTF's KHR_gaussian_splatting.
struct Harmonics {
    static constexpr int count = 16;
    std::array<glm::vec3, count> c;
};

constexpr float harmonic_0 = 0.28209479177387814f;  // 1 / sqrt(4 pi): the function of degree 0

/// The sixteen functions in a direction of length 1.
std::array<float, Harmonics::count> harmonic_functions(const glm::vec3& direction);

/// 1/2 + the sum of coefficients times functions, at least 0; `direction` leads from the eye to the splat,
/// length 1.
glm::vec3 color_towards(const Harmonics& harmonics, const glm::vec3& direction);

/// The same of degree 0 alone: the mean over all directions.
glm::vec3 mean_color(const Harmonics& harmonics);

/// The coefficient of degree 0 whose colour this is.
inline glm::vec3 mean_coefficient(const glm::vec3& color) { return (color - 0.5f) / harmonic_0; }

/// The matrix that turns coefficients: row k gives the k-th new one.
using HarmonicsTurn = std::array<std::array<float, Harmonics::count>, Harmonics::count>;

/// Of coefficients whose splat is turned (or mirrored) by `turn`, a matrix of orthonormal columns: colours
/// stay with the splat. Integrals of products of two functions over the sphere, by quadrature that is exact.
HarmonicsTurn harmonics_turn(const glm::dmat3& turn);
Harmonics turned(const Harmonics& harmonics, const HarmonicsTurn& turn);

}  // namespace astrosplat
