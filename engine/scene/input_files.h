// The files that a scene is made of: what is watched while it is open, asked for before a run, and hashed.
#pragma once

#include <filesystem>
#include <vector>

#include "scene/scene.h"

namespace astrosplat {

/// The files that a source names: meshes, textures, pictures of masks, splats, catalogues. Not what is built
/// in.
std::vector<std::filesystem::path> named_files(const SourceParams& source);
/// The same with what an OBJ brings of its own: material libraries and their pictures. Reads it.
std::vector<std::filesystem::path> all_files(const SourceParams& source);
/// A mesh from a file that takes the pictures its own materials name.
bool has_own_pictures(const MeshInput& input);

/// Those of a scene beside its layers' sources: thickness maps and pictures of the sky.
std::vector<std::filesystem::path> picture_files(const Scene& scene);

}  // namespace astrosplat
