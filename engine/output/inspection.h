// How a window looks into a frame; what is rendered has none of it. shaders/shared/exposure_bands.glsl as
// C++.
#pragma once

#include "core/shared_maths.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
namespace astrosplat::shared {
namespace {
using namespace astrosplat::glsl;
#include "exposure_bands.glsl"
}  // namespace
}  // namespace astrosplat::shared
#pragma GCC diagnostic pop

namespace astrosplat {

struct Inspection {
    /// What is seen: one of them alone is grey, alpha as it is, without exposure; stops: of the luminance, as
    /// band_color() has them.
    enum class Channel { color, red, green, blue, alpha, luminance, stops } channel = Channel::color;
    float exposure = 0.0f;  // stops, besides the scene's
    float gamma = 1.0f;     // display values to the power of 1 / gamma
    bool operator==(const Inspection&) const = default;
};

}  // namespace astrosplat
