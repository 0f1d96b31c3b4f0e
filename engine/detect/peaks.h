// Points and compact things that stand out of a picture. In: brightness. Out: where they are; of what may be
// a star how high it is, and how uncertain that is; of knots and star clusters, each of which is to be a ball
// at one depth, not a column of splats, which pixels belong to which.
#pragma once

#include <type_traits>

#include "core/image.h"
#include "core/parallel.h"
#include "detect/background.h"

namespace astrosplat {

/// Which of neighbours of one height is the peak: the first by rows, or each of them.
enum class EqualPeaks { first, all };

/// Whether no pixel of the square of `reach_px` about this one, as far as the image has it, is higher.
/// One channel.
bool is_peak(const Image& heights, std::int64_t x, std::int64_t y, std::int64_t reach_px,
             EqualPeaks equal = EqualPeaks::first);

/// The results of find(x, y), optionals, at the pixels `margin_px` or more from the edges: in order of rows,
/// with any number of threads.
template <class Find>
auto found_by_rows(const Image& image, std::int64_t margin_px, const Find& find) {
    using Found = typename std::invoke_result_t<Find, std::int64_t, std::int64_t>::value_type;
    std::vector<std::vector<Found>> rows(std::size_t(image.height));
    parallel_each(image.height, 16, [&](std::int64_t y) {
        if (y < margin_px || y >= image.height - margin_px) return;
        for (std::int64_t x = margin_px; x < image.width - margin_px; ++x)
            if (const auto found = find(x, y)) rows[y].push_back(*found);
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

struct Knot {
    float x = 0.0f, y = 0.0f;  // px from the top left corner
    float sigma = 0.0f;        // px
    float roundness = 1.0f;    // 0 for a piece of a filament, 1 for what is round
    float ballness = 1.0f;     // 1 only for what is nearly as wide as long
};

struct Knots {
    std::int64_t width = 0, height = 0;  // px
    std::vector<Knot> knots;             // the most prominent first
    Buffer<std::int32_t> owner;          // of each pixel: index into knots, or -1
    Buffer<float> weight;                // of each pixel: share of its fine light that is its owner's, 0..1
};

/// Peaks of the differences of neighbouring Gaussians (1.6 px and on, each 1.6 times the last) that stand out
/// of what is common around them. Each owns a disk of three times its sigma, less and less towards its rim; a
/// peak inside the inner part of another one's disk is part of that one. `given` are knots that are known
/// before, and come first.
Knots find_knots(const Image& brightest, const std::vector<Knot>& given = {});

}  // namespace astrosplat
