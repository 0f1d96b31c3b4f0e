// A mesh together with the pictures that colour it: what generation reads.
#pragma once

#include <span>
#include <vector>

#include "source/mesh.h"
#include "source/texture.h"

namespace astrosplat {

/// A mesh with one picture per material (exactly one where the texture was named in the scene).
struct TexturedMesh {
    Mesh mesh;
    std::vector<Texture> textures;
};

/// Loads the meshes and pictures of a mesh source (paths already resolved). Wrap::automatic is clamp for
/// built-in meshes and planar uv, black for planar uv with a width, repeat for a mesh's own uv. Throws
/// InputError.
std::vector<TexturedMesh> load_meshes(const SourceParams& source, const Progress& progress = {});

/// Bounds of all vertices of all meshes.
Bounds bounds(std::span<const TexturedMesh> meshes);

}  // namespace astrosplat
