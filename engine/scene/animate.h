// Animation: the scene as it stands at one frame.
#pragma once

#include "scene/scene.h"

namespace astrosplat {

/// A copy of the scene with every track evaluated at `frame` (real-valued) and written into its parameter.
Scene scene_at(const Scene& scene, double frame);

}  // namespace astrosplat
