#include "sets/set_sample.h"

#include "bodies/bodies.h"
#include "core/error.h"
#include "core/file_format.h"
#include "core/real.h"
#include "generate/generate.h"
#include "sets/load_source.h"
#include "sets/recipe.h"
#include "splat_files/native.h"

namespace astrosplat {
namespace {

constexpr double share = 0.01;
constexpr std::int64_t enough = 100'000;  // splats or texels: of fewer, what does not grow with them is most

constexpr std::int64_t hardly_fewer = 4;  // times: what is so much smaller takes nearly as long

std::int64_t rows_of(std::int64_t all) {
    return std::min(all, std::max(enough, std::int64_t(share * double(all))));
}

SplatSet sample_file(const NativeBlocks& file, std::int64_t rows) {
    return file.sample(rows > 0 ? rows : rows_of(file.splats()));
}

SetSample sample_whole(const fs::path& path, std::int64_t rows) {
    const NativeBlocks file(path);
    return {sample_file(file, rows), file.splats()};
}

/// Of geometry and texels, whose rows are the same splats'.
SetSample sample_columns(const SetCache& cache, const Recipe& recipe, std::int64_t rows) {
    const NativeBlocks texels(texel_file(cache, recipe.name), NativePart::colors);
    const std::string beginning = texel_recipe(recipe, "");
    if (!texels.facts().recipe.starts_with(beginning)) throw InputError("made of something else");
    const NativeBlocks geometry(set_file(cache, texels.facts().recipe.substr(beginning.size())),
                                NativePart::geometry);
    if (geometry.splats() != texels.splats()) throw InputError("not of these texels");
    SplatSet set = sample_file(geometry, rows), colors = sample_file(texels, rows);
    const auto positions = double(set.size());
    set.color = std::move(colors.color);
    set.alpha = std::move(colors.alpha);
    set.divided = colors.divided;
    set = lit_splats({std::move(set)});
    const double lit = double(set.size()) / std::max(1.0, positions);
    return {std::move(set), std::int64_t(lit * double(texels.splats()))};
}

/// Of bodies, but for the seconds.
Making making_of(const BodiesPlan& plan, std::int64_t limit) {
    Making making;
    making.whole_splats = expected_splats(plan.meshes, plan.structure);
    making.splats = limit > 0 ? std::min(making.whole_splats, limit) : making.whole_splats;
    making.bytes =
        std::int64_t(double(bodies_memory_bytes(plan.meshes, plan.structure, making.whole_splats)) *
                     double(making.splats) / std::max(1.0, double(making.whole_splats)));
    return making;
}

/// Of pictures of so many times the texels of one whose bodies took `seconds`: small ones take longer each.
double making_seconds(double seconds, double times) {
    constexpr double exponent = 0.85;  // .81 and .87, found of 67 million texels by .15 and .67 million
    return seconds * real::pow(times, exponent);
}

SetSample sample_bodies(const SetCache& cache, const SourceParams& source, const std::string& layer_name,
                        const Progress& progress) {
    const auto start = Clock::now();
    BodiesPlan plan =
        plan_bodies(source, load_meshes(cache, source, progress, most_texels_read(source, room_for_bodies())),
                    layer_name);
    SetSample sample;
    sample.making = making_of(plan, source.splats);
    sample.splats = sample.making.splats;
    const std::int64_t texels = largest_picture(plan.meshes);
    const double reading = seconds_since(start);
    reduce_to(plan.meshes, rows_of(texels), layer_name);
    plan.structure.detail = 0;  // of a picture that is reduced there is none
    const double smaller = double(texels) / double(std::max<std::int64_t>(1, largest_picture(plan.meshes)));
    const auto making = Clock::now();
    sample.set = make_bodies(std::move(plan.meshes), plan.structure, resolved_seed(source.seed, layer_name),
                             layer_name, progress);
    sample.making.seconds = reading + making_seconds(seconds_since(making), smaller);
    const auto narrower = float(1.0 / std::sqrt(smaller));
    for (float& radius : sample.set.radius) radius *= narrower;
    return sample;
}

/// As many voxels as would keep a part of the positions: about `rows`, or as rows_of() has it. Empty where
/// these were hardly fewer than all.
SetSample sample_lattice(const SetCache& cache, const SourceParams& source, const std::string& layer_name,
                         const Progress& progress, std::int64_t rows = 0) {
    const auto start = Clock::now();
    ColumnPlan plan = plan_columns(source, layer_name, progress, kept_pictures(cache));
    const Lattice whole = plan.lattice;
    SetSample sample;
    sample.splats =
        std::int64_t(std::min(expected_splats(source, whole, plan.meshes, plan.max_distance), 1e15));
    if (rows > 0 && sample.splats < hardly_fewer * rows) return sample;
    const double smaller =
        double(sample.splats) / double(std::max<std::int64_t>(1, rows > 0 ? rows : rows_of(sample.splats)));
    SourceParams coarse = source;
    coarse.voxels = glm::max(glm::i64vec3(glm::dvec3(whole.n) / std::cbrt(smaller)), glm::i64vec3(1));
    plan.lattice = make_lattice(coarse, plan.meshes, plan.max_distance);
    const double reading = seconds_since(start);
    const auto making = Clock::now();
    sample.set = lit_splats(make_columns(plan, layer_name, progress));
    sample.set.spacing = whole.spacing();
    sample.making.seconds = reading + smaller * seconds_since(making);
    return sample;
}

SetSample sample_all(SplatSet set) {
    const std::int64_t splats = set.size();
    return {sample_rows(set, rows_of(splats)), splats};
}

}  // namespace

std::optional<SetSample> sample_there(const SetCache& cache, const SourceParams& source,
                                      const std::string& layer_name, std::int64_t rows,
                                      const Progress& progress) try {
    if (source.kind == SourceKind::splats) {
        const FileFormat* const format = format_of_file(source.file);
        if (!format || format->id != std::string_view("splats")) return std::nullopt;
        return sample_whole(source.file, rows);
    }
    if (cache.folder.empty() || source.kind != SourceKind::mesh) return std::nullopt;
    const Recipe recipe = recipe_of(source, layer_name, progress);
    const bool columns = makes_columns(source);
    const fs::path file = columns ? texel_file(cache, recipe.name) : set_file(cache, recipe.name);
    std::error_code error;
    if (recipe.name.empty() || !fs::is_regular_file(file, error)) return std::nullopt;
    return columns ? sample_columns(cache, recipe, rows) : sample_whole(file, rows);
} catch (const InputError&) {
    return std::nullopt;
}

SetSample sample_set(const SetCache& cache, const SourceParams& source, const std::string& layer_name,
                     const Progress& progress) {
    if (auto there = sample_there(cache, source, layer_name)) return std::move(*there);
    if (source.kind != SourceKind::mesh)
        return sample_all(load_source(cache, source, layer_name, progress).set);
    return makes_columns(source) ? sample_lattice(cache, source, layer_name, progress)
                                 : sample_bodies(cache, source, layer_name, progress);
}

void show_quick_sets(const SetCache& cache, const SourceParams& source, const std::string& layer_name,
                     const QuickSets& quick, const Progress& progress) {
    constexpr std::int64_t smaller = 16;  // times as few texels, as takes a second of a usual picture
    constexpr std::int64_t most_texels = 150'000;  // and of a large one
    constexpr std::int64_t soon = 20'000'000;      // splats of bodies, which are read in a second or two
    if (auto there = sample_there(cache, source, layer_name, quick.rows, progress)) {
        const bool bodies = source.kind == SourceKind::mesh && !makes_columns(source);
        if (!bodies || there->splats > soon) quick.show(std::move(*there));
        return;
    }
    if (source.kind != SourceKind::mesh) return;
    const auto show = [&](SetSample sample) {
        sample.stands_in = true;
        if (sample.splats == 0) sample.splats = sample.set.size();
        if (sample.set.size() > 0) quick.show(std::move(sample));
    };
    if (makes_columns(source)) return show(sample_lattice(cache, source, layer_name, progress, quick.rows));
    std::vector<TexturedMesh> meshes =
        load_meshes(cache, source, progress, most_texels_read(source, room_for_bodies()));
    if (quick.flat) show({flat_picture(meshes)});
    SourceParams few = source;
    few.splats = 0;  // a limit of the whole
    BodiesPlan plan = plan_bodies(few, std::move(meshes), layer_name);
    const std::int64_t texels = largest_picture(plan.meshes);
    if (texels < hardly_fewer * most_texels / 2) return;
    SetSample sample;
    sample.making = making_of(plan, source.splats);
    const double made = double(sample.making.splats) / std::max(1.0, double(sample.making.whole_splats));
    reduce_to(plan.meshes, std::min(texels / smaller + 1, most_texels), layer_name);
    plan.structure.detail = 0;
    const double times = made * double(texels) / double(largest_picture(plan.meshes));
    const auto start = Clock::now();
    sample.set = make_bodies(std::move(plan.meshes), plan.structure, resolved_seed(source.seed, layer_name),
                             layer_name, progress);
    sample.making.seconds = making_seconds(seconds_since(start), std::max(1.0, times));
    uv_of_pictures(plan.times, sample.set);
    show(std::move(sample));
}

}  // namespace astrosplat
