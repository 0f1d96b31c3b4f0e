// The front door of a layer's source. In: what [layer.source] says. Out: its meshes, or its SplatSet.
#pragma once

#include <string>
#include <vector>

#include "core/progress.h"
#include "generate/textured_mesh.h"
#include "source/source.h"
#include "splats/splat_set.h"

namespace astrosplat {

class KeptWatcher;

/// Loads the meshes and pictures of a mesh source (paths already resolved). Wrap::automatic is clamp for
/// built-in meshes and planar uv, repeat for a mesh's own uv. Throws InputError.
std::vector<TexturedMesh> load_meshes(const SourceParams& source, const Progress& progress = {});

/// The whole of a source: kind mesh by generate(), kind splats by reading the file (sorted by id). Prints at
/// info level what was chosen. Throws InputError; kind stars is refused in one clear line until it exists.
SplatSet load_source(const SourceParams& source, const std::string& layer_name, const Progress& progress = {},
                     KeptWatcher* watcher = nullptr);

}  // namespace astrosplat
