#include "source/texture.h"

#include <glm/vec2.hpp>

#include "core/color.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/sorting.h"
#include "image/blur.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

constexpr float noise = 0.002f;  // of white: what is as faint gets no say
constexpr double finest_blur_px = 1.2;
constexpr double coarsest_blur = 80.0 / 1920.0;  // of the width
constexpr float least_transmission = 0.1f;

template <class PerPixel>
void over_pixels(const Image& image, const PerPixel& work) {
    parallel_each(image.width * image.height, 1 << 14, work);
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
    const double coarsest = coarsest_blur * double(light.width);
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

// The channel that a pixel's line would add to, and the continuum beside it.
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
        if (e.others > 10.0f * noise) ratios.push_back(double(e.own / e.others));
    }
    const auto scale = float(percentile(std::move(ratios), 0.5));
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

namespace {

// 1 well inside, 0 well outside; `inside` is the distance to the border.
float ramp(double inside, double feather) {
    if (!(feather > 0.0)) return inside >= 0.0 ? 1.0f : 0.0f;
    return float(std::clamp(0.5 + inside / feather, 0.0, 1.0));
}

// In a range whose ends at 0 and 1 are open: beyond them there is nothing to keep out.
float in_range(double value, const glm::dvec2& range, double feather) {
    const float above = range.x > 0.0 ? ramp(value - range.x, feather) : 1.0f;
    const float below = range.y < 1.0 ? ramp(range.y - value, feather) : 1.0f;
    return above * below;
}

// As a display shows a pixel; hue in turns, below 0 for grey.
struct Shown {
    float luminance, hue, saturation;
};

Shown shown(const float* p) {
    const std::array<float, 3> c = {display_srgb(p[0]), display_srgb(p[1]), display_srgb(p[2])};
    const float most = std::max({c[0], c[1], c[2]}), span = most - std::min({c[0], c[1], c[2]});
    Shown result{display_srgb(luminance(p[0], p[1], p[2])), -1.0f, 0.0f};
    if (!(span > 0.0f)) return result;
    result.saturation = span / most;
    const float sixth = most == c[0]   ? (c[1] - c[2]) / span
                        : most == c[1] ? 2.0f + (c[2] - c[0]) / span
                                       : 4.0f + (c[0] - c[1]) / span;
    result.hue = (sixth < 0.0f ? sixth + 6.0f : sixth) / 6.0f;
    return result;
}

float in_hues(double hue, const glm::dvec2& degrees, double feather) {
    if (hue < 0.0) return 0.0f;
    const double span = (degrees.y - degrees.x) / 360.0;
    const double half = 0.5 * (span - std::floor(span));
    if (span >= 1.0) return 1.0f;
    const double off = hue - degrees.x / 360.0 - half;
    return ramp(half - std::fabs(off - std::floor(off + 0.5)), feather);
}

// `place` is in picture widths from the ellipse's centre, y up; exact for a circle.
float in_ellipse(const glm::dvec2& place, const glm::dvec2& half_axes, double feather) {
    const glm::dvec2 scaled = place / half_axes;
    const double rho = std::sqrt(scaled.x * scaled.x + scaled.y * scaled.y);
    const glm::dvec2 slope = scaled / half_axes;
    const double steepness = std::sqrt(slope.x * slope.x + slope.y * slope.y) / std::max(rho, 1e-12);
    const double nearest = std::min(half_axes.x, half_axes.y);
    return ramp(rho > 0.0 ? (1.0 - rho) / steepness : nearest, feather);
}

// The terms of one mask with what they look things up in.
class Terms {
  public:
    Terms(const MaskTerms& terms, const Image& light)
        : terms_(terms),
          light_(light),
          turn_{real::cos(real::radians(terms.turn)), real::sin(real::radians(terms.turn))} {
        if (terms.derive != Derived::none) derived_ = derived_picture(light, terms.derive);
        if (terms.image.empty()) return;
        picture_.image = opaque(load_mask(terms.image));
    }

    bool inverts() const { return terms_.invert; }

    float weight(std::int64_t x, std::int64_t y) const {
        float w = 1.0f;
        const float* const p = light_.at(x, y);
        if (terms_.luminance || terms_.hue || terms_.saturation) w *= color_weight(p, x, y);
        if (terms_.derive != Derived::none && !terms_.luminance) w *= *derived_.at(x, y);
        if (terms_.ellipse) w *= ellipse_weight(x, y);
        if (!terms_.image.empty()) w *= image_weight(x, y);
        return w;
    }

  private:
    float color_weight(const float* p, std::int64_t x, std::int64_t y) const {
        const Shown s = shown(p);
        float w = 1.0f;
        if (terms_.luminance) {
            const float value = terms_.derive == Derived::none ? s.luminance : *derived_.at(x, y);
            w *= in_range(value, *terms_.luminance, terms_.feather);
        }
        if (terms_.hue) w *= in_hues(s.hue, *terms_.hue, terms_.feather);
        if (terms_.saturation) w *= in_range(s.saturation, *terms_.saturation, terms_.feather);
        return w;
    }

    float ellipse_weight(std::int64_t x, std::int64_t y) const {
        const auto width = double(light_.width), height = double(light_.height);
        const glm::dvec4& e = *terms_.ellipse;
        const glm::dvec2 off((double(x) + 0.5) / width - e.x,
                             (height - double(y) - 0.5 - e.y * height) / width);
        const glm::dvec2 turned(off.x * turn_.x + off.y * turn_.y, off.y * turn_.x - off.x * turn_.y);
        return in_ellipse(turned, {e.z, e.w}, terms_.feather);
    }

    float image_weight(std::int64_t x, std::int64_t y) const {
        const double u = (double(x) + 0.5) / double(light_.width);
        const double v = 1.0 - (double(y) + 0.5) / double(light_.height);
        const glm::vec3 c = sample(picture_, glm::vec2(u, v)).color;
        return std::clamp((c.x + c.y + c.z) / 3.0f, 0.0f, 1.0f);
    }

    const MaskTerms& terms_;
    const Image& light_;
    glm::dvec2 turn_;  // cosine and sine
    Image derived_;
    Texture picture_;
};

struct Mask {
    Terms own;
    std::vector<Terms> any;

    float weight(std::int64_t x, std::int64_t y) const {
        float w = own.weight(x, y), best = any.empty() ? 1.0f : 0.0f;
        for (const Terms& terms : any) {
            const float one = terms.weight(x, y);
            best = std::max(best, terms.inverts() ? 1.0f - one : one);
        }
        w *= best;
        return own.inverts() ? 1.0f - w : w;
    }
};

}  // namespace

Image mask_weights(const Image& light, std::span<const MaskParams> masks) {
    std::vector<Mask> ready;
    for (const MaskParams& params : masks) {
        Mask mask{Terms(params, light), {}};
        for (const MaskTerms& terms : params.any) mask.any.emplace_back(terms, light);
        ready.push_back(std::move(mask));
    }
    Image weights = make_image(light.width, light.height, 1, 1.0f);
    for_each_pixel(weights, [&](std::int64_t x, std::int64_t y) {
        for (const Mask& mask : ready) *weights.at(x, y) *= mask.weight(x, y);
    });
    return weights;
}

}  // namespace astrosplat
