// From meshes and pictures to a SplatSet: lattice, cull by closest point, colours at the closest point
// (DESIGN 4), in one go; columns.h has the steps.
#pragma once

#include <cstdint>
#include <span>

#include "core/progress.h"
#include "generate/lattice.h"
#include "source/source.h"
#include "source/textured_mesh.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// Positions of a lattice with full jitter.
struct KeptCounts {
    std::int64_t kept = 0;  // within max_distance of a surface
    std::int64_t lit = 0;   // those whose alpha is not 0
};
KeptCounts count_kept(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance);

/// The set of make_columns().
SplatSet generate(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance,
                  double jitter, std::uint32_t seed, const Progress& progress = {});

}  // namespace astrosplat
