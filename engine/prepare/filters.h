// Pictures of several filters as one. In: pictures and how the sky lies on them (a tangent plane, FITS's TAN;
// Calabretta and Greisen 2002, A&A 395, 1077); intensities. Out: a picture as it would be on another's
// pixels; linear light in which bright parts keep their colour (Lupton et al. 2004, PASP 116, 133).
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>

#include "core/image.h"
#include "detect/parts.h"

namespace astrosplat {

/// As in a FITS header: pixels count from 1 at the middle of the lower left one, upwards.
struct TanGrid {
    glm::dvec2 reference_px{0.0};        // CRPIX
    glm::dvec2 reference_deg{0.0};       // CRVAL: right ascension, declination
    std::array<double, 4> deg_per_px{};  // CD1_1 CD1_2 CD2_1 CD2_2, not singular
};

/// Right ascension (0 .. 360) and declination of a place.
glm::dvec2 sky_at(const TanGrid& grid, const glm::dvec2& px);

/// The inverse; empty for what lies behind the tangent plane's half of the sky.
std::optional<glm::dvec2> place_of(const TanGrid& grid, const glm::dvec2& sky_deg);

/// `image`, on the grid `own`, sampled at width x height pixels of the grid `target` with a Lanczos kernel of
/// three lobes; coarser pixels take the mean of what they cover. Rows from the top. Places outside of `image`
/// are marked in `outside` and 0.
Image regridded(const Image& image, const TanGrid& own, const TanGrid& target, std::int64_t width,
                std::int64_t height, PixelMask& outside);

struct LuptonSettings {
    double q = 8.0;        // > 0: how early the stretch turns from linear to logarithmic
    double stretch = 0.1;  // > 0: intensity that is shown at about a tenth of white
};

/// r, g, b are scaled together by asinh(q I / stretch) / I of their mean I, so that a tenth of white has the
/// slope of a linear stretch, and divided by the greatest of them where that exceeds white; these are display
/// values, which are decoded to linear light. Intensities below 0 become 0. Other channels stay.
void apply_lupton(Image& image, const LuptonSettings& settings);

}  // namespace astrosplat
