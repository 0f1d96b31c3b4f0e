#include "image/resample.h"

#include <glm/matrix.hpp>
#include <numeric>

#include "core/parallel.h"
#include "image/blur.h"

namespace astrosplat {
namespace {

// Which of the old pixels along a side a new one covers, and its share of each.
struct Cover {
    std::int64_t first = 0;
    std::vector<float> shares;
};

Cover cover_of(std::int64_t i, std::int64_t before, std::int64_t after) {
    const double width = double(before) / double(after);
    const double begin = double(i) * width, end = double(i + 1) * width;
    Cover cover{std::int64_t(begin), {}};
    for (std::int64_t k = cover.first; k < before && double(k) < end; ++k) {
        const double lo = std::max(begin, double(k)), hi = std::min(end, double(k + 1));
        cover.shares.push_back(float((hi - lo) / width));
    }
    return cover;
}

float light(float value) { return value > 0.0f && std::isfinite(value) ? value : 0.0f; }

// Towards its neighbours, linearly: a pixel's values at the middles of its parts, row by row.
class Parts {
  public:
    explicit Parts(int times) : values(std::size_t(times) * std::size_t(times)) {
        for (int i = 0; i < times; ++i) offsets_.push_back((float(i) + 0.5f) / float(times) - 0.5f);
    }

    void set(const float (&around)[3][3]) {
        std::size_t at = 0;
        for (const float y : offsets_) {
            const int row = y < 0.0f ? 0 : 2;
            for (const float x : offsets_) {
                const int column = x < 0.0f ? 0 : 2;
                const float a = std::fabs(x), b = std::fabs(y);
                values[at++] = (1.0f - b) * ((1.0f - a) * around[1][1] + a * around[1][column]) +
                               b * ((1.0f - a) * around[row][1] + a * around[row][column]);
            }
        }
        const float sum = std::accumulate(values.begin(), values.end(), 0.0f);
        const float gain = sum > 0.0f ? around[1][1] * float(values.size()) / sum : 0.0f;
        for (float& value : values) value *= gain;
    }

    std::vector<float> values;

  private:
    std::vector<float> offsets_;  // of the parts' middles, in pixels
};

class Reduction {
  public:
    Reduction(std::int64_t width_before, std::int64_t height_before, int channels, std::int64_t width,
              std::int64_t height)
        : width_before_(width_before),
          height_before_(height_before),
          out_(make_image(width, height, channels)) {
        assert(0 < width && width <= width_before && 0 < height && height <= height_before);
        for (std::int64_t x = 0; x < width; ++x) columns_.push_back(cover_of(x, width_before, width));
    }

    Cover rows_under(std::int64_t y) const { return cover_of(y, height_before_, out_.height); }

    // Rows of the result; row(y) gives those of the image that they cover.
    template <class Row>
    void make(std::int64_t begin, std::int64_t end, const Row& row) {
        parallel_each(end - begin, 4, [&](std::int64_t i) {
            const Cover under = rows_under(begin + i);
            std::vector<const float*> covered;
            for (std::size_t k = 0; k < under.shares.size(); ++k)
                covered.push_back(row(under.first + std::int64_t(k)));
            make_row(under, covered, begin + i);
        });
    }

    Image take() { return std::move(out_); }

  private:
    void make_row(const Cover& under, std::span<const float* const> covered, std::int64_t y) {
        Image row = unfilled_image(width_before_, 1, out_.channels);
        weighted_rows(under.shares, covered, width_before_ * out_.channels, row.pixels.data());
        for (std::int64_t x = 0; x < out_.width; ++x) {
            const Cover& column = columns_[x];
            for (std::size_t k = 0; k < column.shares.size(); ++k)
                for (int c = 0; c < out_.channels; ++c)
                    out_.at(x, y)[c] += column.shares[k] * row.at(column.first + std::int64_t(k), 0)[c];
        }
    }

    std::int64_t width_before_, height_before_;
    std::vector<Cover> columns_;
    Image out_;
};

// Rows of an image in order, of which only those are held that are still to be used.
class RowWindow {
  public:
    explicit RowWindow(const ImageRows& rows) : rows_(rows), row_floats_(rows.width * rows.channels) {}

    // Begins no earlier, and ends no earlier, than the last time.
    void move_to(std::int64_t begin, std::int64_t end) {
        const std::int64_t kept = std::max<std::int64_t>(0, end_ - begin);
        std::copy(values_.end() - kept * row_floats_, values_.end(), values_.begin());
        values_.resize(std::size_t((end - begin) * row_floats_));
        rows_.read(begin + kept, end, values_.data() + kept * row_floats_);
        begin_ = begin;
        end_ = end;
    }
    const float* row(std::int64_t y) const { return values_.data() + (y - begin_) * row_floats_; }

