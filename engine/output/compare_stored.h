// How far the numbers that two frame files store are apart, channel by channel: the codes of a view as 0..1,
// light and other values as they are. In: two files. Out: where and how much they differ.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace astrosplat {

struct StoredComparison {
    enum class Result { compared, first_damaged, other_form } result = Result::compared;
    std::string other_form;             // "64x48 px, R half, ... against ...", when sizes or channels differ
    std::int64_t pixels = 0;            // of each file
    std::int64_t differing_pixels = 0;  // with any channel of other bits
    double max_difference = 0.0;        // infinite where one is not a number
    std::int64_t max_x = 0, max_y = 0;  // px in the whole frame, the first pixel of the largest difference
    std::string max_channel;            // "R"
    double psnr_db = 0.0;  // of R, G, B and A: 10 log10(1 / mean square difference); infinite without

    bool identical() const { return result == Result::compared && differing_pixels == 0; }
};

/// `second` must be readable: throws InputError otherwise.
StoredComparison compare_stored(const std::filesystem::path& first, const std::filesystem::path& second);

}  // namespace astrosplat
