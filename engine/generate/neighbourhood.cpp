#include "generate/neighbourhood.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "core/real.h"
#include "generate/generate.h"

namespace astrosplat {
namespace {

constexpr double enough = 40000.0;           // positions kept: chance is then half a per cent
constexpr double few = 400.0;                // so many tell how many cells give enough
constexpr double most_measured = 1e18;       // positions of a lattice; ids fit 64 bits
constexpr double first_positions = 20000.0;  // of the coarsest lattice

// Fills the box exactly with cells of about this side.
Lattice coarse_lattice(const Bounds& box, double side) {
    return {box, glm::i64vec3(glm::max(glm::dvec3(1.0), glm::ceil(box.extent() / side - 1e-6))), 1.0};
}

}  // namespace

Neighbourhood measure_neighbourhood(std::span<const TexturedMesh> meshes, const Bounds& box,
                                    double max_distance) {
    const glm::dvec3 extent = box.extent();
    const double room = extent.x * extent.y * extent.z;
    if (!(room > 0.0)) return {};
    double side = real::pow(2.0 * room / first_positions, 1.0 / 3.0);
    while (2.0 * room / (side * side * side) < most_measured) {
        const Lattice lattice = coarse_lattice(box, side);
        const KeptCounts counts = count_kept(meshes, lattice, max_distance);
        const auto kept = static_cast<double>(counts.kept);
        const glm::dvec3 voxel = lattice.spacing();
        const double each = voxel.x * voxel.y * voxel.z / 2.0;
        if (kept >= enough) return {kept * each, static_cast<double>(counts.lit) * each};
        side *= kept < few ? 0.5 : real::pow(kept / (1.2 * enough), 1.0 / 3.0);
    }
    return {};
}

}  // namespace astrosplat
