#include "bodies/bands.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/parallel.h"
#include "image/blur.h"

namespace astrosplat {
namespace {

constexpr double finest_blur_px = 1.2;
constexpr double coarsest_blur_share = 80.0 / 1920.0;  // of the width
constexpr float contrast_share = 0.5f;                 // of the deviation that stays out of the coarser band
constexpr double finest_hole_px = 2.0;
constexpr float least_share = 0.25f;  // of the mean that the coarser band gets

// r, g, b, the brightest of them and its square: blurred together, they give means and the deviation.
Image with_moments(const Image& light) {
    Image out = make_image(light.width, light.height, 5);
    parallel_chunks(light.height, 16, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t i = begin * light.width; i < end * light.width; ++i) {
            const float* const in = light.pixels.data() + i * 3;
            float* const p = out.pixels.data() + i * 5;
            const float brightest = std::max({in[0], in[1], in[2]});
            std::copy_n(in, 3, p);
            p[3] = brightest;
            p[4] = brightest * brightest;
        }
    });
    return out;
}

// Leaves in `light` what the coarser bands share and returns the rest.
Image take_band(Image& light, double blur, bool fill_holes) {
    const Image moments = gaussian_blur(with_moments(light), blur);
    Image band = make_image(light.width, light.height, 3);
    parallel_chunks(light.height, 16, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t i = begin * light.width; i < end * light.width; ++i) {
            const float* const p = moments.pixels.data() + i * 5;
            const float deviation = std::sqrt(std::max(0.0f, p[4] - p[3] * p[3]));
            const float share =
                std::clamp(1.0f - contrast_share * deviation / std::max(1e-6f, p[3]), least_share, 1.0f);
            for (std::int64_t c = 3 * i; c < 3 * i + 3; ++c) {
                float& here = light.pixels[static_cast<std::size_t>(c)];
                const float common = std::max(0.0f, p[c - 3 * i] * share);
                const float coarser = fill_holes ? common : std::min(common, here);
                band.pixels[static_cast<std::size_t>(c)] = std::max(0.0f, here - coarser);
                here = coarser;
            }
        }
    });
    return band;
}

}  // namespace

std::vector<Band> make_bands(std::int64_t width_px) {
    std::vector<Band> bands;
    const double coarsest = coarsest_blur_share * static_cast<double>(width_px);
    double blur = finest_blur_px;
    for (; blur < 1.2 * coarsest; blur *= 2.0)
        bands.push_back({static_cast<int>(bands.size()), blur, blur * 5.0 / 3.0});
    bands.push_back({static_cast<int>(bands.size()), blur / 2.0, blur * 1.25});
    return bands;
}

void split_bands(Image light, const std::vector<Band>& bands, bool fill_holes,
                 const std::function<void(const Band&, const Image&)>& visit) {
    assert(light.channels == 3 && !bands.empty());
    for (const Band& band : bands) {
        const bool last = band.index + 1 == static_cast<int>(bands.size());
        visit(band, last ? light : take_band(light, band.blur, fill_holes && band.blur >= finest_hole_px));
    }
}

}  // namespace astrosplat
