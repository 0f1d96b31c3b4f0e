// A layer's source with what it takes from the rest of the scene. In: a scene and one of its layers. Out: all
// that its set is made of.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "scene/scene.h"

namespace astrosplat {

/// Places of the scene's camera: of one that is animated, in equal steps between its keyframes;
/// empty for one without a position.
std::vector<glm::dvec3> camera_places(const Scene& scene);

/// Whether there are such.
bool has_camera_places(const Scene& scene);

/// Whether a layer's stars lie along the camera's path.
bool follows_camera(const SourceParams& source);

/// The layer whose picture a layer's stars are of (source.like); null: none, or none with a picture.
const LayerParams* like_layer(const Scene& scene, const LayerParams& layer);

/// layer.source, of stars along the camera with its path, of those of a picture with the rest of its layer's.
SourceParams source_of(const Scene& scene, const LayerParams& layer);

}  // namespace astrosplat
