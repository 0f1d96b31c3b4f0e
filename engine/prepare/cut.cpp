// A factor a pixel.
#include "prepare/cut.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/color.h"
#include "core/parallel.h"
#include "core/real.h"

namespace astrosplat {
namespace {

// Multiplies all channels of every pixel by factor(x, y).
template <class Factor>
void fade(Image& image, const Factor& factor) {
    parallel_each(image.height, 16, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < image.width; ++x) {
            const float f = factor(x, y);
            for (int c = 0; c < image.channels; ++c) image.at(x, y)[c] *= f;
        }
    });
}

}  // namespace

double inside(const CutEllipse& ellipse, double x, double y) {
    const double angle = real::radians(ellipse.angle_deg), c = real::cos(angle), s = real::sin(angle);
    const double dx = x - ellipse.center_px.x, dy = y - ellipse.center_px.y;
    const double u = (c * dx + s * dy) / ellipse.radii_px.x, v = (c * dy - s * dx) / ellipse.radii_px.y;
    const double radius = std::sqrt(u * u + v * v);
    if (!(ellipse.feather > 0.0)) return radius <= 1.0 ? 1.0 : 0.0;
    const double t = std::clamp((1.0 - radius) / ellipse.feather, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

void cut_ellipse(Image& image, const CutEllipse& ellipse) {
    fade(image, [&](std::int64_t x, std::int64_t y) {
        return static_cast<float>(
            inside(ellipse, static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5));
    });
}

void cut_with_mask(Image& image, const Image& mask) {
    assert(mask.width == image.width && mask.height == image.height && mask.channels >= 3);
    fade(image, [&](std::int64_t x, std::int64_t y) {
        const float* const p = mask.at(x, y);
        return std::clamp((p[0] + p[1] + p[2]) / 3.0f, 0.0f, 1.0f);
    });
}

void alpha_from_luminance(Image& image, double low, double high) {
    assert(image.channels == 4 && low < high);
    parallel_each(image.height, 16, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < image.width; ++x) {
            float* const p = image.at(x, y);
            const auto light = static_cast<double>(luminance(p[0], p[1], p[2]));
            p[3] *= static_cast<float>(std::clamp((light - low) / (high - low), 0.0, 1.0));
            if (p[3] == 0.0f) std::fill_n(p, 3, 0.0f);
        }
    });
}

}  // namespace astrosplat
