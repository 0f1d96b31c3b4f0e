// How many dots a picture will become, told before they are made. In: a texture. Out: a number.
#pragma once

#include "source/source.h"
#include "source/texture.h"

namespace astrosplat {

/// From samples of the picture, taken apart as the whole will be; within some 5 %.
double expected_dots(const Texture& texture, const StructureParams& params);

}  // namespace astrosplat
