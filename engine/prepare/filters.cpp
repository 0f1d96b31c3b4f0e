// A blur before sampling where pixels grow. Of Lupton's stretch one factor a pixel for all three channels.
#include "prepare/stages.h"

#include "core/color.h"
#include "core/parallel.h"
#include "core/real.h"
#include "image/blur.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

constexpr int lobes = 3;  // of the Lanczos kernel, on either side

double lanczos(double x) {
    if (std::fabs(x) < 1e-9) return 1.0;
    if (std::fabs(x) >= lobes) return 0.0;
    const double t = real::pi * x;
    return lobes * real::sin(t) * real::sin(t / lobes) / (t * t);
}

// Weights of the six pixels from `first` on about a place, px from the first pixel's middle; their sum is 1.
struct Weights {
    std::int64_t first;
    std::array<double, 2 * lobes> of;
};

Weights weights_at(double place) {
    Weights w{std::int64_t(std::floor(place)) - lobes + 1, {}};
    double sum = 0.0;
    for (std::size_t i = 0; i < w.of.size(); ++i) {
        w.of[i] = lanczos(place - double(w.first + std::int64_t(i)));
        sum += w.of[i];
    }
    for (double& weight : w.of) weight /= sum;
    return w;
}

// (x, y) in px from the top left corner. Beyond the edges the last pixel goes on.
void sample(const Image& image, double x, double y, float* out) {
    const Weights across = weights_at(x - 0.5), down = weights_at(y - 0.5);
    for (int c = 0; c < image.channels; ++c) {
        double sum = 0.0;
        for (std::size_t j = 0; j < down.of.size(); ++j) {
            const auto v = std::clamp<std::int64_t>(down.first + std::int64_t(j), 0, image.height - 1);
            for (std::size_t i = 0; i < across.of.size(); ++i) {
                const auto u = std::clamp<std::int64_t>(across.first + std::int64_t(i), 0, image.width - 1);
                sum += down.of[j] * across.of[i] * double(image.at(u, v)[c]);
            }
        }
        out[c] = float(sum);
    }
}

}  // namespace

Image regridded(const Image& image, const RowPlaces& places, double texels, std::int64_t width,
                std::int64_t height, PixelMask& outside) {
    // Half a pixel of the target as sigma, less the half texel that the source has already.
    const Image source = texels > 1.0 ? gaussian_blur(image, 0.5 * std::sqrt(texels * texels - 1.0)) : image;
    Image out = make_image(width, height, image.channels);
    outside = make_mask(width, height);
    parallel_each(height, 8, [&](std::int64_t y) {
        std::vector<glm::dvec2> row(static_cast<std::size_t>(width));
        places(y, row);
        for (std::int64_t x = 0; x < width; ++x) {
            const auto [u, v] = std::pair(row[x].x, row[x].y);
            if (u >= 0.0 && v >= 0.0 && u <= double(image.width) && v <= double(image.height))
                sample(source, u, v, out.at(x, y));
            else
                outside.at(x, y) = 1;
        }
    });
    return out;
}

void apply_lupton(Image& image, const LuptonSettings& settings) {
    // A mean of a tenth of the stretch is shown as a tenth of white.
    const double tenth = 0.1 / real::asinh(0.1 * settings.q);
    change_pixels(image, [&](float* p) {
        std::array<double, 3> light;
        for (std::size_t c = 0; c < 3; ++c) light[c] = std::max(0.0, double(p[c]));
        const double mean = (light[0] + light[1] + light[2]) / 3.0;
        if (!(mean > 0.0)) {
            std::fill_n(p, 3, 0.0f);
            return;
        }
        double factor = tenth * real::asinh(settings.q * mean / settings.stretch) / mean;
        factor /= std::max(1.0, factor * std::ranges::max(light));
        for (std::size_t c = 0; c < 3; ++c) p[c] = float(real::srgb_to_linear(factor * light[c]));
    });
}

}  // namespace astrosplat
