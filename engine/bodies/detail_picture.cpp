// Numbers are those of DETAIL 3. All but the slope follows from what is near, and what is random from a
// place.
#include "bodies/detail_picture.h"

#include "bodies/exemplar.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/shared_maths.h"
#include "core/sorting.h"
#include "image/blur.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

constexpr float dark_offset = 0.01f;               // light that is added before logarithms are taken
constexpr std::int64_t bytes_a_detail_pixel = 72;  // found, for one octave; 65 for two

template <class Change>
void change_values(Image& image, const Change& change) {
    parallel_each(image.pixels.size(), 1 << 16, [&](std::size_t i) { image.pixels[i] = change(i); });
}

template <class Of>
Image made_of_values(const Image& like, const Of& of) {
    Image image = unfilled_image(like.width, like.height, like.channels);
    change_values(image, of);
    return image;
}

Image logarithms(const Image& light) {
    return made_of_values(light,
                          [&](std::size_t i) { return shared::as_log(light.pixels[i] + dark_offset); });
}

float luminance_of(const float* value, int channels) {
    return channels == 1 ? value[0] : 0.3f * value[0] + 0.45f * value[1] + 0.25f * value[2];
}

Image luminance(const Image& image) {
    return made_by_pixel(image, 1,
                         [&](const float* in, float* out) { *out = luminance_of(in, image.channels); });
}

// Means of 2 x 2 pixels, at odd ends of what there is.
Image half_by_area(const Image& image) {
    Image half = unfilled_image((image.width + 1) / 2, (image.height + 1) / 2, image.channels);
    for_each_pixel(half, [&](std::int64_t x, std::int64_t y) {
        const std::int64_t right = std::min(2 * x + 1, image.width - 1),
                           down = std::min(2 * y + 1, image.height - 1);
        for (int c = 0; c < image.channels; ++c)
            half.at(x, y)[c] = 0.25f * ((image.at(2 * x, 2 * y)[c] + image.at(right, 2 * y)[c]) +
                                        (image.at(2 * x, down)[c] + image.at(right, down)[c]));
    });
    return half;
}

// Catmull-Rom's weights a quarter of a pixel after a pixel's middle; in the other order, before it.
constexpr float after[] = {-0.0703125f, 0.8671875f, 0.2265625f, -0.0234375f},
                before[] = {-0.0234375f, 0.2265625f, 0.8671875f, -0.0703125f};

// A row made twice as wide, of `width` pixels; two more lie at either side of `row`.
void double_along(const float* row, std::int64_t width, int channels, float* out) {
    for (std::int64_t x = 0; x < width; ++x) {
        const float* const weights = x % 2 == 0 ? before : after;
        const float* const first = row + (x / 2 - (x % 2 == 0 ? 2 : 1)) * channels;
        for (int c = 0; c < channels; ++c)
            out[x * channels + c] = weights[0] * first[c] + weights[1] * first[channels + c] +
                                    weights[2] * first[2 * channels + c] +
                                    weights[3] * first[3 * channels + c];
    }
}

// Twice as large, cubic; of that the upper left, which may lack the last column and row.
Image twice_as_large(const Image& image, std::int64_t width, std::int64_t height) {
    const std::int64_t pad = 2 * image.channels, count = image.width * image.channels;
    Image large = unfilled_image(width, height, image.channels);
    parallel_chunks(height, 16, [&](std::int64_t begin, std::int64_t end, int) {
        std::vector<float> padded(std::size_t(count + 2 * pad));
        float* const row = padded.data() + pad;
        for (std::int64_t y = begin; y < end; ++y) {
            std::array<const float*, 4> rows;
            for (int k = 0; k < 4; ++k)
                rows[k] = image.at(
                    0, std::clamp<std::int64_t>(y / 2 + k - (y % 2 == 0 ? 2 : 1), 0, image.height - 1));
            weighted_rows(y % 2 == 0 ? before : after, rows, count, row);
            for (std::int64_t i = 0; i < pad; ++i) {
                row[i - pad] = row[i % image.channels];
                row[count + i] = row[count - image.channels + i % image.channels];
            }
            double_along(row, width, image.channels, large.at(0, y));
        }
    });
    return large;
}

Image twice_as_large(const Image& image) { return twice_as_large(image, 2 * image.width, 2 * image.height); }

Image difference(const Image& a, const Image& b) {
    return made_of_values(a, [&](std::size_t i) { return a.pixels[i] - b.pixels[i]; });
}

Image squares(const Image& a) {
    return made_of_values(a, [&](std::size_t i) { return a.pixels[i] * a.pixels[i]; });
}

// What an image has and its half does not.
Image finest_octave(const Image& image, const Image& half) {
    return difference(image, twice_as_large(half, image.width, image.height));
}

