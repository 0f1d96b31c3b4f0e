// How a picture goes on below its pixels. What lies there was never measured: it is invented so that it looks
// as such things do, and so that, filtered down, it is the picture again (DETAIL 3). In: linear light without
// its stars. Out: the same, twice or four times as large.
#pragma once

#include "core/image.h"
#include "core/progress.h"

namespace astrosplat {

struct DetailWish {
    int octaves = 1;  // 1 or 2: 2 or 4 times as large
    double strength =
        0.8;  // of the noise where nothing is copied to, 0..1; 1: as strong as the picture's own
    std::uint32_t seed = 0;
};

/// `light`: 1 or 3 channels, >= 0, with what `sources` (one channel, as large; or empty) says of it: 0 where
/// a star was taken out, so that nothing is copied from there. Out: 2^octaves times as large, with area means
/// that are `light` to 3e-7 of it (of 1 at least). The same bits for any number of threads. Throws Cancelled;
/// NotEnoughMemory, an InputError.
Image detail_picture(const Image& light, const Image& sources, const DetailWish& wish,
                     const Progress& progress = {});

}  // namespace astrosplat
