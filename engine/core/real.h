// Elementary functions in double whose bits are the same on every machine: the C library picks FMA variants
// at load time, so anything that reaches a splat or a pixel uses these. Accurate to 2 ulp or better in the
// ranges stated. (sqrt, fabs, floor, ceil, fmod are exact by IEEE 754 and may come from <cmath>.) The float
// versions that the shaders share are in shaders/shared/maths.glsl. Also integrals by Gauss and Legendre.
#pragma once

#include <glm/vec2.hpp>

#include "core/standard.h"

namespace astrosplat::real {

inline constexpr double pi = 3.14159265358979323846;

double sin(double radians);  // |radians| <= 1e6
double cos(double radians);
double tan(double radians);
double asin(double x);  // x clamped to [-1, 1]
double acos(double x);
double atan(double x);
double atan2(double y, double x);  // (0, 0) gives 0
double exp(double x);              // overflows to infinity, underflows to 0
double log(double x);              // log(0) = -infinity, negative: NaN
double pow(double x, double y);    // x >= 0; x = 0: 0 for y > 0, 1 for y = 0, infinity for y < 0
double asinh(double x);            // 3 ulp

/// Cosine and sine of 2 pi `turns` as floats; 0 <= turns < 1 in steps of 2^-24, as as_uniform gives them.
/// They are those of cos and sin, but exact at the quarters, in a quarter of their time.
glm::vec2 on_circle(float turns);
/// What shaders/shared/circle.glsl, which has it, reads.
extern const std::array<double, 14> circle_numbers;

/// 0 to 1 with an even end on either side, of t in [0, 1]: 3 t^2 - 2 t^3.
template <class T>
constexpr T smoothstep(T t) {
    return t * t * (T(3) - T(2) * t);
}

inline double radians(double degrees) { return degrees * (pi / 180.0); }
inline double degrees(double radians) { return radians * (180.0 / pi); }

}  // namespace astrosplat::real

namespace astrosplat {

/// Nodes and weights of the 8-point rule on [-1, 1] (Abramowitz and Stegun 25.4.30): positive half.
inline constexpr std::array<double, 4> gauss_nodes = {0.1834346424956498, 0.5255324099163290,
                                                      0.7966664774136267, 0.9602898564975363};
inline constexpr std::array<double, 4> gauss_weights = {0.3626837833783620, 0.3137066458778873,
                                                        0.2223810344533745, 0.1012285362903763};

/// Integral of f over the panel [lo, hi]; exact for polynomials of degree 15, so that kinks of f are to be
/// ends of panels. 0 when hi <= lo.
template <class F>
double integrate_panel(double lo, double hi, const F& f) {
    if (!(hi > lo)) return 0.0;
    const double center = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
    double sum = 0.0;
    for (std::size_t i = 0; i < gauss_nodes.size(); ++i)
        sum += gauss_weights[i] * (f(center - half * gauss_nodes[i]) + f(center + half * gauss_nodes[i]));
    return half * sum;
}

}  // namespace astrosplat
