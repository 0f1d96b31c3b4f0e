#include "image/area.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/parallel.h"
#include "image/weighted_rows.h"

namespace astrosplat {
namespace {

// Which of the old pixels along a side a new one covers, and its share of each.
struct Cover {
    std::int64_t first = 0;
    std::vector<float> shares;
};

Cover cover_of(std::int64_t i, std::int64_t before, std::int64_t after) {
    const double width = static_cast<double>(before) / static_cast<double>(after);
    const double begin = static_cast<double>(i) * width, end = static_cast<double>(i + 1) * width;
    Cover cover{static_cast<std::int64_t>(begin), {}};
    for (std::int64_t k = cover.first; k < before && static_cast<double>(k) < end; ++k) {
        const double lo = std::max(begin, static_cast<double>(k)),
                     hi = std::min(end, static_cast<double>(k + 1));
        cover.shares.push_back(static_cast<float>((hi - lo) / width));
    }
    return cover;
}

float light(float value) { return value > 0.0f && std::isfinite(value) ? value : 0.0f; }

// Towards its neighbours, linearly: a pixel's values at the middles of its parts, row by row.
class Parts {
  public:
    explicit Parts(int times) : values(static_cast<std::size_t>(times) * static_cast<std::size_t>(times)) {
        for (int i = 0; i < times; ++i)
            offsets_.push_back((static_cast<float>(i) + 0.5f) / static_cast<float>(times) - 0.5f);
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
        const float gain = sum > 0.0f ? around[1][1] * static_cast<float>(values.size()) / sum : 0.0f;
        for (float& value : values) value *= gain;
    }

    std::vector<float> values;

  private:
    std::vector<float> offsets_;  // of the parts' middles, in pixels
};

}  // namespace

Image reduced_by_area(const Image& image, std::int64_t width, std::int64_t height) {
    assert(0 < width && width <= image.width && 0 < height && height <= image.height);
    std::vector<Cover> columns;
    for (std::int64_t x = 0; x < width; ++x) columns.push_back(cover_of(x, image.width, width));
    Image out = make_image(width, height, image.channels);
    parallel_each(height, 16, [&](std::int64_t y) {
        const Cover rows = cover_of(y, image.height, height);
        std::vector<const float*> covered;
        for (std::size_t k = 0; k < rows.shares.size(); ++k)
            covered.push_back(image.at(0, rows.first + static_cast<std::int64_t>(k)));
        Image row{image.width, 1, image.channels, {}};
        row.pixels.resize(static_cast<std::size_t>(image.width * image.channels));
        weighted_rows(rows.shares, covered, image.width * image.channels, row.pixels.data());
        for (std::int64_t x = 0; x < width; ++x) {
            const Cover& column = columns[static_cast<std::size_t>(x)];
            for (std::size_t k = 0; k < column.shares.size(); ++k)
                for (int c = 0; c < image.channels; ++c)
                    out.at(x, y)[c] +=
                        column.shares[k] * row.at(column.first + static_cast<std::int64_t>(k), 0)[c];
        }
    });
    return out;
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
                        out.at(x * times + i, y * times + j)[c] =
                            parts.values[static_cast<std::size_t>(j * times + i)];
            }
        }
    });
    return out;
}

}  // namespace astrosplat
