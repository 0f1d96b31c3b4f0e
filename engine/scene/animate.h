// Animation: the scene as it stands at one frame.
#pragma once

#include <glm/vec3.hpp>

#include "scene/parameter.h"
#include "scene/scene.h"

namespace astrosplat {

/// A copy of the scene with every track evaluated at `frame` (real-valued) and written into its parameter;
/// those of camera.file win over those of [animation].
Scene scene_at(const Scene& scene, double frame);

/// Takes away all that moves, [animation] and camera.file; parameters keep the values they have.
void stop_animation(Scene& scene);

/// Whether [animation] or camera.file moves a parameter that is `wanted`.
bool moves(const Scene& scene, const std::function<bool(const ParameterKey&)>& wanted);

/// The track that moves a parameter, of camera.file before that of [animation]; nullptr where none does.
const Track* moving_track(const Scene& scene, const ParameterKey& key);

/// The numbers of one track at `frame`, before they are fitted to the parameter's type and range. The track
/// has at least one keyframe and belongs to a parameter of this kind.
std::vector<double> track_at(const Track& track, const ParameterSpec& spec, double frame);

/// The keyframes of a position's track as places.
std::vector<Keyframe<glm::dvec3>> position_keyframes(const Track& track);

/// The handles of every keyframe as they act (camera/keyframe.h), worked out where they are automatic. The
/// track has at least one keyframe.
struct TrackHandles {
    Handle<std::vector<double>> in, out;
};
std::vector<TrackHandles> handles_of(const Track& track, const ParameterSpec& spec);

/// Whether a layer's splats are shaded alike in all frames, as far as the tracks tell.
bool is_shaded_alike(const Scene& scene, const std::string& layer);

/// Whether a layer is drawn in some frame: visible as it stands, or switched on by a keyframe
/// of the animation.
bool ever_visible(const Scene& scene, const LayerParams& layer);

}  // namespace astrosplat
