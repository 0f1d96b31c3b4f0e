// Columns are transformed all at once, so that the inner loop runs along a row; rows are columns after the
// grid was transposed.
#include "prepare/fourier.h"

#include <utility>

#include "core/real.h"

namespace astrosplat {
namespace {

void swap_rows(ComplexGrid& grid, int a, int b) {
    const std::size_t side = std::size_t(grid.side), first = std::size_t(a) * side,
                      second = std::size_t(b) * side;
    for (std::size_t x = 0; x < side; ++x) {
        std::swap(grid.re[first + x], grid.re[second + x]);
        std::swap(grid.im[first + x], grid.im[second + x]);
    }
}

void reverse_bits_of_rows(ComplexGrid& grid) {
    for (int i = 1, reversed = 0; i < grid.side; ++i) {
        int bit = grid.side >> 1;
        for (; reversed & bit; bit >>= 1) reversed ^= bit;
        reversed ^= bit;
        if (i < reversed) swap_rows(grid, i, reversed);
    }
}

/// Row a becomes a + w b, row b a - w b.
void butterfly(ComplexGrid& grid, int a, int b, float w_re, float w_im) {
    const std::size_t side = std::size_t(grid.side);
    float *const a_re = grid.re.data() + std::size_t(a) * side, *const a_im =
                                                                    grid.im.data() + std::size_t(a) * side;
    float *const b_re = grid.re.data() + std::size_t(b) * side, *const b_im =
                                                                    grid.im.data() + std::size_t(b) * side;
    for (std::size_t x = 0; x < side; ++x) {
        const float re = w_re * b_re[x] - w_im * b_im[x], im = w_re * b_im[x] + w_im * b_re[x];
        b_re[x] = a_re[x] - re;
        b_im[x] = a_im[x] - im;
        a_re[x] += re;
        a_im[x] += im;
    }
}

/// `sign` of the exponent.
void transform_columns(ComplexGrid& grid, double sign) {
    reverse_bits_of_rows(grid);
    for (int half = 1; half < grid.side; half *= 2)
        for (int k = 0; k < half; ++k) {
            const double angle = sign * real::pi * k / half;
            const auto w_re = static_cast<float>(real::cos(angle)),
                       w_im = static_cast<float>(real::sin(angle));
            for (int block = 0; block < grid.side; block += 2 * half)
                butterfly(grid, block + k, block + k + half, w_re, w_im);
        }
}

void transpose(std::vector<float>& values, std::size_t side) {
    for (std::size_t y = 0; y < side; ++y)
        for (std::size_t x = 0; x < y; ++x) std::swap(values[y * side + x], values[x * side + y]);
}

void transform_both(ComplexGrid& grid, double sign) {
    transform_columns(grid, sign);
    transpose(grid.re, std::size_t(grid.side));
    transpose(grid.im, std::size_t(grid.side));
    transform_columns(grid, sign);
}

}  // namespace

void transform(ComplexGrid& grid) { transform_both(grid, -1.0); }

void transform_back(ComplexGrid& grid) {
    transform_both(grid, 1.0);
    const auto scale = static_cast<float>(1.0 / (double(grid.side) * double(grid.side)));
    for (std::size_t i = 0; i < grid.re.size(); ++i) {
        grid.re[i] *= scale;
        grid.im[i] *= scale;
    }
}

}  // namespace astrosplat
