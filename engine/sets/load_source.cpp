// A source read or generated, its automatic values, and its flat preview. The formulas stay where they are
// used: placement.h for heights, the meshes' box for planar coordinates.
#include "sets/load_source.h"

#include <fmt/format.h>

#include "bodies/bodies.h"
#include "bodies/margin.h"
#include "bodies/placement.h"
#include "bodies/uv_surface.h"
#include "core/color.h"
#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "source/origin.h"
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
                       lattice.n.y, lattice.n.z, size, human_count(double(lattice.positions())), max_distance,
                       human_bytes(double(bytes)));
}

[[noreturn]] void fail(const std::string& layer_name, const InputError& error) {
    throw InputError(fmt::format("layer '{}': {}", layer_name, error.what()));
}

std::vector<TexturedMesh> load_meshes(const SourceParams& source, const std::string& layer_name,
                                      const Progress& progress, const PictureMaker& prepared) {
    std::vector<TexturedMesh> meshes =
        load_meshes(source, progress.silent(), {prepared, {}, most_texels_read(source, room_for_bodies())});
    for (const TexturedMesh& m : meshes)
        for (const Texture& texture : m.textures)
            if (!texture.summary.empty())
                log_detail(fmt::format("layer '{}': {}", layer_name, texture.summary));
    return meshes;
}

bool is_one(const glm::dvec2& times) { return times == glm::dvec2(1.0); }

// From places in the pictures with their margins to places in the pictures, which are 0..1 there.
// Of a set whose places are those in the pictures.
ShareBeyond share_beyond(const SplatSet& set) {
    ShareBeyond beyond;
    double splats = 0.0, light = 0.0;
    for (std::size_t i = 0; i < set.uv.size(); ++i) {
        const glm::vec2 uv = set.uv[i];
        const bool outside = !(std::min(uv.x, uv.y) >= 0.0f && std::max(uv.x, uv.y) <= 1.0f);
        const glm::vec3& color = set.color[i];  // below 0 where it absorbs
        const double shines = double(set.alpha[i]) *
                              std::max(0.0, double(luminance(color.r, color.g, color.b))) *
                              double(set.radius[i]) * double(set.radius[i]);
        splats += 1.0, light += shines;
        if (outside) beyond.splats += 1.0, beyond.light += shines;
    }
    beyond.splats /= std::max(1.0, splats);
    beyond.light /= std::max(1e-30, light);
    return beyond;
}

SplatSet generate_bodies(const SourceParams& source, const std::string& layer_name, const Progress& progress,
                         const PictureMaker& prepared) {
    BodiesPlan plan = plan_bodies(source, load_meshes(source, layer_name, progress, prepared), layer_name);
    SplatSet set = make_bodies(std::move(plan.meshes), plan.structure, resolved_seed(source.seed, layer_name),
                               layer_name, progress, source.splats);
    uv_of_pictures(plan.times, set);
    SourceParams made = source;
    made.structure.detail = plan.structure.detail;
    set.origin = origin_of(made, share_beyond(set));
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

constexpr std::int64_t enough_texels = 65536;  // only the pictures' shape counts

bool has_automatic_height(const SourceParams& source) {
    return source.structure.kind != StructureKind::columns && source.structure.height == 0.0;
}

bool has_automatic_width(const SourceParams& source) {
    const bool planar =
        source.uv == UvMode::planar_xy || source.uv == UvMode::planar_xz || source.uv == UvMode::planar_yz;
    return planar && source.uv_width == 0.0;
}

double body_height(const SourceParams& source, const TexturedMesh& mesh) {
    if (mesh.textures.empty()) return 0.0;
    const Texture& texture = mesh.textures.front();
    const bool known = texture.file_width > 0;
    const std::int64_t width = known ? texture.file_width : texture.image.width,
                       height = known ? texture.file_height : texture.image.height;
    const UvSurface surface(mesh.mesh, 0, width, height, false, mesh.camera ? &*mesh.camera : nullptr);
    const double texels_per_unit = surface.texels_per_unit();
    if (!(texels_per_unit > 0.0)) return 0.0;
    StructureParams params = source.structure;
    if (mesh.mesh.name != "plane") params.margin = 0.0;  // as add_margins has it
    const auto beyond = std::int64_t(2.0 * params.margin * double(width));
    return placement_without_fields(width + beyond, height + beyond, params, texels_per_unit).height /
           texels_per_unit;
}

constexpr double most_splats = 1 << 16;

/// Mean of the texels [x, x + step) x [y, y + step) that there are, premultiplied.
glm::vec4 mean_of(const Image& image, std::int64_t x, std::int64_t y, std::int64_t step) {
    glm::vec4 sum(0.0f);
    const std::int64_t right = std::min(x + step, image.width), below = std::min(y + step, image.height);
    for (std::int64_t j = y; j < below; ++j)
        for (std::int64_t i = x; i < right; ++i) {
            const float* texel = image.at(i, j);
            sum += glm::vec4(texel[0], texel[1], texel[2], texel[3]);
        }
    return sum / float((right - x) * (below - y));
}

/// The side of a part in texels, so that all pictures have so many together.
std::int64_t step_of(std::span<const TexturedMesh> meshes) {
    double texels = 0.0;
    for (const TexturedMesh& mesh : meshes)
        for (const Texture& texture : mesh.textures)
            texels += double(texture.image.width) * double(texture.image.height);
    return std::max<std::int64_t>(1, std::llround(std::ceil(std::sqrt(texels / most_splats))));
}

void add_picture(const TexturedMesh& mesh, std::uint32_t number, std::uint32_t material, std::int64_t step,
                 SplatSet& set) {
    constexpr float radius_steps = 1.04f;  // as of a lattice: .6 diagonals of a cube
    const Texture& texture = mesh.textures[material];
    const Image& image = texture.image;
    const UvSurface surface = surface_of(mesh, material);
    for (std::int64_t y = 0; y < image.height; y += step)
        for (std::int64_t x = 0; x < image.width; x += step) {
            const glm::vec4 mean = mean_of(image, x, y, step);
            if (!(mean.a > 0.0f)) continue;
            const float half = 0.5f * float(step);
            const glm::vec2 uv((float(x) + half) / float(image.width),
                               1.0f - (float(y) + half) / float(image.height));
            surface.at(uv, [&](const SurfacePlace& place) {
                set.position.push_back(place.position);
                set.color.push_back(glm::vec3(mean) / mean.a);
                set.alpha.push_back(mean.a);
                set.radius.push_back(radius_steps * float(step) * place.units_per_texel);
                set.distance.push_back(0.0f);
                set.id.push_back(set.id.size());
                set.uv.push_back(uv);
                set.normal.push_back(place.normal);
                set.mesh.push_back(number);
            });
        }
}

}  // namespace

