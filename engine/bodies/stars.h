// The stars of a picture (DEPTH 1). In: linear light. Out: a list of them, and the picture without. They are
// points: left in, each would become a needle in depth. The bright are wide, saturated and with wings, so
// that no one Gaussian shows them: each becomes several.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"
#include "source/source.h"

namespace astrosplat {

struct Star {
    float x = 0.0f, y = 0.0f;  // px from the top left corner
    float sigma = 0.0f;        // px, of the Gaussian that stands for it
    glm::vec3 peak{0.0f};      // linear light of its middle above the background
    std::uint32_t body = 0;    // Gaussians of one star have one depth
};

/// Of the light around a star, down to which it is taken out where there is dust: a hole would become some.
inline constexpr float least_left_in_dust = 0.9f;

/// Finds the round points that stand out of their surroundings, takes a Gaussian for each out of `light` and
/// cuts what is left of it down to 1.15 times the background. Where the Gaussian is wider than the star,
/// `least_left` of the light around stays. Each is measured in what brighter ones left; the brightest first,
/// each a body of its own. The same bits with any number of threads.
std::vector<Star> take_stars(Image& light, float least_left = least_left_in_dust);

/// A bright star where it is round, px.
struct RoundStar {
    float x = 0.0f, y = 0.0f;
    float half_width = 0.0f;  // at half of its peak
};

struct Ring {
    float median = 0.0f, quartiles_apart = 0.0f;
};

/// A channel's values on a ring of `r` px about a place.
Ring ring_at(const Image& image, int channel, float x, float y, float r);

/// Finds round bright points of a half width of 1.7 px up to 14 px (and in proportion in pictures wider than
/// 1920 px) that fall off on all sides as stars do. Takes for each up to three Gaussians of one `body` out of
/// `light`, down to 0.9 times what is around it. Their sigmas are powers of two. The same bits with any
/// number of threads.
std::vector<Star> take_bright_stars(Image& light);
/// The same of stars that are known; each is a body. `uneven`: their light is that of rings' medians less so
/// much of what its quartiles are apart.
std::vector<Star> take_bright_stars(Image& light, std::span<const RoundStar> known, float uneven = 0.5f);

/// Light that was taken out of a square of so many pixels a side with a star: it is in the star's plane.
struct SpikeLight {
    std::int64_t column = 0, row = 0;  // of the square
    std::int32_t star = 0;
    glm::vec3 light{0.0f};  // mean
};

/// What is `taken` out of `light` with stars, whose numbers, or -1, `star` has for each pixel; by rows of
/// squares of `times` pixels a side. What is hardly any goes back.
std::vector<SpikeLight> by_squares(int times, const Image& taken, const Buffer<std::int32_t>& star,
                                   Image& light);

/// Their places, px.
template <class OfStars>
std::vector<glm::vec2> places_of(const OfStars& stars) {
    std::vector<glm::vec2> places;
    for (const auto& star : stars) places.emplace_back(star.x, star.y);
    return places;
}

struct PictureStars {
    std::vector<Star> all;         // ordinary ones, each a Gaussian; then those of bright ones; each by sigma
    std::size_t ordinary = 0;      // of `all`
    std::size_t taken = 0;         // of `all`; the light of others is left, and they tell where
    std::int64_t count = 0;        // of stars, ordinary and bright
    std::vector<SpikeLight> rest;  // by pixels, what the Gaussians of `all` lack
};

/// Takes the stars out of `light`, where `params` say so. Bright ones of disks only; about an axis they are
/// found and left, and for other kinds not looked for, as there is no one depth for what such a star leaves
/// around itself. Where the picture was `enlarged`, a star is some texels with flat light between them: only
/// what a Gaussian explains is one, and where that is near, it is all of the star. `spiked`: Gaussians of
/// stars that were taken before, with their spikes, of bodies from 0 on.
PictureStars take_picture_stars(Image& light, const StructureParams& params, bool enlarged = false,
                                std::vector<Star> spiked = {});

}  // namespace astrosplat
