// Squares spread evenly over the picture are split into bands, and the shares of dots that are kept are added
// up pixel by pixel. Coarse bands are not as in the whole picture, but have few dots.
#include "bodies/dot_count.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

#include "bodies/bands.h"
#include "bodies/dust.h"
#include "bodies/picture_light.h"
#include "bodies/picture_splats.h"
#include "bodies/picture_stars.h"
#include "bodies/placement.h"
#include "core/parallel.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

constexpr std::int64_t sample_px = 64, margin_px = 16;
constexpr std::int64_t apart_px = 240, most_samples = 16;  // along a side
constexpr std::int64_t whole_px = 1024;                    // up to which a side is looked at as a whole

// Of a picture that is like `whole`, its part from (x, y) on.
Texture part_of(const Texture& whole, std::int64_t x, std::int64_t y, std::int64_t width,
                std::int64_t height) {
    Texture part;
    part.alpha_from_light = whole.alpha_from_light;
    part.times = whole.times;
    part.image = make_image(width, height, whole.image.channels);
    for (std::int64_t row = 0; row < height; ++row)
        std::copy_n(whole.image.at(x, y + row), width * whole.image.channels, part.image.at(0, row));
    return part;
}

// The sum of value(x, y) over the middle of a part.
template <class Value>
double sum_inside(const Image& part, const Value& value) {
    double sum = 0.0;
    for (std::int64_t y = margin_px; y < part.height - margin_px; ++y)
        for (std::int64_t x = margin_px; x < part.width - margin_px; ++x)
            sum += static_cast<double>(value(x, y));
    return sum;
}

// Dots a texel in the middle of a part.
double dots_a_texel(const Texture& part, const StructureParams& params, const Placement& placement,
                    const std::vector<Band>& bands) {
    const PictureLight picture = picture_light(part, 0.0);
    const Image brightest = brightest_channel(picture.light);
    Image rest = picture.light;
    take_picture_stars(rest, params, picture.enlarged);
    const Image without_stars = brightest_channel(rest);
    Image emission = make_image(rest.width, rest.height, 3);
    const auto shows = [&](std::int64_t x, std::int64_t y) {
        return picture.alpha.pixels.empty() || *picture.alpha.at(x, y) > 0.0f;
    };
    double dots = 0.0;
    split_bands(std::move(rest), bands, dust_of(params) > 0.0, [&](const Band& band, const Image& light) {
        std::ranges::transform(emission.pixels, light.pixels, emission.pixels.begin(), std::plus());
        const bool coarsest = band.index + 1 == static_cast<int>(bands.size());
        const BandDots size = band_dots(band, coarsest, placement)[0];
        const double kept = sum_inside(brightest, [&](std::int64_t x, std::int64_t y) {
            const float* const p = light.at(x, y);
            return shows(x, y) ? kept_share(std::max({p[0], p[1], p[2]}), *brightest.at(x, y), size) : 0.0f;
        });
        dots += kept / static_cast<double>(size.spacing * size.spacing);
    });
    if (dust_of(params) > 0.0) {
        const Image seen = transmittance_of(without_stars, emission, picture.alpha);
        dots += sum_inside(seen, [&](std::int64_t x, std::int64_t y) {
            return expected_dust_dots(*seen.at(x, y), dust_of(params));
        });
    }
    return dots / sum_inside(brightest, [](std::int64_t, std::int64_t) { return 1.0f; });
}

// Where samples of a side begin, and how long they are.
struct Samples {
    std::int64_t count, length, size;
    std::int64_t begin(std::int64_t i) const { return ((2 * i + 1) * size / count - length) / 2; }
};

Samples samples_of(std::int64_t size) {
    if (size <= whole_px) return {1, size, size};
    return {std::min(size / apart_px, most_samples), sample_px + 2 * margin_px, size};
}

}  // namespace

double most_dots(std::int64_t width, std::int64_t height, const StructureParams& params) {
    const Placement placement = placement_without_fields(width, height, params, 0.0);
    double each_texel = dust_of(params) > 0.0 ? static_cast<double>(expected_dust_dots(0.0f, 1.0)) : 0.0;
    const std::vector<Band> bands = make_bands(width);
    for (const Band& band : bands) {
        const bool coarsest = band.index + 1 == static_cast<int>(bands.size());
        float spacing = std::numeric_limits<float>::infinity();  // a place has dots of one size
        for (const BandDots& size : band_dots(band, coarsest, placement))
            spacing = std::min(spacing, size.spacing);
        each_texel += 1.0 / static_cast<double>(spacing * spacing);
    }
    return each_texel * static_cast<double>(width * height);
}

double expected_dots(const Texture& texture, const StructureParams& params) {
    const Image& image = texture.image;
    if (std::min(image.width, image.height) <= 2 * margin_px)
        return static_cast<double>(image.width * image.height);
    const Placement placement = placement_without_fields(image.width, image.height, params, 0.0);
    const std::vector<Band> bands = make_bands(image.width);
    const Samples columns = samples_of(image.width), rows = samples_of(image.height);
    std::vector<double> densities(static_cast<std::size_t>(columns.count * rows.count));
    parallel_each(densities.size(), 1, [&](std::size_t i) {
        const auto number = static_cast<std::int64_t>(i);
        const Texture part = part_of(texture, columns.begin(number % columns.count),
                                     rows.begin(number / columns.count), columns.length, rows.length);
        densities[i] = dots_a_texel(part, params, placement, bands);
    });
    const double mean =
        std::accumulate(densities.begin(), densities.end(), 0.0) / static_cast<double>(densities.size());
    return mean * static_cast<double>(image.width * image.height);
}

}  // namespace astrosplat