void uv_of_pictures(std::span<const glm::dvec2> times, SplatSet& set) {
    if (std::ranges::all_of(times, is_one)) return;
    parallel_each(set.uv.size(), rows_per_task, [&](std::size_t i) {
        set.uv[i] = (set.uv[i] - 0.5f) * glm::vec2(times[set.mesh[i]]) + 0.5f;
    });
}

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
    if (plan.structure.detail == 0) enlarge_small_pictures(plan.meshes, layer_name);
    plan.times = add_margins(plan.meshes, plan.structure, layer_name);
    if (std::ranges::all_of(plan.times, is_one)) plan.structure.margin = 0.0;
    const std::int64_t whole = largest_picture(plan.meshes);
    reduce_to(plan.meshes, plan.structure.most_texels, layer_name);
    if (source.splats > 0)
        reduce_pictures(plan.meshes, plan.structure,
                        {std::numeric_limits<std::int64_t>::max(), source.splats}, layer_name);
    const std::int64_t asked_for = largest_picture(plan.meshes);
    reduce_pictures(plan.meshes, plan.structure, {room_for_bodies(), 0}, layer_name);
    plan.fits_memory = read_whole && largest_picture(plan.meshes) == asked_for;
    if (plan.structure.detail > 0 && !(read_whole && largest_picture(plan.meshes) == whole)) {
        log_warning(fmt::format("layer '{}': source.structure.detail is left out, as its picture is reduced",
                                layer_name));
        plan.structure.detail = 0;
    }
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
        if (source.kind == SourceKind::mesh) return generate_bodies(source, layer_name, progress, prepared);
        if (source.kind == SourceKind::splats) return read_source(source, progress);
        return load_stars(source, layer_name, progress, prepared, [&] {
            return load_source(picture_source(source), source.stars.like, progress, nullptr, prepared);
        });
    } catch (const InputError& error) {
        fail(layer_name, error);
    }
}

void warn_of_no_splats(const SplatSet& set, const std::string& name) {
    if (set.size() == 0) log_warning(name + ": nothing to see: it has no splats");
}

AutomaticValues automatic_values(const SourceParams& source, const Progress& progress) {
    AutomaticValues values;
    if (source.kind != SourceKind::mesh || !(has_automatic_height(source) || has_automatic_width(source)))
        return values;
    SourceParams unprepared = source;  // which changes no picture's shape
    unprepared.texture.prepare = {};
    const std::vector<TexturedMesh> meshes =
        load_meshes(unprepared, progress.silent(), {make_prepared, {}, enough_texels});
    if (meshes.empty()) return values;
    if (has_automatic_height(source)) values.body_height = body_height(source, meshes.front());
    if (has_automatic_width(source))
        values.uv_width = bounds(meshes).extent()[source.uv == UvMode::planar_yz ? 2 : 0];
    return values;
}

SplatSet flat_picture(std::span<const TexturedMesh> meshes) {
    const std::int64_t step = step_of(meshes);
    SplatSet set;
    for (std::uint32_t number = 0; number < meshes.size(); ++number)
        for (std::uint32_t material = 0; material < meshes[number].textures.size(); ++material)
            add_picture(meshes[number], number, material, step, set);
    return set;
}

MovedBodies moved_bodies(const SourceParams& source, std::vector<TexturedMesh> meshes,
                         const std::string& layer_name, SplatSet rows) {
    BodiesPlan plan = plan_bodies(source, std::move(meshes), layer_name);
    for (std::size_t i = 0; i < rows.uv.size(); ++i)
        rows.uv[i] = (rows.uv[i] - 0.5f) / glm::vec2(plan.times[rows.mesh[i]]) + 0.5f;
    return {std::move(plan.meshes), plan.structure, resolved_seed(source.seed, layer_name), std::move(rows)};
}

}  // namespace astrosplat
