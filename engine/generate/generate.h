// From meshes and pictures to a SplatSet: lattice, cull by closest point, colours at the closest point
// (DESIGN 4).
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/progress.h"
#include "generate/lattice.h"
#include "generate/textured_mesh.h"
#include "source/source.h"
#include "splats/splat_set.h"

namespace astrosplat {

class KeptWatcher;

/// Bytes that generate() will take at its peak, about.
std::int64_t generate_memory_bytes(std::span<const TexturedMesh> meshes, const Lattice& lattice,
                                   double max_distance);

/// Runs the cull over the whole lattice, block by block; cost follows what is kept. Deterministic for any
/// thread count. Announces memory before taking it. `progress` may cancel; `watcher`, where there is one,
/// sees the splats as they are kept.
SplatSet generate(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance,
                  double jitter, std::uint32_t seed, const Progress& progress = {},
                  KeptWatcher* watcher = nullptr);

/// The whole of a source: kind mesh as above, kind splats by reading the file (sorted by id). Prints at info
/// level what was chosen. Throws InputError; kind stars is refused in one clear line until it exists.
SplatSet load_source(const SourceParams& source, const std::string& layer_name, const Progress& progress = {},
                     KeptWatcher* watcher = nullptr);

}  // namespace astrosplat
