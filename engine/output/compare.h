// How far two images are apart: in linear light, or as the numbers that two frame files store, channel by
// channel (the codes of a view as 0..1, light and other values as they are). In: two images or files of one
// size. Out: where and how much they differ.
#pragma once

#include "core/image.h"

namespace astrosplat {

/// Differences are absolute, of linear premultiplied channel values; a pixel's difference is its largest
/// channel's. NaN against anything but the same bits counts as infinite.
struct ImageComparison {
    std::int64_t width = 0, height = 0;  // px
    std::int64_t differing_pixels = 0;   // with any channel of other bits
    std::int64_t max_x = 0, max_y = 0;   // px, the first pixel of the largest difference
    int max_channel = 0;
    double max_difference = 0.0;
    double mean_difference = 0.0;  // over all pixels and channels
    double percentile_999 = 0.0;   // the smallest bound that 99.9 % of the pixels keep
    double psnr_db = 0.0;          // 10 log10(1 / mean square difference); infinite without difference

    bool identical() const { return differing_pixels == 0; }
};

/// Both images must have the same size and channels (assert).
ImageComparison compare_images(const Image& a, const Image& b);

/// Reads both as linear light. Throws InputError when one cannot be read or the sizes differ.
ImageComparison compare_files(const fs::path& a, const fs::path& b);

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
StoredComparison compare_stored(const fs::path& first, const fs::path& second);

}  // namespace astrosplat
