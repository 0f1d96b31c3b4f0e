#include "source/value_layout.h"

#include "core/buffer.h"
#include "core/parallel.h"

namespace astrosplat {
namespace {

using Values = ValueLayout::Values;

// Rows [first, first + rows) of a mosaic of which those from `held` on are there.
void demosaic(const ValueLayout& layout, std::int64_t first, std::int64_t rows, const Buffer<double>& mosaic,
              std::int64_t held, double* rgb) {
    const std::int64_t end = held + std::ssize(mosaic) / layout.width;
    const auto channel = [&](std::int64_t x, std::int64_t y) {
        return layout.pattern[std::size_t(2 * (y & 1) + (x & 1))];
    };
    const auto value = [&](std::int64_t x, std::int64_t y) { return mosaic[(y - held) * layout.width + x]; };
    parallel_each(rows, 16, [&](std::int64_t row) {
        const std::int64_t y = first + row;
        for (std::int64_t x = 0; x < layout.width; ++x) {
            double sum[3] = {}, count[3] = {};
            for (std::int64_t v = std::max(y - 1, held); v <= y + 1 && v < end; ++v)
                for (std::int64_t u = std::max<std::int64_t>(x - 1, 0); u <= x + 1 && u < layout.width; ++u) {
                    sum[channel(u, v)] += value(u, v);
                    count[channel(u, v)] += 1.0;
                }
            double* const to = rgb + 3 * (row * layout.width + x);
            for (int c = 0; c < 3; ++c) to[c] = sum[c] / count[c];
            to[channel(x, y)] = value(x, y);
        }
    });
}

// Rows [begin, end) of the file.
void read_file_rows(const ValueLayout& layout, const ValueReader& read, std::int64_t begin, std::int64_t end,
                    double* values) {
    const std::int64_t width = layout.width, count = (end - begin) * width;
    if (layout.values == Values::plane && layout.stride == 1)
        return read(layout.first + begin * width, count, values);
    if (layout.values == Values::by_pixel) return read(3 * begin * width, 3 * count, values);
    if (layout.values == Values::bayer) {
        const std::int64_t first = std::max<std::int64_t>(begin - 1, 0),
                           last = std::min(end + 1, layout.height);
        Buffer<double> mosaic(std::size_t((last - first) * width));
        read(first * width, std::ssize(mosaic), mosaic.data());
        return demosaic(layout, begin, end - begin, mosaic, first, values);
    }
    const bool planes = layout.values == Values::planes;
    Buffer<double> some(std::size_t(planes ? count : 3 * count));
    for (std::int64_t c = 0; c < (planes ? 3 : 1); ++c) {
        read(planes ? c * width * layout.height + begin * width : 3 * begin * width, std::ssize(some),
             some.data());
        for (std::int64_t i = 0; i < count; ++i)
            planes ? values[3 * i + c] = some[i] : values[i] = some[3 * i + layout.first];
    }
}

}  // namespace

std::optional<std::array<int, 4>> bayer_channels(std::string_view letters, int columns, int rows) {
    std::array<int, 4> channels{};
    if (letters.size() != 4) return {};
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t row = (i / 2 + std::size_t(rows & 1)) % 2,
                          column = (i + std::size_t(columns & 1)) % 2;
        const std::size_t channel = std::string_view("RGB").find(letters[2 * row + column]);
        if (channel == std::string_view::npos) return {};
        channels[i] = int(channel);
    }
    return channels;
}

std::function<void(std::int64_t begin, std::int64_t end, double* values)> rows_of_values(
    const ValueLayout& layout, const ValueReader& read) {
    return [layout, read](std::int64_t begin, std::int64_t end, double* values) {
        if (layout.top_down) return read_file_rows(layout, read, begin, end, values);
        read_file_rows(layout, read, layout.height - end, layout.height - begin, values);
        const std::int64_t row = layout.width * layout.channels(), rows = end - begin;
        for (std::int64_t y = 0; y < rows / 2; ++y)
            std::swap_ranges(values + y * row, values + (y + 1) * row, values + (rows - 1 - y) * row);
    };
}

void warn_of_channels(const fs::path& file, std::int64_t more, std::string_view taken,
                      std::string_view remedy) {
    if (more > 0)
        log_warning(fmt::format("{}: {} more than {} {} not followed{}", file.string(),
                                counted(more, "channel"), taken, more == 1 ? "is" : "are", remedy));
}

}  // namespace astrosplat
