// The environment as one camera sees it, for frames in motion: a ready image that render() puts behind
// the splats instead of asking the environment at every pixel, where exact directions cost more than all
// splats of a preview.
#pragma once

#include <cstdint>

#include "camera/camera.h"
#include "core/image.h"
#include "render/environment.h"

namespace astrosplat {

/// Four floats a pixel, of which the last means nothing, as sample_environment has them but for two things:
/// places on an equirectangular picture are exact at every eighth pixel only and interpolated in between, and
/// the nearest mip level is taken, not a mix of two. Uses the image's memory again where the size stays.
void draw_backdrop(const Environment& environment, const Camera& camera, std::int64_t width,
                   std::int64_t height, Image& image);

}  // namespace astrosplat
