#include "bodies/fields.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "core/real.h"
#include "image/blur.h"
#include "image/percentile.h"

namespace astrosplat {
namespace {

// Lengths of the published measurements, in px of a picture 1920 wide.
double scaled(double length, const Image& image) {
    return length * static_cast<double>(image.width) / 1920.0;
}

template <class Change>
void change_each(Image& image, Change change) {
    parallel_chunks(image.height, 16, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t i = begin * image.width; i < end * image.width; ++i) {
            float& value = image.pixels[static_cast<std::size_t>(i)];
            value = static_cast<float>(change(static_cast<double>(value)));
        }
    });
}

// Lowers what rises above a neighbour by more than `steepest` a px: two sweeps of a chamfer distance
// transform, one from the top left and one from the bottom right.
void limit_slope(Image& image, double steepest) {
    const auto step = static_cast<float>(steepest);
    const float diagonal = step * 1.41421356f;
    const auto lower = [&](float& here, std::int64_t x, std::int64_t y, float rise) {
        if (x >= 0 && x < image.width && y >= 0 && y < image.height)
            here = std::min(here, *image.at(x, y) + rise);
    };
    for (std::int64_t y = 0; y < image.height; ++y) {
        for (std::int64_t x = 0; x < image.width; ++x) {
            float& here = *image.at(x, y);
            lower(here, x - 1, y, step);
            lower(here, x - 1, y - 1, diagonal);
            lower(here, x, y - 1, step);
            lower(here, x + 1, y - 1, diagonal);
        }
    }
    for (std::int64_t y = image.height - 1; y >= 0; --y) {
        for (std::int64_t x = image.width - 1; x >= 0; --x) {
            float& here = *image.at(x, y);
            lower(here, x + 1, y, step);
            lower(here, x + 1, y + 1, diagonal);
            lower(here, x, y + 1, step);
            lower(here, x - 1, y + 1, diagonal);
        }
    }
}

// Of a smooth field, for which every fourth pixel of every fourth row will do.
double field_percentile(const Image& field, double share) {
    std::vector<double> values;
    for (std::int64_t y = 0; y < field.height; y += 4)
        for (std::int64_t x = 0; x < field.width; x += 4)
            values.push_back(static_cast<double>(*field.at(x, y)));
    return percentile(std::move(values), share);
}

}  // namespace

Image thickness_field(const Image& brightest, double height) {
    Image field = gaussian_blur(brightest, scaled(40.0, brightest));
    const double bright = std::max(1e-12, field_percentile(field, 0.995));
    change_each(field, [&](double v) {
        return height * std::min(0.55 + 1.65 * real::pow(std::max(0.0, v / bright), 2.5), 2.2);
    });
    limit_slope(field, 0.3);
    return field;
}

Image relief_field(const Image& brightest, double depth, double steepest) {
    Image field = gaussian_blur(brightest, scaled(60.0, brightest));
    const double lo = field_percentile(field, 0.25);
    const double span = std::max(1e-12, field_percentile(field, 0.96) - lo);
    change_each(field, [&](double v) { return std::clamp((v - lo) / span, 0.0, 1.0); });
    field = gaussian_blur(field, scaled(30.0, field));
    change_each(field, [](double v) { return std::sqrt(std::max(0.0, v)); });
    field = gaussian_blur(field, scaled(45.0, field));
    const float highest = *std::max_element(field.pixels.begin(), field.pixels.end());
    if (highest <= 0.0f) return field;
    change_each(field, [&](double v) { return v / static_cast<double>(highest) * depth; });
    limit_slope(field, steepest);
    return gaussian_blur(field, scaled(10.0, field));  // takes the chamfer's edges off
}

}  // namespace astrosplat
