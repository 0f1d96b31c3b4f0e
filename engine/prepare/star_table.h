// The stars of a picture as a table. In: a list. Out: comma-separated text with a line of names.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "prepare/star_fit.h"

namespace astrosplat {

/// The first line of every star_table(): tells it from a table of another program that has the same name.
inline constexpr std::string_view star_table_mark = "# stars that astrosplat prepare took out of a picture";

/// A line with the mark and one with the columns' names, then a line a star. Columns: x, y in px from the picture's top left corner (the middle of its first pixel is 0.5, 0.5); u, v
/// on the picture (v = 0 is its lower edge); flux_r, flux_g, flux_b, the linear light summed over all pixels;
/// sigma_px, the standard deviation of the Gaussian that is as wide at half height; saturated, 0 or 1.
std::string star_table(std::span<const PictureStar> stars, std::int64_t width, std::int64_t height);

}  // namespace astrosplat
