// Holes of a picture filled from their surroundings. In: a picture and which of its pixels are unknown.
// Out: the picture with these pixels filled; all others keep their values.
#pragma once

#include "core/image.h"
#include "core/progress.h"
#include "detect/parts.h"

namespace astrosplat {

enum class FillKind { membrane, texture };

/// Fills the masked pixels of every channel. membrane: the smooth surface through the hole's rim (Laplace's
/// equation). texture: that surface plus what stands out of it in an equally large piece beside the hole, the
/// one that fits the rim best; the membrane where there is no such piece. A picture that is one hole becomes
/// 0. Time and memory grow with the holes' boxes. The same bits with any number of threads. Throws Cancelled.
void fill(Image& image, const PixelMask& holes, FillKind kind, const Progress& progress = {});

}  // namespace astrosplat
