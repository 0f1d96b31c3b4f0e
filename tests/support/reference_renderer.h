// The frame by the book: what the tile renderer must show, for scenes small enough to wait for it.
#pragma once

#include "camera/camera.h"
#include "render/environment.h"
#include "render/frame.h"

namespace astrosplat::test {

/// The beauty frame (RGBA, linear, premultiplied) of the whole frame: for each pixel, for each splat, back
/// to front. Level of detail, regions and the arbitrary output variables are left out.
/// `environment` may be null.
Image reference_render(std::span<const RenderLayer> layers, const Camera& camera,
                       const Environment* environment, const RenderSettings& settings);

}  // namespace astrosplat::test
