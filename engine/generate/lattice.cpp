// Lattices: choosing the cells, naming the positions, moving them.
#include "generate/lattice.h"

#include <fmt/format.h>

#include <glm/common.hpp>

#include "core/error.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "generate/generate.h"

namespace astrosplat {
namespace {

constexpr double most_positions = 4611686018427387904.0;  // 2^62: ids and their sums fit 64 bits

[[noreturn]] void bad_key(const char* key, const std::string& expected, const std::string& found) {
    bad_input(fmt::format("source.{}", key), expected, found);
}

double total_area(std::span<const TexturedMesh> meshes) {
    double area = 0.0;
    for (const TexturedMesh& m : meshes) area += surface_area(m.mesh);
    return area;
}

// Corners and centres, in double: exact enough to compare with 2^62, and never overflowing.
double position_count(const glm::dvec3& n) {
    return (n.x + 1.0) * (n.y + 1.0) * (n.z + 1.0) + n.x * n.y * n.z;
}

glm::i64vec3 checked_counts(const glm::dvec3& n, const char* key) {
    if (!(position_count(n) < most_positions))
        bad_key(key, "a lattice of fewer than 2^62 positions",
                fmt::format("{:.4g} x {:.4g} x {:.4g} voxels", n.x, n.y, n.z));
    return glm::i64vec3(n);
}

Bounds buffered_box(const SourceParams& source, std::span<const TexturedMesh> meshes, double max_distance) {
    const glm::dvec3 buffer = source.buffer.value_or(glm::dvec3(max_distance));
    for (int axis = 0; axis < 3; ++axis)
        if (!(buffer[axis] >= 0.0 && std::isfinite(buffer[axis])))
            bad_key("buffer", "numbers of at least 0", fmt::format("{}", buffer[axis]));
    Bounds box = bounds(meshes);
    box.lo -= buffer;
    box.hi += buffer;
    return box;
}

// Cubes of side `size`, as many as cover the box, which grows evenly on both sides to hold them.
Lattice cubes(Bounds box, double size, const char* key) {
    const glm::dvec3 n = glm::max(glm::dvec3(1.0), glm::ceil(box.extent() / size - 1e-6));
    Lattice lattice;
    lattice.n = checked_counts(n, key);
    const glm::dvec3 growth = (n * size - box.extent()) * 0.5;
    lattice.box.lo = box.lo - growth;
    lattice.box.hi = box.hi + growth;
    return lattice;
}

// With two positions in each voxel, `count` of them fill a volume.
double cube_side(double volume, std::int64_t count) {
    return real::pow(2.0 * volume / double(count), 1.0 / 3.0);
}

// Whether volumes are alike enough for `count` to mean what it says.
bool about(double volume, double expected) { return std::fabs(volume - expected) <= 0.14 * expected; }

Lattice automatic_lattice(const SourceParams& source, std::span<const TexturedMesh> meshes,
                          double max_distance, const Bounds& box) {
    if (source.count < 1) bad_key("count", "at least 1", fmt::format("{}", source.count));
    const double area = total_area(meshes);
    if (!(area > 0.0))
        bad_key("voxels", "numbers, because the meshes have no area to choose them by", "\"auto\"");
    const double band = 2.0 * area * max_distance;
    Neighbourhood near = measure_neighbourhood(meshes, box, max_distance);
    if (near.volume == 0.0) near = {band, band};
    if (source.splats > 0 && near.lit == 0.0)
        bad_key("splats", "a picture and masks that leave something", "nothing that is not transparent");
    const double volume = source.splats > 0 ? near.lit : about(near.volume, band) ? band : near.volume;
    Lattice lattice = source.splats > 0 ? cubes(box, cube_side(volume, source.splats), "splats")
                                        : cubes(box, cube_side(volume, source.count), "count");
    if (!about(near.volume, band)) lattice.crowding = near.volume / band;
    if (!about(near.lit, band)) lattice.filling = near.lit / band;
    return lattice;
}

double expected_in_band(const Lattice& lattice, std::span<const TexturedMesh> meshes, double max_distance,
                        double share) {
    const glm::dvec3 voxel = lattice.spacing();
    const double band = 4.0 * total_area(meshes) * max_distance / (voxel.x * voxel.y * voxel.z) * share;
    return std::min(double(lattice.positions()), band);  // also where band is 0 / 0
}

constexpr double enough = 40000.0;           // positions kept: chance is then half a per cent
constexpr double few = 400.0;                // so many tell how many cells give enough
constexpr double most_measured = 1e18;       // positions of a lattice; ids fit 64 bits
constexpr double first_positions = 20000.0;  // of the coarsest lattice

// Fills the box exactly with cells of about this side.
Lattice coarse_lattice(const Bounds& box, double side) {
    return {box, glm::i64vec3(glm::max(glm::dvec3(1.0), glm::ceil(box.extent() / side - 1e-6))), 1.0};
}

}  // namespace

double resolved_max_distance(const SourceParams& source, const Bounds& meshes_box) {
    if (!(source.max_distance >= 0.0 && std::isfinite(source.max_distance)))
        bad_key("max_distance", "a number of at least 0", fmt::format("{}", source.max_distance));
    if (source.max_distance > 0.0) return source.max_distance;
    const glm::dvec3 extent = meshes_box.extent();
    return 0.02 * std::max({extent.x, extent.y, extent.z});
}

std::uint32_t resolved_seed(std::uint32_t seed, const std::string& layer_name) {
    if (seed != 0) return seed;
    std::uint32_t hash = shared::as_mix(shared::PURPOSE_NAME);
    for (const char c : layer_name) hash = shared::as_mix(hash + static_cast<unsigned char>(c) + 1u);
    return hash != 0 ? hash : 1u;
}

Lattice make_lattice(const SourceParams& source, std::span<const TexturedMesh> meshes, double max_distance) {
    const Bounds box = buffered_box(source, meshes, max_distance);
    if (source.voxels) {
        const glm::i64vec3 n = *source.voxels;
        for (int axis = 0; axis < 3; ++axis)
            if (n[axis] < 1) bad_key("voxels", "at least 1 per axis", fmt::format("{}", n[axis]));
        Lattice lattice;
        lattice.n = n;
        lattice.box = box;
        checked_counts(glm::dvec3(n), "voxels");
        return lattice;
    }
    if (!(source.voxel_size >= 0.0 && std::isfinite(source.voxel_size)))
        bad_key("voxel_size", "a number above 0", fmt::format("{}", source.voxel_size));
    if (source.voxel_size > 0.0) return cubes(box, source.voxel_size, "voxel_size");
    return automatic_lattice(source, meshes, max_distance, box);
}

double expected_positions(const Lattice& lattice, std::span<const TexturedMesh> meshes, double max_distance) {
    return expected_in_band(lattice, meshes, max_distance, lattice.crowding);
}

double expected_kept(const Lattice& lattice, std::span<const TexturedMesh> meshes, double max_distance) {
    return expected_in_band(lattice, meshes, max_distance, lattice.filling);
}

double expected_splats(const SourceParams& source, const Lattice& lattice,
                       std::span<const TexturedMesh> meshes, double max_distance) {
    if (source.splats > 0 && has_automatic_voxels(source)) return double(source.splats);
    return expected_kept(lattice, meshes, max_distance);
}

Neighbourhood measure_neighbourhood(std::span<const TexturedMesh> meshes, const Bounds& box,
                                    double max_distance) {
    const glm::dvec3 extent = box.extent();
    const double room = extent.x * extent.y * extent.z;
    if (!(room > 0.0)) return {};
    double side = real::pow(2.0 * room / first_positions, 1.0 / 3.0);
    while (2.0 * room / (side * side * side) < most_measured) {
        const Lattice lattice = coarse_lattice(box, side);
        const KeptCounts counts = count_kept(meshes, lattice, max_distance);
        const auto kept = double(counts.kept);
        const glm::dvec3 voxel = lattice.spacing();
        const double each = voxel.x * voxel.y * voxel.z / 2.0;
        if (kept >= enough) return {kept * each, double(counts.lit) * each};
        side *= kept < few ? 0.5 : real::pow(kept / (1.2 * enough), 1.0 / 3.0);
    }
    return {};
}

}  // namespace astrosplat
