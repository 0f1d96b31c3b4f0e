// Differences of two images, in one pass over the rows and one selection for the percentile. Stored frames
// are read in bands of rows, as floats: 8 and 16 bits and halves have floats of their own each, and 32-bit
// counts are stored as floats.
#include "output/compare.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/real.h"
#include "source/open_picture.h"
#include "source/texture.h"

// fmt first: OpenImageIO brings a copy of it with other settings.

namespace astrosplat {
namespace {

bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

double difference(float a, float b) {
    if (same_bits(a, b)) return 0.0;
    double d = std::fabs(double(a) - double(b));
    return std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
}

// A value that occurs; percentile() of core/sorting.h copies its values, and there is one a pixel here.
double nearest_rank(std::vector<double>& values, double share) {
    if (values.empty()) return 0.0;
    auto rank = std::size_t(std::ceil(share * double(values.size())));
    auto at = values.begin() + std::ptrdiff_t(std::max<std::size_t>(rank, 1) - 1);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

double psnr(double mean_square) {
    if (mean_square == 0.0) return std::numeric_limits<double>::infinity();
    return -10.0 * real::log(mean_square) / real::log(10.0);
}

}  // namespace

ImageComparison compare_images(const Image& a, const Image& b) {
    assert(a.width == b.width && a.height == b.height && a.channels == b.channels);
    ImageComparison result;
    result.width = a.width;
    result.height = a.height;
    std::vector<double> of_pixel(std::size_t(a.width * a.height), 0.0);
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < of_pixel.size(); ++i) {
        bool differs = false;
        for (int c = 0; c < a.channels; ++c) {
            std::size_t k = i * std::size_t(a.channels) + std::size_t(c);
            double d = difference(a.pixels[k], b.pixels[k]);
            differs = differs || !same_bits(a.pixels[k], b.pixels[k]);
            sum += d;
            squares += d * d;
            of_pixel[i] = std::fmax(of_pixel[i], d);
            if (!(d > result.max_difference)) continue;
            result.max_difference = d;
            result.max_x = std::int64_t(i) % a.width;
            result.max_y = std::int64_t(i) / a.width;
            result.max_channel = c;
        }
        if (differs) ++result.differing_pixels;
    }
    double values = std::fmax(1.0, double(a.pixels.size()));
    result.mean_difference = sum / values;
    result.psnr_db = psnr(squares / values);
    result.percentile_999 = nearest_rank(of_pixel, 0.999);
    return result;
}

ImageComparison compare_files(const fs::path& a, const fs::path& b) {
    Image first = load_linear_image(a), second = load_linear_image(b);
    if (first.width != second.width || first.height != second.height)
        bad_input(b, fmt::format("{} x {} pixels as in {}", first.width, first.height, a.string()),
                  fmt::format("{} x {}", second.width, second.height));
    return compare_images(first, second);
}

namespace {

/// Size and channels, which two files must share to be compared.
std::string form_of(const OIIO::ImageSpec& spec) {
    std::string text = fmt::format("{}x{} px", spec.width, spec.height);
    if (spec.x != 0 || spec.y != 0) text += fmt::format(" at {},{}", spec.x, spec.y);
    for (int c = 0; c < spec.nchannels; ++c)
        text += fmt::format(", {} {}", spec.channel_name(c), spec.channelformat(c).c_str());
    return text;
}

using OpenFrame = std::unique_ptr<OIIO::ImageInput>;

/// Rows begin .. end from the top of what is stored; false: damaged.
bool read_values(OIIO::ImageInput& in, int begin, int end, std::vector<float>& values) {
    const OIIO::ImageSpec& spec = in.spec();
    values.resize(std::size_t(end - begin) * std::size_t(spec.width) * std::size_t(spec.nchannels));
    return read_rows(in, begin, end, OIIO::TypeDesc::FLOAT, values.data());
}

/// Sums over rows.
struct StoredSums {
    const OIIO::ImageSpec& spec;
    StoredComparison sums = {};
    double squares = 0.0;     // of colours' differences
    std::int64_t colors = 0;  // values of colours

    void add_rows(int begin, const std::vector<float>& a, const std::vector<float>& b) {
        const auto channels = std::size_t(spec.nchannels);
        const auto width = std::size_t(spec.width);
        for (std::size_t pixel = 0; pixel * channels < a.size(); ++pixel) {
            const int x = int(pixel % width), y = begin + int(pixel / width);
            bool differs = false;
            for (std::size_t c = 0; c < channels; ++c)
                differs = add_value(x, y, c, a[pixel * channels + c], b[pixel * channels + c]) || differs;
            sums.differing_pixels += differs;
        }
    }
    StoredComparison result() const {
        StoredComparison result = sums;
        result.pixels = std::int64_t{spec.width} * spec.height;
        result.psnr_db = psnr(squares / std::fmax(1.0, double(colors)));
        return result;
    }

    /// True when the two are not the same.
    bool add_value(int x, int y, std::size_t channel, float a, float b) {
        const std::string& name = spec.channelnames[channel];
        const bool color = name.size() == 1 && name.find_first_of("RGBA") == 0;
        colors += color;
        if (same_bits(a, b)) return false;
        const double d = difference(a, b);
        if (color) squares += d * d;
        if (sums.max_channel.empty() || d > sums.max_difference) {
            sums.max_difference = d;
            sums.max_x = spec.x + x;
            sums.max_y = spec.y + y;
            sums.max_channel = name;
        }
        return true;
    }
};

OpenFrame open_if_readable(const fs::path& file) try {
    return open_picture(file);
} catch (const InputError&) {
    return nullptr;
}

}  // namespace

StoredComparison compare_stored(const fs::path& first, const fs::path& second) {
    StoredComparison comparison;
    comparison.result = StoredComparison::Result::first_damaged;
    const OpenFrame a = open_if_readable(first), b = open_picture(second);
    if (!a) return comparison;
    const OIIO::ImageSpec& spec = b->spec();
    if (form_of(a->spec()) != form_of(spec)) {
        comparison.result = StoredComparison::Result::other_form;
        comparison.other_form = form_of(a->spec()) + " against " + form_of(spec);
        return comparison;
    }
    StoredSums sums{spec};
    std::vector<float> rows_a, rows_b;
    constexpr int band = 256;  // rows
    for (int y = 0; y < spec.height; y += band) {
        const int end = std::min(y + band, spec.height);
        if (!read_values(*a, y, end, rows_a)) return comparison;
        if (!read_values(*b, y, end, rows_b)) fail_picture(second, "it ends early");
        sums.add_rows(y, rows_a, rows_b);
    }
    return sums.result();
}

}  // namespace astrosplat
