// From meshes and pictures to a SplatSet: lattice, cull by closest point, colours at the closest point
// (DESIGN 4).
#pragma once

#include <cstdint>
#include <span>

#include "core/progress.h"
#include "generate/lattice.h"
#include "source/source.h"
#include "source/textured_mesh.h"
#include "splats/splat_set.h"

namespace astrosplat {

class KeptWatcher;

/// Bytes that generate() will take at its peak, about.
std::int64_t generate_memory_bytes(std::span<const TexturedMesh> meshes, const Lattice& lattice,
                                   double max_distance);

/// Positions of a lattice with full jitter.
struct KeptCounts {
    std::int64_t kept = 0;  // within max_distance of a surface
    std::int64_t lit = 0;   // those whose alpha is not 0
};
KeptCounts count_kept(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance);

/// Runs the cull over the whole lattice, block by block; cost follows what is kept. Deterministic for any
/// thread count. Announces memory before taking it. `progress` may cancel; `watcher`, where there is one,
/// sees the splats as they are kept.
SplatSet generate(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance,
                  double jitter, std::uint32_t seed, const Progress& progress = {},
                  KeptWatcher* watcher = nullptr);

}  // namespace astrosplat
