#include "bodies/picture_light.h"

#include "core/parallel.h"
#include "core/real.h"
#include "image/blur.h"
#include "image/channels.h"
#include "image/resample.h"

namespace astrosplat {
namespace {

// 0 at the edge, 1 from `width` px inwards.
float edge_fade(std::int64_t i, std::int64_t count, double width) {
    if (width <= 0.0) return 1.0f;
    const double inside = std::min(double(i) + 0.5, double(count - i) - 0.5) / width;
    return float(real::smoothstep(std::clamp(inside, 0.0, 1.0)));
}

float finite_light(float value) { return value > 0.0f && std::isfinite(value) ? value : 0.0f; }

}  // namespace

PictureLight picture_light(const Texture& texture, double border) {
    const Image& image = texture.image;
    const double width_px = border * double(image.width);
    PictureLight result{unfilled_image(image.width, image.height, 3),
                        unfilled_image(image.width, image.height, 1), texture.times};
    for_each_pixel(image, [&](std::int64_t x, std::int64_t y) {
        const float fade = edge_fade(y, image.height, width_px) * edge_fade(x, image.width, width_px);
        const float* const in = image.at(x, y);
        for (int c = 0; c < 3; ++c) result.light.at(x, y)[c] = fade * finite_light(in[c]);
        *result.alpha.at(x, y) =
            texture.alpha_from_light ? fade : fade * std::clamp(finite_light(in[3]), 0.0f, 1.0f);
    });
    if (std::ranges::all_of(result.alpha.pixels, [](float a) { return a == 1.0f; })) result.alpha = {};
    return result;
}

namespace {

constexpr double finest_blur_px = 1.2;
constexpr double coarsest_blur_share = 80.0 / 1920.0;  // of the width
constexpr float contrast_share = 0.5f;                 // of the deviation that stays out of the coarser band
constexpr double finest_hole_px = 2.0;
constexpr float highest_peak = 2.0f;     // times what is around it, that counts for its surroundings
constexpr double widest_peak_px = 12.0;  // blur up to which peaks are small; beyond are bulges
constexpr float least_share = 0.25f;     // of the mean that the coarser band gets

// Every channel.
void multiply(Image& values, const Image& factor) {
    const auto channels = std::size_t(values.channels);
    parallel_each(factor.pixels.size(), 65536, [&](std::size_t i) {
        for (std::size_t c = 0; c < channels; ++c) values.pixels[channels * i + c] *= factor.pixels[i];
    });
}

// The share of the mean that the coarser bands get.
Image common_share(Image brightest, double blur) {
    const Image means = gaussian_blur(brightest, blur);
    parallel_each(brightest.pixels.size(), 65536,
                  [&](std::size_t i) { brightest.pixels[i] *= brightest.pixels[i]; });
    Image share = gaussian_blur(std::move(brightest), blur);
    parallel_each(share.pixels.size(), 65536, [&](std::size_t i) {
        const float mean = means.pixels[i], square = share.pixels[i];
        const float deviation = std::sqrt(std::max(0.0f, square - mean * mean));
        share.pixels[i] =
            std::clamp(1.0f - contrast_share * deviation / std::max(1e-6f, mean), least_share, 1.0f);
    });
    return share;
}

// Cuts off peaks that are small beside the blur: what is between stars is not dark because they are bright.
Image peak_factor(const Image& brightest, double blur) {
    Image factor = opened(brightest, std::llround(2.0 * blur));
    parallel_each(factor.pixels.size(), 65536, [&](std::size_t i) {
        factor.pixels[i] =
            std::min(1.0f, highest_peak * factor.pixels[i] / std::max(1e-6f, brightest.pixels[i]));
    });
    return factor;
}

// `factor`: of every pixel; without pixels: of 1.
Image blurred(const Image& light, Image factor, double blur) {
    if (factor.pixels.empty()) return gaussian_blur(light, blur);
    Image scaled = copied(light);
    multiply(scaled, factor);
    factor = {};
    return gaussian_blur(std::move(scaled), blur);
}

// Leaves in `light` what the coarser bands share and returns the rest. Pictures are large: the rest takes the
// place of what the light is when it is blurred.
Image take_band(Image& light, double blur, bool fill_holes) {
    Image brightest = brightest_channel(light);
    const bool peaked = fill_holes && blur < widest_peak_px;
    Image factor = peaked ? peak_factor(brightest, blur) : Image();
    multiply(brightest, factor);
    const Image share = common_share(std::move(brightest), blur);
    Image band = blurred(light, std::move(factor), blur);
    parallel_each(share.pixels.size(), 65536, [&](std::size_t pixel) {
        for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
            float& here = light.pixels[i];
            const float common = std::max(0.0f, band.pixels[i] * share.pixels[pixel]);
            const float coarser = fill_holes ? common : std::min(common, here);
            band.pixels[i] = std::max(0.0f, here - coarser);
            here = coarser;
        }
    });
    return band;
}

}  // namespace

Image at_area(const Image& image, double area, double smallest_px) {
    const ImageSize size = size_of_area(image.width, image.height, area, smallest_px);
    return reduced_by_area(image, size.width, size.height);
}

std::vector<Band> make_bands(std::int64_t width_px) {
    std::vector<Band> bands;
    const double coarsest = coarsest_blur_share * double(width_px);
    double blur = finest_blur_px;
    for (; blur < 1.2 * coarsest; blur *= 2.0) bands.push_back({int(bands.size()), blur, blur * 5.0 / 3.0});
    bands.push_back({int(bands.size()), blur / 2.0, blur * 1.25});
    return bands;
}

void split_bands(Image light, const std::vector<Band>& bands, bool fill_holes,
                 const std::function<void(const Band&, const Image&)>& visit) {
    assert(light.channels == 3 && !bands.empty());
    for (const Band& band : bands) {
        const bool last = band.index + 1 == int(bands.size());
        visit(band, last ? light : take_band(light, band.blur, fill_holes && band.blur >= finest_hole_px));
    }
}

}  // namespace astrosplat
