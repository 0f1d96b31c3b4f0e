// What can be seen of a picture before its bodies are made: the picture itself, flat on its mesh. In: meshes
// with pictures. Out: splats for whoever watches, which never reach the set.
#pragma once

#include <span>

#include "generate/kept_store.h"
#include "source/textured_mesh.h"

namespace astrosplat {

/// Shows the watcher about as many splats as it can hold in any case, spread evenly over all pictures, each
/// with the mean colour of its part.
void show_flat(std::span<const TexturedMesh> meshes, KeptWatcher& watcher);

}  // namespace astrosplat
