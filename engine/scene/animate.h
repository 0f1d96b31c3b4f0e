// Animation: the scene as it stands at one frame.
#pragma once

#include <vector>

#include "scene/parameter.h"
#include "scene/scene.h"

namespace astrosplat {

/// A copy of the scene with every track evaluated at `frame` (real-valued) and written into its parameter.
Scene scene_at(const Scene& scene, double frame);

/// The numbers of one track at `frame`, before they are fitted to the parameter's type and range. The track
/// has at least one keyframe and belongs to a parameter of this kind.
std::vector<double> track_at(const Track& track, const ParameterSpec& spec, double frame);

/// Whether a layer is drawn in some frame: visible as it stands, or switched on by a keyframe of the
/// animation.
bool ever_visible(const Scene& scene, const LayerParams& layer);

}  // namespace astrosplat
