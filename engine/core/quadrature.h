// Gauss-Legendre quadrature over panels: integrals of falloffs, whose kinks the caller gives as panel ends.
#pragma once

#include <array>
#include <cstddef>

namespace astrosplat {

/// Nodes and weights of the 8-point rule on [-1, 1] (Abramowitz and Stegun 25.4.30): positive half.
inline constexpr std::array<double, 4> gauss_nodes = {0.1834346424956498, 0.5255324099163290,
                                                      0.7966664774136267, 0.9602898564975363};
inline constexpr std::array<double, 4> gauss_weights = {0.3626837833783620, 0.3137066458778873,
                                                        0.2223810344533745, 0.1012285362903763};

/// Integral of f over [lo, hi]; exact for polynomials of degree 15. 0 when hi <= lo.
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
