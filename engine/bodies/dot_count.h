// How many dots a picture will become, told before they are made. In: a texture. Out: a number.
#pragma once

#include <cstdint>

#include "source/source.h"
#include "source/texture.h"

namespace astrosplat {

/// From samples of the picture, taken apart as the whole will be; within some 5 %.
double expected_dots(const Texture& texture, const StructureParams& params);

/// More than a picture of width x height texels can become; at once.
double most_dots(std::int64_t width, std::int64_t height, const StructureParams& params);

}  // namespace astrosplat
