// From meshes and pictures to a SplatSet: lattice, cull by closest point, colours at the closest point (DESIGN 4).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/bounds.h"
#include "core/progress.h"
#include "source/mesh.h"
#include "source/source.h"
#include "source/texture.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// A mesh with one picture per material (exactly one where the texture was named in the scene).
struct TexturedMesh {
    Mesh mesh;
    std::vector<Texture> textures;
};

/// The positions to try: corners (n+1 per axis) and centres (n per axis) of n.x * n.y * n.z cells over a box.
struct Lattice {
    Bounds box;          // scene units, after buffer (and after growing to fit voxel_size)
    glm::i64vec3 n{1};   // cells per axis
    glm::dvec3 spacing() const { return box.extent() / glm::dvec3(n); }
    std::int64_t corners() const { return (n.x + 1) * (n.y + 1) * (n.z + 1); }
    std::int64_t positions() const { return corners() + n.x * n.y * n.z; }
};

/// Position of lattice id before jitter; corners come first, then centres.
glm::dvec3 lattice_position(const Lattice& lattice, std::uint64_t id);
/// The same, moved by jitter * half a voxel * uniform(-1, 1) per axis, hashed from (seed, id).
glm::dvec3 jittered_position(const Lattice& lattice, std::uint64_t id, double jitter, std::uint32_t seed);

/// source.max_distance, or 2 % of the longest side of the meshes' box where that is 0.
double resolved_max_distance(const SourceParams& source, const Bounds& meshes_box);
/// source.seed, or the hash of the layer's name where that is 0.
std::uint32_t resolved_seed(std::uint32_t seed, const std::string& layer_name);

/// Voxel counts as DESIGN 4 says: given, from voxel_size, or automatic from `count` and the surface area.
Lattice make_lattice(const SourceParams& source, std::span<const TexturedMesh> meshes, double max_distance);

/// Loads the meshes and pictures of a mesh source (paths already resolved). Throws InputError.
std::vector<TexturedMesh> load_meshes(const SourceParams& source);

/// Runs the cull over the whole lattice, block by block; cost follows what is kept. Deterministic for any thread
/// count. Announces memory before taking it. `progress` may cancel.
SplatSet generate(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance, double jitter,
                  std::uint32_t seed, const Progress& progress = {});

/// The whole of a source: kind mesh as above, kind splats by reading the file (sorted by id). Prints at info level
/// what was chosen. Throws InputError; kind stars is answered with one clear line until it exists.
SplatSet load_source(const SourceParams& source, const std::string& layer_name, const Progress& progress = {});

}  // namespace astrosplat
