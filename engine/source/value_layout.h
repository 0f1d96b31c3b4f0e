// How the values of a picture lie in a file of data: planes, pixel by pixel, or Bayer's mosaic. In: a reader
// of values by their number. Out: rows from the top, channel by channel of each pixel.
#pragma once

#include "core/standard.h"

namespace astrosplat {

struct ValueLayout {
    enum class Values { plane, planes, by_pixel, bayer } values = Values::plane;
    std::int64_t width = 0, height = 0;
    std::int64_t first = 0;        // value of the file that is a plane's first
    std::int64_t stride = 1;       // from one value of it to the next
    bool top_down = false;         // the first row is on top
    std::array<int, 4> pattern{};  // Bayer's: channels of the file's first 2 x 2
    std::string what;              // "plane 1 of 4"; may be empty

    int channels() const { return values == Values::plane ? 1 : 3; }
};

/// Channels of 2 x 2 pixels, from "RGGB" and its like, whose columns and rows begin so far on; nothing for
/// other letters.
std::optional<std::array<int, 4>> bayer_channels(std::string_view letters, int columns, int rows);

/// Writes `count` values from number `first` on.
using ValueReader = std::function<void(std::int64_t first, std::int64_t count, double* values)>;
/// Writes rows from `begin` to `end`, from the top. What a pixel of a mosaic has not is the mean of those of
/// its 3 x 3 neighbours that have it.
std::function<void(std::int64_t begin, std::int64_t end, double* values)> rows_of_values(
    const ValueLayout& layout, const ValueReader& read);

/// Warns of `more` channels of a file than those `taken`, where there are any.
void warn_of_channels(const fs::path& file, std::int64_t more, std::string_view taken,
                      std::string_view remedy = "");

}  // namespace astrosplat
