// Display colours that look right where readers blend them. In: encoded Gaussians, a frame in linear light
// and its camera. Out: the Gaussians with other colours and alphas.
#pragma once

#include "camera/camera.h"
#include "core/image.h"
#include "gaussians/gaussians.h"
#include "render/frame.h"

namespace astrosplat {

/// Changes colours, and alphas where colours would exceed 1, until the encoded Gaussians laid over each other
/// as they are look from the camera like `wanted` on black, encoded: piles of faint splats would be too dark.
/// `wanted` is a frame of `settings`, linear light with the gain in it.
void fit_to_view(Gaussians& gaussians, const Image& wanted, const Camera& camera,
                 const RenderSettings& settings);

}  // namespace astrosplat
