// Separable passes over contiguous floats, strip by strip: along the rows of a strip, then down its columns.
// Windows of the opening grow by doubling: from n to 2n.
#include "image/blur.h"

#include "core/parallel.h"
#include "core/real.h"

namespace astrosplat {
namespace {

constexpr double halving_variance = 1.5;  // px^2 of halving and doubling together
constexpr std::int64_t rows_per_chunk = 16, rows_per_strip = 64;

// Index of the mirrored image: ... 1 0 | 0 1 2 ... n-1 | n-1 n-2 ...
std::int64_t mirrored(std::int64_t i, std::int64_t n) {
    const std::int64_t period = 2 * n;
    i = ((i % period) + period) % period;
    return i < n ? i : period - 1 - i;
}

std::vector<float> gaussian_weights(double sigma) {
    const auto radius = std::int64_t(4.0 * sigma + 0.5);
    std::vector<double> w;
    double sum = 0.0;
    for (std::int64_t i = -radius; i <= radius; ++i) {
        const double t = double(i) / sigma;
        w.push_back(real::exp(-0.5 * t * t));
        sum += w.back();
    }
    std::vector<float> weights;
    for (const double v : w) weights.push_back(float(v / sum));
    return weights;
}

// One row of `width` pixels from `middle` on gets `margin` mirrored pixels at either side.
void mirror_ends(float* middle, std::int64_t width, int channels, std::int64_t margin) {
    for (std::int64_t i = 0; i < margin; ++i) {
        std::copy_n(middle + mirrored(-1 - i, width) * channels, channels, middle - (1 + i) * channels);
        std::copy_n(middle + mirrored(width + i, width) * channels, channels,
                    middle + (width + i) * channels);
    }
}

// Rows of a strip blurred along themselves, those that the columns' kernel reaches beyond it included, each
// once: beyond the image lie the same ones. Its memory serves strip after strip.
class BlurredRows {
  public:
    void fill(const Image& image, const std::vector<float>& weights, std::int64_t begin, std::int64_t end) {
        const auto margin = std::int64_t(weights.size() / 2);
        height_ = image.height;
        first_ = std::max<std::int64_t>(begin - margin, 0);
        count_ = image.width * image.channels;
        const std::int64_t rows = std::min(end + margin, height_) - first_;
        values_.resize(std::size_t(rows * count_));
        padded_.resize(std::size_t(count_ + 2 * margin * image.channels));
        float* const middle = padded_.data() + margin * image.channels;
        std::vector<const float*> shifted;
        for (std::size_t k = 0; k < weights.size(); ++k)
            shifted.push_back(padded_.data() + std::int64_t(k) * image.channels);
        for (std::int64_t row = 0; row < rows; ++row) {
            std::copy_n(image.at(0, first_ + row), count_, middle);
            mirror_ends(middle, image.width, image.channels, margin);
            weighted_rows(weights, shifted, count_, values_.data() + row * count_);
        }
    }

    const float* row(std::int64_t y) const {
        return values_.data() + (mirrored(y, height_) - first_) * count_;
    }

