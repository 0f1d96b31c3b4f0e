#include "sets/load_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "bodies/bodies.h"
#include "bodies/margin.h"
#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "generate/generate.h"
#include "generate/write_columns.h"
#include "sets/flat_start.h"
#include "sets/star_source.h"
#include "splat_files/splat_file.h"

namespace astrosplat {
namespace {

constexpr std::int64_t rows_per_task = 16384;

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

[[noreturn]] void fail(const std::string& layer_name, const InputError& error) {
    throw InputError(fmt::format("layer '{}': {}", layer_name, error.what()));
}

std::vector<TexturedMesh> load_meshes(const SourceParams& source, const std::string& layer_name,
                                      const Progress& progress, const PictureMaker& prepared) {
    std::vector<TexturedMesh> meshes = load_meshes(
        source, cancel_only(progress), {prepared, {}, most_texels_read(source, room_for_bodies())});
    for (const TexturedMesh& m : meshes)
        for (const Texture& texture : m.textures)
            if (!texture.summary.empty())
                log_detail(fmt::format("layer '{}': {}", layer_name, texture.summary));
    return meshes;
}

bool is_one(const glm::dvec2& times) { return times == glm::dvec2(1.0); }

// From places in the pictures with their margins to places in the pictures, which are 0..1 there.
void uv_of_pictures(std::span<const glm::dvec2> times, SplatSet& set) {
    if (std::ranges::all_of(times, is_one)) return;
    parallel_each(set.uv.size(), rows_per_task, [&](std::size_t i) {
        set.uv[i] = (set.uv[i] - 0.5f) * glm::vec2(times[set.mesh[i]]) + 0.5f;
    });
}

SplatSet generate_bodies(const SourceParams& source, const std::string& layer_name, const Progress& progress,
                         KeptWatcher* watcher, const PictureMaker& prepared) {
    std::vector<TexturedMesh> meshes = load_meshes(source, layer_name, progress, prepared);
    if (watcher) show_flat(meshes, *watcher);
    BodiesPlan plan = plan_bodies(source, std::move(meshes), layer_name);
    SplatSet set = make_bodies(std::move(plan.meshes), plan.structure, resolved_seed(source.seed, layer_name),
                               layer_name, progress, source.splats);
    uv_of_pictures(plan.times, set);
    set.of_this_machine = !plan.fits_memory;
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

std::int64_t room_for_bodies() { return available_memory_bytes() / 10 * 9; }

std::int64_t most_texels_read(const SourceParams& source, std::int64_t room_bytes) {
    if (makes_columns(source)) return 0;
    const std::int64_t asked_for = source.structure.most_texels, most = most_texels_within(room_bytes);
    return asked_for > 0 ? std::min(asked_for, most) : most;
}

BodiesPlan plan_bodies(const SourceParams& source, std::vector<TexturedMesh> meshes,
                       const std::string& layer_name) {
    BodiesPlan plan{std::move(meshes), source.structure, {}};
    plan.structure.stars = finds_stars(source) ? StructureParams::Stars::yes : StructureParams::Stars::no;
    const bool read_whole = have_all_texels(plan.meshes, source.structure.most_texels);
    enlarge_small_pictures(plan.meshes, layer_name);
    plan.times = add_margins(plan.meshes, plan.structure.margin, plan.structure.kind, layer_name);
    if (std::ranges::all_of(plan.times, is_one)) plan.structure.margin = 0.0;
    reduce_to(plan.meshes, plan.structure.most_texels, layer_name);
    if (source.splats > 0)
        reduce_pictures(plan.meshes, plan.structure,
                        {std::numeric_limits<std::int64_t>::max(), source.splats}, layer_name);
    const std::int64_t asked_for = largest_picture(plan.meshes);
    reduce_pictures(plan.meshes, plan.structure, {room_for_bodies(), 0}, layer_name);
    plan.fits_memory = read_whole && largest_picture(plan.meshes) == asked_for;
    return plan;
}

ColumnPlan plan_columns(const SourceParams& source, const std::string& layer_name, const Progress& progress,
                        const PictureMaker& prepared) try {
    ColumnPlan plan;
    plan.meshes = load_meshes(source, layer_name, progress, prepared);
    plan.max_distance = resolved_max_distance(source, bounds(plan.meshes));
    plan.lattice = make_lattice(source, plan.meshes, plan.max_distance);
    plan.jitter = source.jitter;
    plan.seed = resolved_seed(source.seed, layer_name);
    const std::int64_t bytes = columns_memory_bytes(plan.meshes, plan.lattice, plan.max_distance);
    log_info(
        fmt::format("layer '{}': {}", layer_name, describe_lattice(plan.lattice, plan.max_distance, bytes)));
    return plan;
} catch (const InputError& error) {
    fail(layer_name, error);
}

Columns make_columns(const ColumnPlan& plan, const std::string& layer_name, const Progress& progress,
                     KeptWatcher* watcher) try {
    Columns columns =
        make_columns(plan.meshes, plan.lattice, plan.max_distance, plan.jitter, plan.seed, progress, watcher);
    log_detail(fmt::format("layer '{}': kept {} of {} positions", layer_name, columns.splats.size(),
                           columns.splats.test_positions));
    return columns;
} catch (const NotEnoughMemory& error) {
    throw NotEnoughMemory(
        fmt::format("layer '{}': {}; in a .splats file, which generate writes in parts, it need not fit",
                    layer_name, error.what()));
} catch (const InputError& error) {
    fail(layer_name, error);
}

std::int64_t write_columns(const WriteTarget& target, const ColumnPlan& plan, const std::string& layer_name,
                           const Progress& progress) try {
    return write_columns(target, plan.meshes, plan.lattice, plan.max_distance, plan.jitter, plan.seed,
                         available_memory_bytes() / 4 * 3, progress);
} catch (const InputError& error) {
    fail(layer_name, error);
}

SplatSet load_source(const SourceParams& source, const std::string& layer_name, const Progress& progress,
                     KeptWatcher* watcher, const PictureMaker& prepared) {
    if (makes_columns(source))
        return lit_splats(make_columns(plan_columns(source, layer_name, progress, prepared), layer_name,
                                       progress, watcher));
    try {
        if (source.kind == SourceKind::mesh)
            return generate_bodies(source, layer_name, progress, watcher, prepared);
        if (source.kind == SourceKind::splats) return read_source(source, progress);
        return load_stars(source, layer_name, progress, prepared, [&] {
            return load_source(picture_source(source), source.stars.like, progress, nullptr, prepared);
        });
    } catch (const InputError& error) {
        fail(layer_name, error);
    }
}

}  // namespace astrosplat
