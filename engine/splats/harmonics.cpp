#include "splats/harmonics.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "core/real.h"

namespace astrosplat {

std::array<float, Harmonics::count> harmonic_functions(const glm::vec3& direction) {
    // Factors: sqrt(3 / 4 pi); sqrt(15 / 4 pi), sqrt(5 / 16 pi), sqrt(15 / 16 pi); sqrt(35 / 32 pi),
    // sqrt(105 / 4 pi), sqrt(21 / 32 pi), sqrt(7 / 16 pi), sqrt(105 / 16 pi).
    constexpr float one = 0.4886025119029199f;
    constexpr float two_xy = 1.0925484305920792f, two_0 = 0.31539156525252005f, two_2 = 0.5462742152960396f;
    constexpr float three_3 = 0.5900435899266435f, three_xyz = 2.890611442640554f,
                    three_1 = 0.4570457994644658f, three_0 = 0.3731763325901154f,
                    three_2 = 1.445305721320277f;
    const float x = direction.x, y = direction.y, z = direction.z;
    const float xx = x * x, yy = y * y, zz = z * z;
    return {harmonic_0,
            -one * y,
            one * z,
            -one * x,
            two_xy * x * y,
            -two_xy * y * z,
            two_0 * (2.0f * zz - xx - yy),
            -two_xy * x * z,
            two_2 * (xx - yy),
            -three_3 * y * (3.0f * xx - yy),
            three_xyz * x * y * z,
            -three_1 * y * (4.0f * zz - xx - yy),
            three_0 * z * (2.0f * zz - 3.0f * xx - 3.0f * yy),
            -three_1 * x * (4.0f * zz - xx - yy),
            three_2 * z * (xx - yy),
            -three_3 * x * (xx - 3.0f * yy)};
}

glm::vec3 color_towards(const Harmonics& harmonics, const glm::vec3& direction) {
    const std::array<float, Harmonics::count> y = harmonic_functions(direction);
    glm::vec3 sum(0.5f);
    for (std::size_t k = 0; k < y.size(); ++k) sum += y[k] * harmonics.c[k];
    return glm::max(sum, glm::vec3(0.0f));
}

glm::vec3 mean_color(const Harmonics& harmonics) {
    return glm::max(harmonic_0 * harmonics.c[0] + 0.5f, glm::vec3(0.0f));
}

HarmonicsTurn harmonics_turn(const glm::dmat3& turn) {
    // Gauss-Legendre over z, the trapezoid rule around it: products of two functions have degree 6.
    constexpr double nodes[][2] = {{-0.8611363115940526, 0.3478548451374538},
                                   {-0.3399810435848563, 0.6521451548625461},
                                   {0.3399810435848563, 0.6521451548625461},
                                   {0.8611363115940526, 0.3478548451374538}};
    constexpr int around = 8;
    std::array<std::array<double, Harmonics::count>, Harmonics::count> sum{};
    const glm::dmat3 back = glm::transpose(turn);
    for (const auto& [z, weight] : nodes)
        for (int i = 0; i < around; ++i) {
            const double angle = 2.0 * real::pi * i / around, r = std::sqrt(1.0 - z * z);
            const glm::dvec3 d(r * real::cos(angle), r * real::sin(angle), z);
            const auto now = harmonic_functions(glm::vec3(d)),
                       before = harmonic_functions(glm::vec3(back * d));
            for (std::size_t k = 0; k < now.size(); ++k)
                for (std::size_t j = 0; j < now.size(); ++j)
                    sum[k][j] += weight * (2.0 * real::pi / around) * double(now[k]) * double(before[j]);
        }
    HarmonicsTurn result;
    for (std::size_t k = 0; k < sum.size(); ++k)
        for (std::size_t j = 0; j < sum.size(); ++j) result[k][j] = float(sum[k][j]);
    return result;
}

Harmonics turned(const Harmonics& harmonics, const HarmonicsTurn& turn) {
    Harmonics result;
    for (std::size_t k = 0; k < turn.size(); ++k) {
        result.c[k] = glm::vec3(0.0f);
        for (std::size_t j = 0; j < turn.size(); ++j) result.c[k] += turn[k][j] * harmonics.c[j];
    }
    return result;
}

}  // namespace astrosplat
