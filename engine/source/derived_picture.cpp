#include "source/derived_picture.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/parallel.h"
#include "core/sorting.h"
#include "image/blur.h"

namespace astrosplat {
namespace {

constexpr float noise = 0.002f;  // of white: what is as faint gets no say
constexpr double finest_blur_px = 1.2;
constexpr double coarsest_blur = 80.0 / 1920.0;  // of the width
constexpr float least_transmission = 0.1f;
constexpr std::int64_t map_rows_per_chunk = 16;

template <class PerPixel>
void over_pixels(const Image& image, const PerPixel& work) {
    parallel_chunks(image.height, map_rows_per_chunk, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t i = begin * image.width; i < end * image.width; ++i) work(i);
    });
}

float brightest(const float* p) { return std::max({p[0], p[1], p[2]}); }

// r, g, b, their maximum and its square: blurred together, they give means and the deviation.
Image moments(const Image& light) {
    Image out = make_image(light.width, light.height, 5);
    over_pixels(light, [&](std::int64_t i) {
        const float* const from = light.pixels.data() + i * light.channels;
        float* const to = out.pixels.data() + i * 5;
        std::copy_n(from, 3, to);
        to[3] = brightest(from);
        to[4] = to[3] * to[3];
    });
    return out;
}

// The band P_k of one blur: the mean, less where the neighbourhood varies.
Image coarse_band(const Image& of_light, double blur) {
    Image band = gaussian_blur(of_light, blur);
    over_pixels(band, [&](std::int64_t i) {
        float* const p = band.pixels.data() + i * 5;
        const float deviation = std::sqrt(std::max(0.0f, p[4] - p[3] * p[3]));
        const float share = std::clamp(1.0f - 0.5f * deviation / std::max(p[3], 1e-6f), 0.25f, 1.0f);
        for (int c = 0; c < 3; ++c) p[c] *= share;
    });
    return band;
}

Image dust_map(const Image& light) {
    const Image of_light = moments(light);
    Image filled = make_image(light.width, light.height, 3), finer = of_light;
    const double coarsest = coarsest_blur * static_cast<double>(light.width);
    const auto add = [&](const Image& coarser) {
        over_pixels(filled, [&](std::int64_t i) {
            for (int c = 0; c < 3; ++c) {
                const std::int64_t at = 5 * i + c;
                filled.pixels[3 * i + c] += std::max(0.0f, finer.pixels[at] - coarser.pixels[at]);
            }
        });
    };
    for (double blur = finest_blur_px; blur < 1.2 * coarsest; blur *= 2.0) {
        Image coarser = coarse_band(of_light, blur);
        add(coarser);
        finer = std::move(coarser);
    }
    add(make_image(light.width, light.height, 5));
    Image dust = make_image(light.width, light.height, 1);
    over_pixels(dust, [&](std::int64_t i) {
        const float transmission =
            (of_light.pixels[5 * i + 3] + noise) / (brightest(filled.pixels.data() + 3 * i) + noise);
        dust.pixels[i] = 1.0f - std::clamp(transmission, least_transmission, 1.0f);
    });
    return dust;
}

// What a pixel's line would add to, and the continuum beside it.
struct Excess {
    float own, others;
};

template <class Split>
Image excess_map(const Image& light, const Split& split) {
    const std::int64_t pixels = light.width * light.height;
    const std::int64_t step = std::max<std::int64_t>(1, pixels / 1000000);
    std::vector<double> ratios;
    for (std::int64_t i = 0; i < pixels; i += step) {
        const Excess e = split(light.pixels.data() + i * light.channels);
        if (e.others > 10.0f * noise) ratios.push_back(static_cast<double>(e.own / e.others));
    }
    const auto scale = static_cast<float>(percentile(std::move(ratios), 0.5));
    Image map = make_image(light.width, light.height, 1);
    over_pixels(map, [&](std::int64_t i) {
        const Excess e = split(light.pixels.data() + i * light.channels);
        map.pixels[i] = std::clamp((e.own - scale * e.others) / (e.own + noise), 0.0f, 1.0f);
    });
    return map;
}

}  // namespace

Image derived_picture(const Image& light, Derived kind) {
    assert(light.channels >= 3 && kind != Derived::none);
    if (kind == Derived::dust) return dust_map(light);
    if (kind == Derived::h_alpha)
        return excess_map(light, [](const float* p) { return Excess{p[0], 0.5f * (p[1] + p[2])}; });
    return excess_map(light, [](const float* p) { return Excess{p[2], 0.5f * (p[0] + p[1])}; });
}

}  // namespace astrosplat
