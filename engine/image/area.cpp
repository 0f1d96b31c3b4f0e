#include "image/area.h"

#include <algorithm>
#include <cassert>
#include <cmath>
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

}  // namespace astrosplat
