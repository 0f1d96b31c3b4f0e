// Details copied from where a picture looks alike, across scales: by patches (PatchMatch, Barnes et al.
// 2009). In: what is known to lie on what, and a larger picture that lacks such details. Out: its details.
#pragma once

#include "core/image.h"
#include "core/progress.h"

namespace astrosplat {

/// A picture's finest octave, and what it lies on.
struct Exemplar {
    Image coarse;   // the picture without that octave: one channel, logarithms
    Image fine;     // that octave, 1 or 3 channels, as large
    Image sources;  // one channel, as large: 0 where nothing is copied from; or empty
};

/// Where the first pixel of a base lies in that of the whole picture, px; even numbers.
struct PatchPlace {
    std::int64_t x = 0, y = 0;
};

/// Details of `base` (one channel, `times` as large as the exemplar, a power of 2), in as many channels as
/// exemplar.fine: means of what lies about the places that look most alike, at most 24 of the exemplar's
/// pixels away; 0 where there are none. The same bits for any number of threads. Throws Cancelled.
Image exemplar_details(const Image& base, const Exemplar& exemplar, int times, const PatchPlace& place,
                       std::uint32_t seed, const Progress& progress = {});

}  // namespace astrosplat
