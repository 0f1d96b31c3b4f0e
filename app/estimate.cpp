// What a batch run will take, before it takes it: from the scene and from file sizes,
// without generating anything.
#include "estimate.h"

#include <algorithm>

#include "bodies/bodies.h"
#include "core/error.h"
#include "core/text.h"
#include "generate/generate.h"
#include "generate/lattice.h"
#include "interrupt.h"
#include "pipeline.h"
#include "scene/animate.h"
#include "sets/load_source.h"
#include "sets/prepared_cache.h"
#include "sets/sky_cache.h"
#include "splat_files/splat_file.h"

namespace astrosplat {
namespace {

// Bytes per splat: the set (position, colour, alpha, distance, id, uv, normal, mesh), the shaded splat, and
// one projected splat with its place in a tile.
constexpr std::int64_t set_bytes = 64, shaded_bytes = 40, screen_bytes = 64;
constexpr std::int64_t program_bytes = 140'000'000;  // with its libraries, before any scene
constexpr std::int64_t file_bytes_per_splat =
    100;  // a row of a PDA with colour, opacity, distance and radius
// Of captures: a row of a file with normals; and beside set_bytes and shaded_bytes shape and radius,
// harmonics and colours by direction.
constexpr std::int64_t capture_row_bytes = 68, harmonics_row_bytes = 180;
constexpr std::int64_t shape_bytes = 68, harmonics_bytes = 204;
constexpr std::int64_t catalogue_bytes_per_star = 100;  // HYG; Hipparcos, compressed

// More than any machine holds, few enough that bytes of many layers still fit 63 bits.
constexpr std::int64_t most_splats = 1'000'000'000'000'000;

struct Expected {
    std::int64_t splats = 0;
    std::int64_t making_bytes = 0;  // while the set is made
    std::int64_t held_bytes = 0;    // by the set and by what is shaded, beyond what all have
};

Expected expected_of_file(const std::filesystem::path& file) {
    std::error_code ignored;
    const auto size = std::filesystem::file_size(file, ignored);
    if (ignored) return {};
    const auto bytes = static_cast<std::int64_t>(size);
    std::vector<std::string> attributes;
    try {
        attributes = splat_attributes(file);
    } catch (const InputError&) {  // whose reader will say so
    }
    const auto has = [&](const char* name) {
        return std::ranges::find(attributes, name) != attributes.end();
    };
    if (!has("scale")) return {bytes / file_bytes_per_splat};
    const bool harmonics = has("harmonics");
    const std::int64_t splats = bytes / (capture_row_bytes + (harmonics ? harmonics_row_bytes : 0));
    return {splats, 0, splats * (shape_bytes + (harmonics ? harmonics_bytes : 0))};
}

bool has_automatic_voxels(const SourceParams& source) { return !source.voxels && source.voxel_size <= 0.0; }

Expected expected_columns(const SourceParams& source, const std::vector<TexturedMesh>& meshes) {
    Bounds box;
    for (const TexturedMesh& textured : meshes) box.add(bounds(textured.mesh));
    const double max_distance = resolved_max_distance(source, box);
    const Lattice lattice = make_lattice(source, meshes, max_distance);
    const bool asked_for = source.splats > 0 && has_automatic_voxels(source);
    return {
        asked_for ? source.splats : static_cast<std::int64_t>(expected_kept(lattice, meshes, max_distance)),
        columns_memory_bytes(meshes, lattice, max_distance)};
}

Expected expected_of(const SetCache& cache, const LayerParams& layer) {
    const SourceParams& source = layer.source;
    if (source.kind == SourceKind::splats) return expected_of_file(source.file);
    if (source.kind == SourceKind::stars) {
        if (!source.stars.along.empty()) return {source.count};
        std::error_code ignored;
        const auto size = std::filesystem::file_size(source.stars.catalogue, ignored);
        return {ignored ? 0 : static_cast<std::int64_t>(size) / catalogue_bytes_per_star};
    }
    const bool bodies = source.structure.kind != StructureKind::columns;
    if (!bodies && has_automatic_voxels(source) && source.splats <= 0) return {source.count};
    std::vector<TexturedMesh> meshes =
        load_meshes(cache, source, Progress{{}, &interrupted()}, most_texels_read(source, room_for_bodies()));
    if (!bodies) return expected_columns(source, meshes);
    const BodiesPlan plan = plan_bodies(source, std::move(meshes), layer.name);
    const std::int64_t dots = expected_dots(plan.meshes, plan.structure);
    return {std::min(dots, source.splats > 0 ? source.splats : most_splats),
            bodies_memory_bytes(plan.meshes, dots)};
}

/// Six faces of three floats.
std::int64_t sky_bytes(const SkyTiling& tiling) { return 6 * tiling.face_px * tiling.face_px * 12; }

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
    std::vector<TexturedMesh> meshes =
        load_meshes(cache, source, Progress{{}, &interrupted()}, most_texels_read(source, bytes));
    enlarge_small_pictures(meshes, layer.name);
    const std::int64_t largest = largest_picture(meshes);
    reduce_pictures(meshes, source.structure, {bytes, 0}, layer.name);
    const std::int64_t fitting = largest_picture(meshes);
    if (fitting < largest) source.structure.most_texels = fitting;
}

JobEstimate estimate(const BatchPlan& plan) {
    JobEstimate job;
    std::int64_t making = 0, held = 0;  // bytes, at its peak; beyond set_bytes
    for (const LayerParams& layer : plan.scene.layers) {
        if (!ever_visible(plan.scene, layer)) continue;
        const auto cached = cached_splats(plan.cache, layer.source, layer.name);
        const Expected expected = cached ? Expected{*cached} : expected_of(plan.cache, layer);
        making = std::max(making, job.splats * set_bytes + expected.making_bytes);
        job.layers.push_back({layer.name, std::min(expected.splats, most_splats)});
        job.splats += job.layers.back().splats;
        held += expected.held_bytes;
    }
    const EnvironmentParams& sky = plan.scene.environment;
    if (sky.visible && !sky.tile.empty()) {
        job.sky_kept = is_kept(plan.cache, sky.tile, sky.tiling, Progress{{}, &interrupted()});
        making = std::max(making, 3 * sky_bytes(sky.tiling));  // as made or read, and with borders
        held += sky_bytes(sky.tiling) * 4 / 3;                 // with mip levels
    }
    std::int64_t screen = job.splats * screen_bytes;
    if (plan.memory_limit_bytes > 0) screen = std::min(screen, plan.memory_limit_bytes);
    const std::int64_t rendering =
        job.splats * (set_bytes + shaded_bytes) + held + screen + frame_bytes(plan);
    job.bytes = program_bytes + std::max(making, rendering);
    return job;
}

}  // namespace astrosplat
