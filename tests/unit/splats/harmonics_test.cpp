// Spherical harmonics: orthonormal, of the right signs, and turned with what they are of.
#include "splats/harmonics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/rotation.h"

namespace astrosplat {
namespace {

TEST(Harmonics, AreOrthonormal) {
    constexpr int rings = 200, around = 64;
    double products[16][16] = {};
    for (int r = 0; r < rings; ++r)
        for (int a = 0; a < around; ++a) {
            const double z = -1.0 + (2.0 * r + 1.0) / rings, angle = 2.0 * std::numbers::pi * a / around;
            const double across = std::sqrt(1.0 - z * z);
            const auto y =
                harmonic_functions(glm::vec3(across * std::cos(angle), across * std::sin(angle), z));
            for (std::size_t i = 0; i < 16; ++i)
                for (std::size_t j = 0; j < 16; ++j)
                    products[i][j] += double(y[i]) * y[j] * 4.0 * std::numbers::pi / (rings * around);
        }
    for (int i = 0; i < 16; ++i)
        for (int j = 0; j < 16; ++j) EXPECT_NEAR(products[i][j], i == j ? 1.0 : 0.0, 1e-3) << i << ' ' << j;
}

// With the Condon-Shortley phase: functions of odd m are negative where their products of coordinates are
// not.
TEST(Harmonics, HaveTheSignsOfTheirFormat) {
    const auto y = harmonic_functions(glm::normalize(glm::vec3(0.5f, 0.4f, 1.2f)));
    const int signs[16] = {1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, 1};
    for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(y[i] > 0.0f ? 1 : -1, signs[i]) << i;
    EXPECT_NEAR(harmonic_functions({0.0f, 0.0f, 1.0f})[12], std::sqrt(7.0 / (4.0 * std::numbers::pi)), 1e-6);
}

TEST(Harmonics, ColoursAreNeverBelowZero) {
    Harmonics harmonics{};
    harmonics.c[2] = glm::vec3(2.0f);
    EXPECT_NEAR(color_towards(harmonics, {0.0f, 0.0f, 1.0f}).x, 0.5 + 2.0 * 0.4886025, 1e-6);
    EXPECT_EQ(color_towards(harmonics, {0.0f, 0.0f, -1.0f}), glm::vec3(0.0f));
    EXPECT_EQ(mean_color(harmonics), glm::vec3(0.5f));
    EXPECT_NEAR(mean_color({{mean_coefficient(glm::vec3(0.25f))}}).y, 0.25f, 1e-7);
}

TEST(Quaternion, IsItsMatrixInAllQuarters) {
    for (const glm::dvec3& degrees :
         {glm::dvec3(0.0), glm::dvec3(170.0, 5.0, 3.0), glm::dvec3(4.0, 175.0, 9.0),
          glm::dvec3(3.0, 8.0, 179.0), glm::dvec3(30.0, 40.0, -50.0)}) {
        const glm::dmat3 m = rotation_from_degrees(degrees),
                         other = rotation_from_degrees({10.0, 20.0, 30.0});
        const glm::dmat3 back = matrix_of_quaternion(quaternion_of_matrix(m));
        const glm::dmat3 both =
            matrix_of_quaternion(quaternion_product(quaternion_of_matrix(m), quaternion_of_matrix(other)));
        for (int i = 0; i < 9; ++i) {
            EXPECT_NEAR(back[i / 3][i % 3], m[i / 3][i % 3], 1e-12);
            EXPECT_NEAR(both[i / 3][i % 3], (m * other)[i / 3][i % 3], 1e-12);
        }
    }
}

}  // namespace
}  // namespace astrosplat
