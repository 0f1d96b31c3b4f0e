// What belongs to the object of a picture, as alpha. In: a premultiplied RGBA picture. Out: the same, faded
// where something else is.
#pragma once

#include <glm/vec2.hpp>

#include "core/image.h"

namespace astrosplat {

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