  private:
    std::int64_t height_ = 0, first_ = 0, count_ = 0;
    Buffer<float> values_, padded_;
};

// The four rows or columns that the pixel at 2 i + 1/2 averages.
const std::vector<float> binomial{0.125f, 0.375f, 0.375f, 0.125f};

// A row's pixels averaged by fours; two more lie at either side of `from`.
template <int channels>
void halve_row(const float* from, std::int64_t width, float* to) {
    const float a = binomial[0], b = binomial[1];
    for (std::int64_t x = 0; x < width; ++x) {
        const float* const p = from + (2 * x - 1) * channels;
        for (int c = 0; c < channels; ++c)
            to[x * channels + c] =
                a * p[c] + b * p[channels + c] + b * p[2 * channels + c] + a * p[3 * channels + c];
    }
}

// `width` pixels between a row's own; one more lies at either side of `from`.
template <int channels>
void double_row(const float* from, std::int64_t width, float* to) {
    const auto between = [&](std::int64_t x, std::int64_t side) {
        const float* const p = from + (x / 2) * channels;
        for (int c = 0; c < channels; ++c)
            to[x * channels + c] = 0.75f * p[c] + 0.25f * p[side * channels + c];
    };
    for (std::int64_t x = 0; x + 1 < width; x += 2) {
        between(x, -1);
        between(x + 1, 1);
    }
    if (width % 2 == 1) between(width - 1, -1);
}

using RowStep = void (*)(const float* from, std::int64_t width, float* to);

// By the number of channels, from 1.
constexpr int most_channels = 5;
constexpr RowStep halve_rows[] = {halve_row<1>, halve_row<2>, halve_row<3>, halve_row<4>, halve_row<5>},
                  double_rows[] = {double_row<1>, double_row<2>, double_row<3>, double_row<4>, double_row<5>};

constexpr std::int64_t columns_per_strip = 32;

// Replaces each of `count` values, groups of `width` floats, by the extreme of those up to `reach` away.
// `line`: room for count + 2 reach groups.
template <class Extreme>
void filter_line(std::vector<float>& line, std::int64_t count, std::int64_t width, std::int64_t reach,
                 Extreme extreme) {
    const std::int64_t total = count + 2 * reach, window = 2 * reach + 1;
    for (std::int64_t i = 0; i < reach; ++i) {
        std::copy_n(line.begin() + reach * width, width, line.begin() + i * width);
        std::copy_n(line.begin() + (reach + count - 1) * width, width,
                    line.begin() + (reach + count + i) * width);
    }
    // Makes windows of `size` + `shift` of such of `size`.
    const auto join = [&](std::int64_t size, std::int64_t shift) {
        const std::int64_t values = (total - size - shift + 1) * width;
        float* const to = line.data();
        const float* const from = to + shift * width;
        for (std::int64_t i = 0; i < values; ++i) to[i] = extreme(to[i], from[i]);
    };
    std::int64_t size = 1;
    for (; 2 * size <= window; size *= 2) join(size, size);
    if (size < window) join(size, window - size);
}

template <class Extreme>
void filter(Image& image, std::int64_t reach, Extreme extreme) {
    parallel_chunks(image.height, 16, [&](std::int64_t begin, std::int64_t end, int) {
        std::vector<float> line(std::size_t(image.width + 2 * reach));
        for (std::int64_t y = begin; y < end; ++y) {
            std::copy_n(image.at(0, y), image.width, line.begin() + reach);
            filter_line(line, image.width, 1, reach, extreme);
            std::copy_n(line.begin(), image.width, image.at(0, y));
        }
    });
    parallel_chunks(image.width, columns_per_strip, [&](std::int64_t begin, std::int64_t end, int) {
        const std::int64_t width = end - begin;
        std::vector<float> line(std::size_t((image.height + 2 * reach) * width));
        for (std::int64_t y = 0; y < image.height; ++y)
            std::copy_n(image.at(begin, y), width, line.begin() + (reach + y) * width);
        filter_line(line, image.height, width, reach, extreme);
        for (std::int64_t y = 0; y < image.height; ++y)
            std::copy_n(line.begin() + y * width, width, image.at(begin, y));
    });
}

}  // namespace

Image convolved_with_gaussian(const Image& image, double sigma_px) {
    assert(sigma_px >= 0.0);
    if (sigma_px < 0.125 || image.width == 0 || image.height == 0) return image;  // the kernel is one pixel
    const std::vector<float> weights = gaussian_weights(sigma_px);
    const auto margin = std::int64_t(weights.size() / 2);
    Image out = unfilled_image(image.width, image.height, image.channels);
    std::vector<BlurredRows> of_worker(thread_count());
    parallel_chunks(image.height, rows_per_strip, [&](std::int64_t begin, std::int64_t end, int worker) {
        BlurredRows& blurred = of_worker[worker];
        blurred.fill(image, weights, begin, end);
        std::vector<const float*> rows(weights.size());
        for (std::int64_t y = begin; y < end; ++y) {
            for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = blurred.row(y - margin + std::int64_t(k));
            weighted_rows(weights, rows, image.width * image.channels, out.at(0, y));
        }
    });
    return out;
}

Image halved(const Image& image) {
    assert(image.channels <= most_channels);
    const int channels = image.channels;
    Image out = unfilled_image((image.width + 1) / 2, (image.height + 1) / 2, channels);
    parallel_each(out.height, rows_per_chunk, [&](std::int64_t y) {
        std::vector<float> sum(std::size_t((image.width + 4) * channels));
        float* const middle = sum.data() + 2 * channels;
        const float* rows[4];
        for (std::int64_t k = 0; k < 4; ++k) rows[k] = image.at(0, mirrored(2 * y + k - 1, image.height));
        weighted_rows(binomial, rows, image.width * channels, middle);
        mirror_ends(middle, image.width, channels, 2);
        halve_rows[channels - 1](middle, out.width, out.at(0, y));
    });
    return out;
}

Image doubled(const Image& image, std::int64_t width, std::int64_t height) {
    assert((width + 1) / 2 == image.width && (height + 1) / 2 == image.height);
    assert(image.channels <= most_channels);
    const int channels = image.channels;
    Image out = unfilled_image(width, height, channels);
    parallel_each(height, rows_per_chunk, [&](std::int64_t y) {
        std::vector<float> row(std::size_t((image.width + 2) * channels));
        const float* const near = image.at(0, y / 2);
        const float* const far = image.at(0, mirrored(y % 2 ? y / 2 + 1 : y / 2 - 1, image.height));
        float* const middle = row.data() + channels;
        for (std::int64_t i = 0; i < image.width * channels; ++i)
            middle[i] = 0.75f * near[i] + 0.25f * far[i];
        mirror_ends(middle, image.width, channels, 1);
        double_rows[channels - 1](middle, width, out.at(0, y));
    });
    return out;
}

namespace {

// `used_up`: the image itself, where it is not wanted any more.
Image blurred(const Image& image, Image* used_up, double sigma_px, double widest_direct_px) {
    if (sigma_px <= widest_direct_px || std::max(image.width, image.height) < 4)
        return convolved_with_gaussian(image, sigma_px);
    const std::int64_t width = image.width, height = image.height;
    const double rest = std::sqrt((sigma_px * sigma_px - halving_variance) / 4.0);
    Image half = halved(image);
    if (used_up) *used_up = {};
    return doubled(blurred(half, &half, rest, widest_direct_px), width, height);
}

}  // namespace

Image gaussian_blur(const Image& image, double sigma_px, double widest_direct_px) {
    return blurred(image, nullptr, sigma_px, widest_direct_px);
}

Image gaussian_blur(Image&& image, double sigma_px, double widest_direct_px) {
    return blurred(image, &image, sigma_px, widest_direct_px);
}

Image opened(Image image, std::int64_t reach_px) {
    assert(image.channels == 1 && reach_px >= 0);
    if (image.pixels.empty()) return image;
    filter(image, reach_px, [](float a, float b) { return std::min(a, b); });
    filter(image, reach_px, [](float a, float b) { return std::max(a, b); });
    return image;
}

}  // namespace astrosplat
