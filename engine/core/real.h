// Elementary functions in double whose bits are the same on every machine: the C library picks FMA variants
// at load time, so anything that reaches a splat or a pixel uses these. Accurate to 2 ulp or better in the
// ranges stated. (sqrt, fabs, floor, ceil, fmod are exact by IEEE 754 and may come from <cmath>.) The float
// versions that the shaders share are in shaders/shared/maths.glsl.
#pragma once

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
struct OnCircle {
    float cosine, sine;
};
OnCircle on_circle(float turns);

/// 0 to 1 with an even end on either side, of t in [0, 1]: 3 t^2 - 2 t^3.
template <class T>
constexpr T smoothstep(T t) {
    return t * t * (T(3) - T(2) * t);
}

inline double radians(double degrees) { return degrees * (pi / 180.0); }
inline double degrees(double radians) { return radians * (180.0 / pi); }

}  // namespace astrosplat::real
