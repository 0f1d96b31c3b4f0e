// How a picture goes on below its pixels. What lies there was never measured: it is invented so that it looks
// as such things do, and so that, filtered down, it is the picture again (DETAIL 3). In: linear light without
// its stars, or a part of it. Out: the same, twice or four times as large.
#pragma once

#include "core/image.h"
#include "core/progress.h"

namespace astrosplat {

struct DetailWish {
    int octaves = 1;  // 1 or 2: 2 or 4 times as large
    double strength =
        0.8;  // of the noise where nothing is copied to, 0..1; 1: as strong as the picture's own
    std::uint32_t seed = 0;
    float slope = 0.8f;         // detail_slope() of the whole picture
    std::int64_t x = 0, y = 0;  // where the light's first pixel lies in it, even numbers
    /// How much of an octave counts at a place, px of the whole picture, 0..1; empty: all of it.
    std::function<float(float x, float y, int octave)> share = {};
};

/// An octave's amplitude over that of the next coarser one, by which it goes on, .5 to .95.
float detail_slope(const Image& light);

/// Pixels of the whole picture about a part of it that its detail depends on.
inline constexpr std::int64_t detail_reach_px = 32;

/// `light`: 1 or 3 channels, >= 0, with what `sources` (one channel, as large; or empty) says of it: 0 where
/// a star was taken out, so that nothing is copied from there. Out: 2^octaves times as large, with area means
/// that are `light` to 3e-7 of it (of 1 at least). The same bits for any number of threads, and for a part of
/// a picture as for all of it, but for rounding, where that goes on by detail_reach_px. Throws Cancelled;
/// NotEnoughMemory, an InputError.
Image detail_picture(const Image& light, const Image& sources, const DetailWish& wish,
                     const Progress& progress = {});

/// As many octaves larger without any of that: by cubic interpolation (Catmull-Rom).
Image octaves_larger(Image image, int octaves);

}  // namespace astrosplat
