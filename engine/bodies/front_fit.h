// The front view made right (DEPTH 5): what is composited dims what lies deep, so colours are raised, step by
// step, by the ratio of the picture to what is seen. In and out: the dots of a picture.
#pragma once

#include "bodies/picture_splats.h"
#include "core/image.h"
#include "core/progress.h"

namespace astrosplat {

struct FrontFit {
    int steps = 0;
    double psnr_db = 0.0;  // on sRGB values of every fourth row, as it is estimated from the rendering
};

/// Multiplies colours until the orthographic front view is the picture as the default pixel filter shows it;
/// last, cells of 32 px get the picture's flux. `small`: the picture was enlarged, its own texels are several
/// of these. The same bits with any number of threads. Throws Cancelled; InputError where memory does not
/// suffice.
FrontFit fit_front(PictureSplats& dots, Image light, bool small = false, const Progress& progress = {});

}  // namespace astrosplat
