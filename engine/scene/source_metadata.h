// What the sources of a scene say of themselves. In: a scene, and the sets of its layers. Out: one
// ObjectMetadata for all, and the scene's provenance with what it leaves to them.
#pragma once

#include "scene/scene.h"
#include "source/object_metadata.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// Merged, over the pictures of the layers, each file once, and of the sky, and over the credits of splat
/// files. `sets`: of each layer; null: it is in no frame. Reads headers. Throws InputError.
ObjectMetadata source_metadata(const Scene& scene, const std::vector<const SplatSetFacts*>& sets);

/// Title, credit and type, where the scene gives none, are those of the sources.
ProvenanceParams resolved(ProvenanceParams provenance, const ObjectMetadata& sources);

}  // namespace astrosplat
