// Masks: where a picture is to show, told by its own brightness and colour, by an ellipse, by another
// picture. In: a picture's light. Out: a weight for every pixel.
#pragma once

#include <span>

#include "core/image.h"
#include "source/source.h"

namespace astrosplat {

/// One channel of the picture's size, 0..1: the product over masks of the product of their terms and the
/// largest of their alternatives; `invert` makes 1 - w of a mask, or of an alternative. `light` is RGBA,
/// linear, premultiplied: colours are those seen over black. Edges are linear ramps of the width `feather`
/// about the border. Hue and saturation as in HSV, of display values; grey has no hue and is outside.
/// Throws InputError where an image cannot be read.
Image mask_weights(const Image& light, std::span<const MaskParams> masks);

}  // namespace astrosplat
