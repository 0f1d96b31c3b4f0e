// What a batch run will take, before it takes it: from the scene and from file sizes,
// without generating anything.
#include "estimate.h"

#include <algorithm>

#include "bodies/bodies.h"
#include "core/error.h"
#include "core/text.h"
#include "generate/lattice.h"
#include "interrupt.h"
#include "pipeline.h"
#include "scene/animate.h"
#include "sets/prepared_cache.h"

namespace astrosplat {
namespace {

// Bytes per splat: the set (position, colour, alpha, distance, id, uv, normal, mesh), the shaded splat, and
// one projected splat with its place in a tile.
constexpr std::int64_t set_bytes = 64, shaded_bytes = 40, screen_bytes = 64;
constexpr std::int64_t program_bytes = 140'000'000;  // with its libraries, before any scene
constexpr std::int64_t file_bytes_per_splat =
    100;  // a row of a PDA with colour, opacity, distance and radius

// More than any machine holds, few enough that bytes of many layers still fit 63 bits.
constexpr std::int64_t most_splats = 1'000'000'000'000'000;

std::int64_t splats_of(const SetCache& cache, const SourceParams& source) {
    if (source.kind == SourceKind::splats) {
        std::error_code ignored;
        const auto size = std::filesystem::file_size(source.file, ignored);
        return ignored ? 0 : static_cast<std::int64_t>(size) / file_bytes_per_splat;
    }
    const bool bodies = source.structure.kind != StructureKind::columns;
    if (!bodies && !source.voxels && source.voxel_size <= 0.0)
        return source.splats > 0 ? source.splats : source.count;
    const std::vector<TexturedMesh> meshes = load_meshes(cache, source, Progress{{}, &interrupted()});
    if (bodies)
        return std::min(expected_dots(meshes, source.structure),
                        source.splats > 0 ? source.splats : most_splats);
    Bounds box;
    for (const TexturedMesh& textured : meshes) box.add(bounds(textured.mesh));
    const double max_distance = resolved_max_distance(source, box);
    const Lattice lattice = make_lattice(source, meshes, max_distance);
    return static_cast<std::int64_t>(expected_kept(lattice, meshes, max_distance));
}

std::int64_t frame_bytes(const BatchPlan& plan) {
    const OutputParams& output = plan.scene.output;
    const bool whole = plan.region.width == 0;
    const std::int64_t pixels = whole ? output.width * output.height : plan.region.width * plan.region.height;
    const auto aovs = static_cast<std::int64_t>(output.aovs.size());
    return pixels * 4 * (4 + aovs + 4 * static_cast<std::int64_t>(plan.scene.layers.size()) * (aovs > 0));
}

}  // namespace

std::int64_t parse_memory(const std::string& text) {
    const std::optional<double> gib = parse_double(text);
    if (!gib || !(*gib > 0.0 && *gib < 1048576.0))
        bad_input("--memory", "", "a size in GiB, such as 4", "'" + text + "'");
    return static_cast<std::int64_t>(*gib * 1073741824.0);
}

void limit_bodies(LayerParams& layer, std::int64_t bytes, const SetCache& cache) {
    SourceParams& source = layer.source;
    if (source.kind != SourceKind::mesh || source.structure.kind == StructureKind::columns) return;
    std::vector<TexturedMesh> meshes = load_meshes(cache, source, Progress{{}, &interrupted()});
    const std::int64_t largest = largest_picture(meshes);
    reduce_pictures(meshes, source.structure, {bytes, 0}, layer.name);
    const std::int64_t fitting = largest_picture(meshes);
    if (fitting < largest) source.structure.most_texels = fitting;
}

JobEstimate estimate(const BatchPlan& plan) {
    JobEstimate job;
    for (const LayerParams& layer : plan.scene.layers) {
        if (!ever_visible(plan.scene, layer)) continue;
        const auto cached = cached_splats(plan.cache, layer.source, layer.name);
        const std::int64_t splats = cached ? *cached : splats_of(plan.cache, layer.source);
        job.layers.push_back({layer.name, std::min(splats, most_splats)});
        job.splats += job.layers.back().splats;
    }
    std::int64_t screen = job.splats * screen_bytes;
    if (plan.memory_limit_bytes > 0) screen = std::min(screen, plan.memory_limit_bytes);
    job.bytes = program_bytes + job.splats * (set_bytes + shaded_bytes) + screen + frame_bytes(plan);
    return job;
}

}  // namespace astrosplat
