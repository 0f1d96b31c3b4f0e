// The sky behind the object of a picture, a level and a smooth slope, and everything beside the object. In: a
// picture. Out: a surface of second degree a channel; the picture less it, or faded where something else is.
#pragma once

#include <array>
#include <glm/vec2.hpp>

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

/// An ellipse on a picture.
struct CutEllipse {
    glm::dvec2 center_px{0.0};  // from the top left corner
    glm::dvec2 radii_px{0.0};   // half axes, > 0
    double angle_deg = 0.0;     // of the first axis from +x towards +y (down)
    double feather = 0.1;       // 0..1: share of the radii over which it fades out, inwards from the edge
};

/// 1 inside, 0 outside, smoothstep over the feather.
double inside(const CutEllipse& ellipse, double x, double y);

/// Multiplies colour and alpha.
void cut_ellipse(Image& image, const CutEllipse& ellipse);

/// Multiplies colour and alpha by the mean of r, g, b of a picture of the same size (0..1).
void cut_with_mask(Image& image, const Image& mask);

/// Multiplies the alpha by one from luminance: 0 at and below `low`, 1 at and above `high`, linear between.
/// Seen over black the picture stays as it is, but where alpha becomes 0 there is no light either.
void alpha_from_luminance(Image& image, double low, double high);

}  // namespace astrosplat