// A luminance's two finest octaves.
struct FinestOctaves {
    Image fine, next;  // `next`: half as large
};

FinestOctaves finest_octaves(const Image& luminance) {
    const Image half = half_by_area(luminance);
    return {finest_octave(luminance, half), finest_octave(half, half_by_area(half))};
}

// An octave's amplitude all over a picture: between median and mean, so that what is bright does not rule.
double amplitude_of(const Image& octave) {
    const Image all = squares(octave);
    double sum = 0.0;
    for (const float square : all.pixels) sum += double(square);
    Image local = gaussian_blur(all, 4.0);
    return std::sqrt(
        std::sqrt(std::max(0.0, double(median(local.pixels))) * sum / double(all.pixels.size())));
}

}  // namespace

Image octaves_larger(Image image, int octaves) {
    for (int i = 0; i < octaves; ++i) image = twice_as_large(image);
    return image;
}

float detail_slope(const Image& light) {
    constexpr double least = 1e-5;  // of flat light, which has no slope, there is only rounding
    const FinestOctaves octaves = finest_octaves(luminance(logarithms(light)));
    return float(std::clamp(amplitude_of(octaves.fine) / (amplitude_of(octaves.next) + least), 0.5, 0.95));
}

namespace {

// Deviation of what is quiet about a pixel: a power mean that a front does not rule.
Image quiet_deviation(const Image& octave, float gain, double blur_px) {
    Image level = made_of_values(
        octave, [&](std::size_t i) { return 1.0f / std::sqrt(std::fabs(octave.pixels[i] * gain) + 1e-4f); });
    level = gaussian_blur(level, blur_px);
    change_values(level, [&](std::size_t i) {
        const float root = level.pixels[i] * (1.0f / 1.72f);
        return 1.0f / (root * root);
    });
    return level;
}

// The same amplitude where it is quiet. The least of a square, for that of a front must not spread beside it.
Image quiet_amplitude(const FinestOctaves& octaves, float slope) {
    constexpr std::int64_t reach_px = 2;
    Image mean = quiet_deviation(octaves.fine, 1.0f, 2.5);
    const Image next = twice_as_large(quiet_deviation(octaves.next, 1.0f, 1.75), mean.width, mean.height);
    change_values(mean, [&](std::size_t i) {
        return std::sqrt(mean.pixels[i] * std::max(0.0f, next.pixels[i]) * slope);
    });
    Image least = unfilled_image(mean.width, mean.height, 1);
    for_each_pixel(least, [&](std::int64_t x, std::int64_t y) {
        float value = *mean.at(x, y);
        for_each_about(mean, x, y, reach_px,
                       [&](std::int64_t i, std::int64_t j) { value = std::min(value, *mean.at(i, j)); });
        *least.at(x, y) = value;
    });
    least = gaussian_blur(least, 1.5);
    change_values(least, [&](std::size_t i) { return 1.15f * slope * least.pixels[i]; });
    return least;
}

// Copied details are means, and so too small: by 1.22 to more than 1.25, that is DETAIL 3's limit, in both
// octaves of the Pillars, the Crab and M101.
constexpr float gain_of_copies = 1.25f;

// Of unit variance wherever one looks. (first_x, first_y): where it begins in that of the whole picture.
Image even_noise(std::int64_t width, std::int64_t height, std::int64_t first_x, std::int64_t first_y,
                 std::uint32_t seed) {
    Image white = unfilled_image(width, height, 1);
    for_each_pixel(white, [&](std::int64_t x, std::int64_t y) {
        const std::uint32_t h = shared::as_hash(seed, std::uint32_t(first_x + x), std::uint32_t(first_y + y),
                                                shared::PURPOSE_DETAIL);
        *white.at(x, y) = float(int(h & 0xffffu) + int(h >> 16) - 0xffff) * (1.0f / 65536.0f);
    });
    white = gaussian_blur(white, 0.45);
    Image noise = difference(white, gaussian_blur(white, 1.1));
    const Image power = gaussian_blur(squares(noise), 6.0);
    change_values(noise,
                  [&](std::size_t i) { return noise.pixels[i] / (std::sqrt(power.pixels[i]) + 1e-6f); });
    return noise;
}

// Adds noise where the details, of luminance, are quieter than the picture lets expect. `noise`: as large.
Image quiet_fill(const Image& details, const FinestOctaves& octaves, const DetailWish& wish, Image noise) {
    const Image wanted = twice_as_large(quiet_amplitude(octaves, wish.slope)),
                have = quiet_deviation(details, gain_of_copies, 3.0);
    change_values(noise, [&](std::size_t i) {
        const float w = std::max(0.0f, wanted.pixels[i]), h = have.pixels[i];
        return float(wish.strength) * std::sqrt(std::max(0.0f, w * w - h * h)) * noise.pixels[i];
    });
    return noise;
}

// The last step: the mean of what lies in each of the picture's pixels becomes that pixel.
void scale_to_means(Image& detail, const Image& picture) {
    const std::int64_t times = detail.width / picture.width;
    for_each_pixel(picture, [&](std::int64_t x, std::int64_t y) {
        for (int c = 0; c < picture.channels; ++c) {
            const double mean = double(picture.at(x, y)[c]);
            double sum = 0.0;
            const auto visit = [&](const auto& change) {
                for_each_between(detail, times * x, times * y, times * (x + 1) - 1, times * (y + 1) - 1,
                                 [&](std::int64_t i, std::int64_t j) { change(detail.at(i, j)[c]); });
            };
            visit([&](float& value) { sum += double(value); });
            const double ratio = sum > 0.0 ? mean * double(times * times) / sum : 0.0;
            visit([&](float& value) { value = float(sum > 0.0 ? ratio * double(value) : mean); });
        }
    });
}

// Area means become those of `picture`, half as large: smoothly where that can be, then exactly.
void keep_means(Image& detail, const Image& picture) {
    constexpr int rounds = 3;
    for (int round = 0; round < rounds; ++round) {
        Image ratio = half_by_area(detail);
        change_values(ratio, [&](std::size_t i) {
            return std::clamp((picture.pixels[i] + dark_offset) / (ratio.pixels[i] + dark_offset), 0.5f,
                              2.0f);
        });
        const Image factor = twice_as_large(ratio);
        change_values(detail, [&](std::size_t i) {
            return std::max(0.0f, (detail.pixels[i] + dark_offset) * factor.pixels[i] - dark_offset);
        });
    }
    scale_to_means(detail, picture);
}

Exemplar exemplar_of(const Image& light, const Image& sources) {
    const Image logs = logarithms(light);
    const Image coarse = twice_as_large(half_by_area(logs), logs.width, logs.height);
    return {luminance(coarse), difference(logs, coarse), sources};
}

// `light` twice as large with what is invented, its area means not yet those of `light`. `times`: of the
// known picture's size, afterwards.
Image invented(const Image& light, const Exemplar& known, int times, const DetailWish& wish,
               const Progress& progress) {
    const Image logs = logarithms(light);
    const FinestOctaves octaves = finest_octaves(luminance(logs));
    Image detail = twice_as_large(logs);
    const PatchPlace place{times * wish.x, times * wish.y};
    const Image copies = exemplar_details(luminance(detail), known, times, place, wish.seed, progress);
    progress.check();
    Image own = luminance(copies);
    own = difference(own, gaussian_blur(own, 1.1));
    const Image fill = quiet_fill(
        own, octaves, wish,
        even_noise(detail.width, detail.height, place.x, place.y, wish.seed + std::uint32_t(times)));
    const float px = 1.0f / float(times);
    const int octave = times / 2;
    for_each_pixel(detail, [&](std::int64_t x, std::int64_t y) {
        float* const value = detail.at(x, y);
        const float share = wish.share ? wish.share(float(wish.x) + (float(x) + 0.5f) * px,
                                                    float(wish.y) + (float(y) + 0.5f) * px, octave)
                                       : 1.0f;
        for (int c = 0; c < light.channels; ++c) {
            const float log = value[c] + share * (copies.at(x, y)[c] * gain_of_copies + *fill.at(x, y));
            value[c] = std::max(0.0f, shared::as_exp(log) - dark_offset);
        }
    });
    return detail;
}

Image with_next_octave(const Image& light, const Exemplar& known, int times, const DetailWish& wish,
                       const Progress& progress) {
    Image detail = invented(light, known, times, wish, progress.part(0.0, 0.6));
    progress.check();
    keep_means(detail, light);
    progress.at(1.0);
    return detail;
}

}  // namespace

Image detail_picture(const Image& light, const Image& sources, const DetailWish& wish,
                     const Progress& progress) {
    assert((light.channels == 1 || light.channels == 3) && (wish.octaves == 1 || wish.octaves == 2));
    assert(sources.pixels.empty() || (sources.width == light.width && sources.height == light.height));
    claim_memory((light.width * light.height * bytes_a_detail_pixel) << (2 * wish.octaves),
                 "a picture's details");
    const Exemplar known = exemplar_of(light, sources);
    const double first_share = wish.octaves == 1 ? 1.0 : 0.2;
    Image detail = with_next_octave(light, known, 2, wish, progress.part(0.0, first_share));
    if (wish.octaves == 1) return detail;
    detail = with_next_octave(detail, known, 4, wish, progress.part(first_share, 1.0));
    scale_to_means(detail, light);
    return detail;
}

}  // namespace astrosplat