  private:
    const ImageRows& rows_;
    std::int64_t row_floats_, begin_ = 0, end_ = 0;
    Buffer<float> values_;
};

// Two neighbouring texels along an axis of n and the share of the second.
struct Neighbours {
    std::int64_t first, second;
    float share;
};

Neighbours neighbours(double place, std::int64_t n) {
    const double at = std::clamp(place - 0.5, 0.0, double(n - 1));
    const double below = std::floor(at);
    const auto first = std::int64_t(below);
    return {first, std::min(first + 1, n - 1), float(at - below)};
}

void sample_linearly(const Image& image, const glm::dvec2& place, float* out) {
    const bool inside =
        place.x >= 0.0 && place.y >= 0.0 && place.x <= double(image.width) && place.y <= double(image.height);
    if (!inside) return;
    const Neighbours x = neighbours(place.x, image.width), y = neighbours(place.y, image.height);
    const float* const a = image.at(x.first, y.first);
    const float* const b = image.at(x.second, y.first);
    const float* const c = image.at(x.first, y.second);
    const float* const d = image.at(x.second, y.second);
    for (int i = 0; i < image.channels; ++i) {
        const float top = a[i] + (b[i] - a[i]) * x.share, bottom = c[i] + (d[i] - c[i]) * x.share;
        out[i] = top + (bottom - top) * y.share;
    }
}

}  // namespace

ImageRows rows_of(Image image) {
    const auto held = std::make_shared<const Image>(std::move(image));
    return {held->width, held->height, held->channels,
            [held](std::int64_t begin, std::int64_t end, float* rows) {
                std::copy(held->at(0, begin), held->at(0, end), rows);
            }};
}

Image read_whole(const ImageRows& rows) {
    Image image = unfilled_image(rows.width, rows.height, rows.channels);
    const std::int64_t at_once = strip_rows(rows);
    for (std::int64_t begin = 0; begin < rows.height; begin += at_once)
        rows.read(begin, std::min(rows.height, begin + at_once), image.at(0, begin));
    return image;
}

ImageSize size_of_area(std::int64_t width, std::int64_t height, double area, double smallest_px) {
    const auto w = double(width), h = double(height);
    const double least = std::min(1.0, smallest_px / std::min(w, h));
    const double side = std::clamp(std::sqrt(area / (w * h)), least, 1.0);
    return {std::llround(side * w), std::llround(side * h)};
}

std::int64_t strip_rows(const ImageRows& rows) {
    constexpr std::int64_t floats = std::int64_t{1} << 23;
    return std::clamp<std::int64_t>(floats / std::max<std::int64_t>(1, rows.width * rows.channels), 1,
                                    rows.height);
}

Image reduced_by_area(const ImageRows& rows, std::int64_t width, std::int64_t height) {
    Reduction reduction(rows.width, rows.height, rows.channels, width, height);
    RowWindow window(rows);
    const std::int64_t at_once = std::max<std::int64_t>(1, strip_rows(rows) * height / rows.height);
    for (std::int64_t begin = 0; begin < height; begin += at_once) {
        const std::int64_t end = std::min(height, begin + at_once);
        const Cover last = reduction.rows_under(end - 1);
        window.move_to(reduction.rows_under(begin).first, last.first + std::int64_t(last.shares.size()));
        reduction.make(begin, end, [&](std::int64_t y) { return window.row(y); });
    }
    return reduction.take();
}

Image reduced_by_area(const Image& image, std::int64_t width, std::int64_t height) {
    Reduction reduction(image.width, image.height, image.channels, width, height);
    reduction.make(0, height, [&](std::int64_t y) { return image.at(0, y); });
    return reduction.take();
}

Image reduced_to_width(const Image& image, std::int64_t most_px) {
    const std::int64_t width = std::min(most_px, image.width);
    return reduced_by_area(image, width, std::max<std::int64_t>(1, image.height * width / image.width));
}

Image enlarged(const Image& image, int times) {
    Image out = unfilled_image(image.width * times, image.height * times, image.channels);
    parallel_each(image.height, 16, [&](std::int64_t y) {
        Parts parts(times);
        for (std::int64_t x = 0; x < image.width; ++x) {
            for (int c = 0; c < image.channels; ++c) {
                float around[3][3];
                for (int j = 0; j < 3; ++j)
                    for (int i = 0; i < 3; ++i)
                        around[j][i] =
                            light(image.at(std::clamp(x + i - 1, std::int64_t{0}, image.width - 1),
                                           std::clamp(y + j - 1, std::int64_t{0}, image.height - 1))[c]);
                parts.set(around);
                for (int j = 0; j < times; ++j)
                    for (int i = 0; i < times; ++i)
                        out.at(x * times + i, y * times + j)[c] = parts.values[j * times + i];
            }
        }
    });
    return out;
}

PixelMap map_to_width(const Image& image, std::int64_t width, std::int64_t height) {
    const double scale = double(image.width) / double(width);
    PixelMap map;
    map.linear *= scale;
    map.offset.y = 0.5 * (double(image.height) - scale * double(height));
    return map;
}

Image resampled(const Image& image, const PixelMap& texel_from_pixel, std::int64_t width, std::int64_t height,
                double sigma_px) {
    const double texels_per_pixel = std::sqrt(std::fabs(glm::determinant(texel_from_pixel.linear)));
    const Image filtered = convolved_with_gaussian(image, sigma_px * texels_per_pixel);
    Image out = make_image(width, height, image.channels);
    parallel_each(height, 16, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < width; ++x) {
            const glm::dvec2 center(double(x) + 0.5, double(y) + 0.5);
            sample_linearly(filtered, texel_from_pixel.offset + texel_from_pixel.linear * center,
                            out.at(x, y));
        }
    });
    return out;
}

}  // namespace astrosplat
