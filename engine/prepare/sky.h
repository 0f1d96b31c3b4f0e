// The brightness of the sky behind a picture: a level and a smooth slope. In: a picture. Out: a surface of
// second degree a channel, and the picture less it.
#pragma once

#include <array>

#include "core/image.h"

namespace astrosplat {

/// c0 + c1 u + c2 v + c3 u^2 + c4 u v + c5 v^2, with u and v from -1 (left, top) to 1 (right, bottom).
struct SkySurface {
    std::array<std::array<double, 6>, 3> coefficients{};  // of r, g, b

    double at(double u, double v, int channel) const;
};

/// Fits a surface of `degree` 0 (a level), 1 (a plane) or 2 to the medians of square cells. Cells that are
/// brighter than the surface by more than the sky's scatter hold something else: they are left out, again and
/// again until what is left is even. The picture's darker part must be sky.
SkySurface fit_sky(const Image& image, int degree);

/// Takes the surface away from the first three channels, times the alpha where there is a fourth.
void subtract_sky(Image& image, const SkySurface& sky);

}  // namespace astrosplat
