// Stages of a picture's preparation besides its stars: several filters as one picture, holes filled, the sky
// taken off, everything around the object cut away. In: pictures, and how the sky lies on them (a tangent
// plane, FITS's TAN; Calabretta and Greisen 2002, A&A 395, 1077). Out: pictures; linear light in which bright
// parts keep their colour (Lupton et al. 2004, PASP 116, 133); surfaces of second degree.
#pragma once

#include <glm/vec2.hpp>

#include "core/image.h"
#include "core/progress.h"
#include "detect/parts.h"

namespace astrosplat {

/// Where the middles of a row's pixels lie on the picture that is sampled, px from its top left corner; NaN:
/// nowhere. Called by several threads.
using RowPlaces = std::function<void(std::int64_t row, std::span<glm::dvec2> places)>;

/// `image`, sampled at width x height places with a Lanczos kernel of three lobes; where they are `texels` >
/// 1 of its pixels apart they take the mean of what they cover. Places outside of `image` are marked in
/// `outside` and 0.
Image regridded(const Image& image, const RowPlaces& places, double texels, std::int64_t width,
                std::int64_t height, PixelMask& outside);

struct LuptonSettings {
    double q = 8.0;        // > 0: how early the stretch turns from linear to logarithmic
    double stretch = 0.1;  // > 0: intensity that is shown at about a tenth of white
};

/// r, g, b are scaled together by asinh(q I / stretch) / I of their mean I, so that a tenth of white has the
/// slope of a linear stretch, and divided by the greatest of them where that exceeds white; these are display
/// values, which are decoded to linear light. Intensities below 0 become 0. Other channels stay.
void apply_lupton(Image& image, const LuptonSettings& settings);

enum class FillKind { membrane, texture };

/// Fills the masked pixels of every channel. membrane: the smooth surface through the hole's rim (Laplace's
/// equation). texture: that surface plus what stands out of it in an equally large piece near the hole, the
/// one that fits the rim best; the membrane where there is no such piece. A picture that is one hole becomes
/// 0. Time and memory grow with the holes' boxes. The same bits with any number of threads. Throws Cancelled.
void fill(Image& image, const PixelMask& holes, FillKind kind, const Progress& progress = {});

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
