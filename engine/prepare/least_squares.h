// Small systems of normal equations. In: rows of a design with their values. Out: the coefficients.
#pragma once

#include "core/standard.h"

namespace astrosplat {

template <std::size_t n>
using Vector = std::array<double, n>;
template <std::size_t n>
using Matrix = std::array<Vector<n>, n>;

/// Solves a symmetric positive system, of which the lower half is read, by Cholesky's method; empty where it
/// is singular.
template <std::size_t n>
std::optional<Vector<n>> solved(Matrix<n> m, Vector<n> b) {
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = m[i][j];
            for (std::size_t k = 0; k < j; ++k) sum -= m[i][k] * m[j][k];
            if (i == j && !(sum > 0.0)) return {};
            m[i][j] = i == j ? std::sqrt(sum) : sum / m[j][j];
        }
        for (std::size_t k = 0; k < i; ++k) b[i] -= m[i][k] * b[k];
        b[i] /= m[i][i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) b[i] -= m[k][i] * b[k];
        b[i] /= m[i][i];
    }
    return b;
}

/// Normal equations, a row of the design at a time.
template <std::size_t n>
struct LeastSquares {
    Matrix<n> squares{};
    Vector<n> products{};

    void add(const Vector<n>& row, double value) {
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j <= i; ++j) squares[i][j] += row[i] * row[j];
            products[i] += row[i] * value;
        }
    }
};

}  // namespace astrosplat
