// The discrete Fourier transform of small square grids, by radix 2. In: complex numbers as two arrays. Out:
// their spectrum in place, with the same bits on every machine.
#pragma once

#include <vector>

namespace astrosplat {

/// side x side complex numbers, row by row; side is a power of 2.
struct ComplexGrid {
    explicit ComplexGrid(int side_)
        : side(side_), re(std::size_t(side_) * std::size_t(side_)), im(re.size()) {}
    int side;
    std::vector<float> re, im;
};

/// To the spectrum with its two axes exchanged.
void transform(ComplexGrid& grid);
/// From such a spectrum back, scaled by 1 / side^2.
void transform_back(ComplexGrid& grid);

}  // namespace astrosplat
