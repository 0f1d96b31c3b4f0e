// Pictures of one field on one grid. In: pictures and how the sky lies on them (a tangent plane, FITS's TAN;
// Calabretta and Greisen 2002, A&A 395, 1077). Out: a picture as it would be on another's pixels.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>

#include "core/image.h"
#include "prepare/fill.h"

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

}  // namespace astrosplat
