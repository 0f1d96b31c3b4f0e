// A mesh together with the pictures that colour it: what generation reads.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "camera/camera.h"
#include "source/mesh.h"
#include "source/texture.h"

namespace astrosplat {

/// A mesh with one picture per material (exactly one where the texture was named in the scene).
struct TexturedMesh {
    Mesh mesh;
    std::vector<Texture> textures;
    std::optional<Camera> camera;  // uv = "camera": that took the pictures (picture_camera.h)
};

/// Loads the meshes and pictures of a mesh source (paths already resolved). Wrap::automatic is clamp for
/// built-in meshes and planar uv, black for planar uv with a width and for a camera's, repeat for a mesh's
/// own uv. Throws InputError. `readers` are load_texture's.
std::vector<TexturedMesh> load_meshes(const SourceParams& source, const Progress& progress = {},
                                      const PictureReaders& readers = {});

/// Reads the pictures of meshes again, as `source` says now; it has the meshes that these were loaded for,
/// and their shapes stay. Throws InputError, Cancelled.
void reload_pictures(const SourceParams& source, std::vector<TexturedMesh>& meshes,
                     const Progress& progress = {}, const PictureReaders& readers = {});

/// Bounds of all vertices of all meshes.
Bounds bounds(std::span<const TexturedMesh> meshes);

}  // namespace astrosplat
