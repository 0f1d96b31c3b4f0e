// From meshes and pictures to a SplatSet (DESIGN 4): lattice, cull by closest point, colours at the closest
// point. In: meshes, a lattice and pictures. Out: columns with every position that the search has found, also
// where the picture is transparent (geometry, which other pictures need not search again); and the set of
// those to be seen, in memory or straight into a native file, part of space by part.
#pragma once

#include "core/atomic_file.h"
#include "core/progress.h"
#include "generate/lattice.h"
#include "source/source.h"
#include "source/textured_mesh.h"
#include "splats/splat_set.h"

namespace astrosplat {

class KeptWatcher;

/// With SplatSet::face. Colours and alphas are those of the pictures read last; zero_alpha counts only the
/// positions that no picture shows.
struct Columns {
    SplatSet splats;
};

/// Bytes that make_columns() will take at its peak, about.
std::int64_t columns_memory_bytes(std::span<const TexturedMesh> meshes, const Lattice& lattice,
                                  double max_distance);

/// The same for so many positions on meshes of few triangles.
std::int64_t columns_memory_bytes(std::int64_t positions);

/// Runs the cull over the whole lattice, block by block; cost follows what is kept. Deterministic for any
/// thread count. Announces memory before taking it. `progress` may cancel; `watcher`, where there is one,
/// sees the positions as they are kept.
Columns make_columns(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance,
                     double jitter, std::uint32_t seed, const Progress& progress = {},
                     KeptWatcher* watcher = nullptr);

/// Colours and alphas of all positions from the pictures of `meshes`, whose triangles are those that the
/// columns were made of: the bits that make_columns() would give. Throws Cancelled.
void read_texels(std::span<const TexturedMesh> meshes, Columns& columns, const Progress& progress = {});

/// Shows a watcher its sample of finished columns.
void show_end(const Columns& columns, KeptWatcher& watcher);

/// The set: what has an alpha above 0. The rest is counted in zero_alpha.
SplatSet lit_splats(Columns columns);

/// Positions of a lattice with full jitter.
struct KeptCounts {
    std::int64_t kept = 0;  // within max_distance of a surface
    std::int64_t lit = 0;   // those whose alpha is not 0
};

KeptCounts count_kept(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance);

/// The set of make_columns().
SplatSet generate(std::span<const TexturedMesh> meshes, const Lattice& lattice, double max_distance,
                  double jitter, std::uint32_t seed, const Progress& progress = {});

/// Returns how many splats the file has. Parts take about `room_bytes` of memory, if the smallest part of
/// space does not take more. Throws OutputError, Cancelled, and InputError where there is no memory for the
/// smallest part.
std::int64_t write_columns(const WriteTarget& target, std::span<const TexturedMesh> meshes,
                           const Lattice& lattice, double max_distance, double jitter, std::uint32_t seed,
                           std::int64_t room_bytes, const Progress& progress = {});

}  // namespace astrosplat
