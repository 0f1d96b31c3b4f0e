// Points that stand out of a picture. In: brightness. Out: where they are; of what may be a star how high it
// is, and how uncertain that is.
#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include "core/image.h"
#include "core/parallel.h"
#include "detect/background.h"

namespace astrosplat {

/// Which of neighbours of one height is the peak: the first by rows, or each of them.
enum class EqualPeaks { first, all };

/// Whether no pixel of the square of `reach_px` about this one, as far as the image has it, is higher. One
/// channel.
bool is_peak(const Image& heights, std::int64_t x, std::int64_t y, std::int64_t reach_px,
             EqualPeaks equal = EqualPeaks::first);

/// The results of find(x, y), optionals, at the pixels `margin_px` or more from the edges: in order of rows,
/// with any number of threads.
template <class Find>
auto found_by_rows(const Image& image, std::int64_t margin_px, const Find& find) {
    using Found = typename std::invoke_result_t<Find, std::int64_t, std::int64_t>::value_type;
    std::vector<std::vector<Found>> rows(static_cast<std::size_t>(image.height));
    parallel_each(image.height, 16, [&](std::int64_t y) {
        if (y < margin_px || y >= image.height - margin_px) return;
        for (std::int64_t x = margin_px; x < image.width - margin_px; ++x)
            if (const auto found = find(x, y)) rows[static_cast<std::size_t>(y)].push_back(*found);
    });
    std::vector<Found> all;
    for (const std::vector<Found>& row : rows) all.insert(all.end(), row.begin(), row.end());
    return all;
}

/// Light above a floor, and where its middle is, px from the top left corner.
struct PointLight {
    double sum = 0.0;
    float x = 0.0f, y = 0.0f;
};

/// Of the square of `reach_px` about a pixel, which the image has.
PointLight light_about(const Image& brightest, std::int64_t x, std::int64_t y, std::int64_t reach_px,
                       float floor);

/// A star of a given width at every pixel: the height of a Gaussian with a constant background
/// under it, by least squares in a square around the pixel (DAOFIND; Stetson 1987, PASP 99, 191).
/// `brightness` has one channel, and so has the result.
Image matched_heights(const Image& brightness, double sigma_px);

/// For white noise.
double pixel_noise_over_height_noise(double sigma_px);

/// How far these heights scatter where there is no star, by cells, and not below `least`.
Cells noise_of_heights(const Image& heights, double least);

struct StarCandidate {
    double x, y;    // px from the top left corner
    double height;  // of matched_heights
    double noise;
};

/// The greatest of 5x5 heights above `threshold` times their noise, in order of rows.
std::vector<StarCandidate> find_candidates(const Image& heights, const Cells& noise, double threshold);

}  // namespace astrosplat
