#include "bodies/fields.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "core/sorting.h"
#include "image/blur.h"

namespace astrosplat {
namespace {

constexpr double finest_blur_steps = 10.0;  // of a field's pixels, that its blur is wide at least

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

double field_percentile(const Image& field, double share) {
    return percentile({field.pixels.begin(), field.pixels.end()}, share);
}

Image halved_often(Image image, int times) {
    for (int i = 0; i < times; ++i) image = halved(image);
    return image;
}

}  // namespace

// Two sweeps of a chamfer distance transform, one from the top left and one from the bottom right.
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

int field_halvings(const Image& brightest) {
    int halvings = 0;
    while (scaled(40.0, brightest) >= finest_blur_steps * static_cast<double>(2 << halvings)) ++halvings;
    return halvings;
}

Image thickness_field(const Image& brightest, double height) {
    const int halvings = field_halvings(brightest);
    const double step = static_cast<double>(1 << halvings);
    Image field = gaussian_blur(halved_often(brightest, halvings), scaled(40.0, brightest) / step);
    const double bright = std::max(1e-12, field_percentile(field, 0.995));
    change_each(field, [&](double v) {
        return height * std::min(0.55 + 1.65 * real::pow(std::max(0.0, v / bright), 5.0), 2.2);
    });
    limit_slope(field, 0.3 * step);
    return field;
}

Image relief_field(const Image& brightest, double depth, double steepest) {
    const int halvings = field_halvings(brightest);
    const double step = static_cast<double>(1 << halvings);
    const auto blurred = [&](const Image& image, double length) {
        return gaussian_blur(image, scaled(length, brightest) / step);
    };
    Image field = blurred(halved_often(brightest, halvings), 60.0);
    const double lo = field_percentile(field, 0.25);
    const double span = std::max(1e-12, field_percentile(field, 0.96) - lo);
    change_each(field, [&](double v) { return std::clamp((v - lo) / span, 0.0, 1.0); });
    field = blurred(field, 30.0);
    change_each(field, [](double v) { return std::sqrt(std::max(0.0, v)); });
    field = blurred(field, 45.0);
    const float highest = *std::max_element(field.pixels.begin(), field.pixels.end());
    if (highest <= 0.0f) return field;
    change_each(field, [&](double v) { return v / static_cast<double>(highest) * depth; });
    limit_slope(field, steepest * step);
    return blurred(field, 10.0);  // takes the chamfer's edges off
}

namespace {

// As DEPTH 4 has them: gains by the size of features.
constexpr double shortest_wave = 5.0;  // texels at a width of 1920
constexpr double clumpiness[8] = {3, 3, 2.6, 2.2, 1.7, 0.8, 0.3, 0.05};

}  // namespace

double by_feature(const double (&values)[8], double feature) {
    const double k = std::clamp(real::log(feature / 2.0) / real::log(2.0), 0.0, 6.0 + 0.644);
    const int i = std::min(6, static_cast<int>(k));
    const double t = i == 6 ? (k - 6.0) / 0.644 : k - i;  // the last is at 200, not at 256
    return values[i] * (1.0 - t) + values[i + 1] * t;
}

double clump_gain(const Placement& placement, double feature) {
    return 1.6 * by_feature(clumpiness, feature / placement.scale) * placement.clumps;
}

NoiseStack stack(const Placement& placement, double longest, double feature, double first_gain,
                 double ratio) {
    NoiseStack noise;
    noise.seed = placement.seed;
    const double shortest = std::max(2.2 * feature, shortest_wave * placement.scale);
    double gain = first_gain;
    for (double wave = longest; noise.count < NoiseStack::most; wave /= 2.0, gain *= ratio) {
        if (noise.count > 0 && wave < shortest) break;
        noise.frequency[noise.count] = static_cast<float>(1.0 / wave);
        noise.gain[noise.count++] = static_cast<float>(gain);
    }
    return noise;
}

NoiseStack waves(const Placement& placement, std::uint32_t field,
                 std::initializer_list<std::pair<double, double>> wave_and_gain) {
    NoiseStack noise;
    noise.seed = shared::as_mix(placement.seed + field);
    for (const auto& [wave, gain] : wave_and_gain) {
        noise.frequency[noise.count] = static_cast<float>(1.0 / (wave * placement.scale));
        noise.gain[noise.count++] = static_cast<float>(gain);
    }
    return noise;
}

}  // namespace astrosplat
