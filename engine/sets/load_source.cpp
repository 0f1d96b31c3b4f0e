#include "sets/load_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bodies/bodies.h"
#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "generate/generate.h"
#include "splat_files/splat_file.h"

namespace astrosplat {
namespace {

std::string describe_lattice(const Lattice& lattice, double max_distance, std::int64_t bytes) {
    const glm::dvec3 voxel = lattice.spacing();
    const bool cubic =
        std::max({voxel.x, voxel.y, voxel.z}) <= std::min({voxel.x, voxel.y, voxel.z}) * 1.000001;
    const std::string size = cubic ? fmt::format("{:.4g}", voxel.x)
                                   : fmt::format("{:.4g} x {:.4g} x {:.4g}", voxel.x, voxel.y, voxel.z);
    return fmt::format("{} x {} x {} voxels of {}, {} positions, max distance {:.4g}, about {}", lattice.n.x,
                       lattice.n.y, lattice.n.z, size, human_count(static_cast<double>(lattice.positions())),
                       max_distance, human_bytes(static_cast<double>(bytes)));
}

// Reading inputs is heard by a request to stop, but is no share of the work reported.
Progress cancel_only(const Progress& progress) { return {{}, progress.cancelled}; }

SplatSet generate_source(const SourceParams& source, const std::string& layer_name, const Progress& progress,
                         KeptWatcher* watcher, const PictureMaker& prepared) {
    std::vector<TexturedMesh> meshes = load_meshes(source, cancel_only(progress), prepared);
    for (const TexturedMesh& m : meshes) {
        for (const Texture& texture : m.textures) {
            if (!texture.summary.empty())
                log_detail(fmt::format("layer '{}': {}", layer_name, texture.summary));
        }
    }
    const std::uint32_t seed = resolved_seed(source.seed, layer_name);
    if (source.structure.kind != StructureKind::columns) {
        StructureParams structure = source.structure;
        structure.stars = finds_stars(source) ? StructureParams::Stars::yes : StructureParams::Stars::no;
        reduce_pictures(meshes, structure, {available_memory_bytes() / 10 * 9, source.splats}, layer_name);
        return make_bodies(std::move(meshes), structure, seed, layer_name, progress);
    }
    const double max_distance = resolved_max_distance(source, bounds(meshes));
    const Lattice lattice = make_lattice(source, meshes, max_distance);
    const std::int64_t bytes = generate_memory_bytes(meshes, lattice, max_distance);
    log_info(fmt::format("layer '{}': {}", layer_name, describe_lattice(lattice, max_distance, bytes)));
    SplatSet set = generate(meshes, lattice, max_distance, source.jitter, seed, progress, watcher);
    log_detail(fmt::format("layer '{}': kept {} of {} positions, {} more have alpha 0", layer_name,
                           set.size(), set.test_positions, set.zero_alpha));
    return set;
}

SplatSet read_source(const SourceParams& source, const Progress& progress) {
    SplatSet set = read_splats(source.file, progress);
    sort_by_id(set);
    if (set.max_distance <= 0.0 && !set.distance.empty()) {
        set.max_distance = *std::ranges::max_element(set.distance);
    }
    return set;
}

}  // namespace

SplatSet load_source(const SourceParams& source, const std::string& layer_name, const Progress& progress,
                     KeptWatcher* watcher, const PictureMaker& prepared) try {
    switch (source.kind) {
        case SourceKind::mesh:
            return generate_source(source, layer_name, progress, watcher, prepared);
        case SourceKind::splats:
            return read_source(source, progress);
        case SourceKind::stars:
            break;
    }
    throw InputError("kind = \"stars\" comes with a later release");
} catch (const InputError& error) {
    throw InputError(fmt::format("layer '{}': {}", layer_name, error.what()));
}

}  // namespace astrosplat
