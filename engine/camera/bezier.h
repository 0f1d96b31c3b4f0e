// Cubic Bezier segments. In: control points. Out: a point of the curve, or where along the curve a frame is
// reached.
#pragma once

namespace astrosplat {

/// The point at u in [0, 1] of the curve from a to d.
template <class T>
T bezier_point(const T& a, const T& b, const T& c, const T& d, double u) {
    const double v = 1.0 - u;
    return a * (v * v * v) + b * (3.0 * v * v * u) + c * (3.0 * v * u * u) + d * (u * u * u);
}

/// Its derivative with respect to u.
template <class T>
T bezier_slope(const T& a, const T& b, const T& c, const T& d, double u) {
    const double v = 1.0 - u;
    return (b - a) * (3.0 * v * v) + (c - b) * (6.0 * v * u) + (d - c) * (3.0 * u * u);
}

/// u at which the curve from 0 to 1 with the control points b and c, both in [0, 1], is at x in [0, 1]: it
/// rises all the way.
inline double bezier_parameter(double b, double c, double x) {
    double lo = 0.0, hi = 1.0;
    for (int k = 0; k < 54; ++k) {
        const double mid = 0.5 * (lo + hi);
        (bezier_point(0.0, b, c, 1.0, mid) < x ? lo : hi) = mid;
    }
    return 0.5 * (lo + hi);
}

}  // namespace astrosplat
