// The test positions of a mesh source (DESIGN 4): corners and centres of equal cells over a box, each moved a
// little by its own random numbers; and how much room there is near meshes, which tells how many of them are
// kept. In: source parameters and meshes. Out: Lattice, and positions by id.
#pragma once

#include <glm/vec3.hpp>

#include "core/bounds.h"
#include "source/source.h"
#include "source/textured_mesh.h"

namespace astrosplat {

/// The positions to try: corners (n+1 per axis) and centres (n per axis) of n.x * n.y * n.z cells over a box.
struct Lattice {
    Bounds box;         // scene units, after buffer (and after growing to fit voxel_size)
    glm::i64vec3 n{1};  // cells per axis
    /// Positions near the meshes, and those of them that are not transparent, over what a band about the
    /// meshes' area would hold, where that is not about 1.
    double crowding = 1.0, filling = 1.0;
    glm::dvec3 spacing() const { return box.extent() / glm::dvec3(n); }
    std::int64_t corners() const { return (n.x + 1) * (n.y + 1) * (n.z + 1); }
    std::int64_t positions() const { return corners() + n.x * n.y * n.z; }
};

/// Id of corner (i, j, k), 0..n per axis, and of the centre of cell (i, j, k), 0..n-1.
inline std::uint64_t corner_id(const Lattice& lattice, const glm::i64vec3& at) {
    return std::uint64_t((at.z * (lattice.n.y + 1) + at.y) * (lattice.n.x + 1) + at.x);
}
inline std::uint64_t centre_id(const Lattice& lattice, const glm::i64vec3& at) {
    return std::uint64_t(lattice.corners() + (at.z * lattice.n.y + at.y) * lattice.n.x + at.x);
}

/// Coordinate along one axis at `cells` voxels (whole for corners, half for centres)
/// from the box's lower side.
inline double lattice_coordinate(const Lattice& lattice, int axis, double cells) {
    return lattice.box.lo[axis] +
           (lattice.box.hi[axis] - lattice.box.lo[axis]) * cells / double(lattice.n[axis]);
}

/// Whether `count` or `splats` chooses the lattice.
inline bool has_automatic_voxels(const SourceParams& source) {
    return !source.voxels && source.voxel_size <= 0.0;
}

/// source.max_distance, or 2 % of the longest side of the meshes' box where that is 0. Throws InputError.
double resolved_max_distance(const SourceParams& source, const Bounds& meshes_box);

/// source.seed, or the hash of the layer's name where that is 0. Never 0.
std::uint32_t resolved_seed(std::uint32_t seed, const std::string& layer_name);

/// Voxel counts as DESIGN 4 says: given, from voxel_size, or automatic: so that about `count` positions are
/// kept, by the surface area where that tells it within 14 %, else by the measured volume near the meshes; or
/// so that about `splats` are left of them whose alpha is not 0.
/// Throws InputError for values out of range and for lattices of 2^62 positions or more.
Lattice make_lattice(const SourceParams& source, std::span<const TexturedMesh> meshes, double max_distance);

/// How many positions a cull of this lattice will keep, about: both sides of the whole surface, two positions
/// to a voxel, and the lattice's own crowding.
double expected_positions(const Lattice& lattice, std::span<const TexturedMesh> meshes, double max_distance);

/// How many of them will not be transparent, by the lattice's own filling.
double expected_kept(const Lattice& lattice, std::span<const TexturedMesh> meshes, double max_distance);

/// How many a source's set will have, about: that, or source.splats where the lattice is chosen by it.
double expected_splats(const SourceParams& source, const Lattice& lattice,
                       std::span<const TexturedMesh> meshes, double max_distance);

/// Of the box, cubic scene units.
struct Neighbourhood {
    double volume = 0.0;  // within the distance of a surface
    double lit = 0.0;     // that part of it whose closest point has an alpha above 0
};

/// Measures it, within about 1 %: thin meshes, rims and overlaps make it differ from twice the area times the
/// distance. Zeros where the box has no extent along an axis, or is too large for what is in it.
Neighbourhood measure_neighbourhood(std::span<const TexturedMesh> meshes, const Bounds& box,
                                    double max_distance);

}  // namespace astrosplat
