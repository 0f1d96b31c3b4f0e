// Memory, time and bytes that a batch run will take, before it takes them: from the scene, from file sizes
// and from a sample.
#include "estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "batch_plan.h"
#include "bodies/picture_size.h"
#include "camera/camera.h"
#include "core/error.h"
#include "core/file_format.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/text.h"
#include "generate/generate.h"
#include "generate/lattice.h"
#include "interrupt.h"
#include "output/format.h"
#include "pipeline.h"
#include "sampled_run.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"
#include "sets/kept.h"
#include "sets/load_source.h"
#include "source/picture.h"
#include "splat_files/native.h"
#include "splat_files/splat_file.h"
#include "streamed/streamed_set.h"

namespace astrosplat {

namespace {

// One layer: from its source and the sizes of its files, and from its sample where there is one.

struct LayerNeed {
    const LayerParams* params;
    std::int64_t splats = 0;
    bool has_shapes = false;            // captures
    std::int64_t making = 0, held = 0;  // bytes while it is made, and from then on
    std::int64_t streamed = 0;          // bytes held where it stays on disk
    bool may_stream = false, reads_pictures = false;
};

constexpr std::int64_t shaded_bytes = 40;
// Of captures: a row of a file with normals; and beside what all have shape and radius, harmonics and colours
// by direction.
constexpr std::int64_t capture_row_bytes = 68, harmonics_row_bytes = 180;
constexpr std::int64_t shape_bytes = 68, harmonics_bytes = 204;
constexpr std::int64_t sorting_bytes = 32;  // a row of a file whose rows are not in order of id
constexpr std::int64_t streamed_bytes_per_block = 128 * shaded_bytes + 256;  // sample, bounds
constexpr std::int64_t catalogue_bytes_per_star = 100;                       // HYG; Hipparcos, compressed

// More than any machine holds, few enough that bytes of many layers still fit 63 bits.
constexpr std::int64_t most_splats = 1'000'000'000'000'000;

struct Expected {
    std::int64_t splats = 0;
    std::int64_t making_bytes = 0;  // while the set is made or read; 0: what it takes then
    std::shared_ptr<const NativeBlocks> file = nullptr;  // of kind splats, where it is .splats
    bool has_radius = false;
    bool has_shapes = false;      // captures: their look leaves the set whole, as it has the shapes
    std::int64_t held_bytes = 0;  // by the set and by what is shaded, beyond what all have
};

Expected expected_columns(const SourceParams& source, const std::vector<TexturedMesh>& meshes) {
    Bounds box;
    for (const TexturedMesh& textured : meshes) box.add(bounds(textured.mesh));
    const double max_distance = resolved_max_distance(source, box);
    const Lattice lattice = make_lattice(source, meshes, max_distance);
    return {static_cast<std::int64_t>(expected_splats(source, lattice, meshes, max_distance)),
            columns_memory_bytes(meshes, lattice, max_distance)};
}

/// Of a file that cannot be read nothing: the reader will say why.
Expected expected_file(const std::filesystem::path& path) try {
    Expected expected;
    const std::vector<std::string> attributes = splat_attributes(path);
    const auto has = [&](const char* name) {
        return std::ranges::find(attributes, name) != attributes.end();
    };
    const std::string_view format = format_of_file(path)->id;
    if (format == "splats") {
        expected.file = std::make_shared<NativeBlocks>(path);
        expected.splats = expected.file->splats();
        expected.making_bytes = expected.file->bytes() + expected.splats * sorting_bytes;
    } else if (format == "gltf") {
        const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(path));
        expected.splats = bytes / (capture_row_bytes + (has("harmonics") ? harmonics_row_bytes : 0));
    } else {
        expected.splats = splat_count(path);
    }
    expected.has_radius = has("radius") || has("scale");
    expected.has_shapes = has("scale");
    if (expected.has_shapes)
        expected.held_bytes = expected.splats * (shape_bytes + (has("harmonics") ? harmonics_bytes : 0));
    return expected;
} catch (const InputError&) {
    return {};
}

Expected expected_of(const SetCache& cache, const LayerParams& layer) {
    const SourceParams& source = layer.source;
    if (source.kind == SourceKind::splats) return expected_file(source.file);
    if (source.kind == SourceKind::stars) {
        if (!source.stars.along.empty()) return {source.count};
        std::error_code ignored;
        const auto size = std::filesystem::file_size(source.stars.catalogue, ignored);
        return {ignored ? 0 : static_cast<std::int64_t>(size) / catalogue_bytes_per_star};
    }
    const bool bodies = source.structure.kind != StructureKind::columns;
    if (!bodies && has_automatic_voxels(source) && source.splats <= 0)
        return {source.count, columns_memory_bytes(source.count)};
    std::vector<TexturedMesh> meshes =
        load_meshes(cache, source, Progress{{}, &interrupted()}, most_texels_read(source, room_for_bodies()));
    if (!bodies) return expected_columns(source, meshes);
    const BodiesPlan plan = plan_bodies(source, std::move(meshes), layer.name);
    const std::int64_t dots = expected_dots(plan.meshes, plan.structure);
    return {std::min(dots, source.splats > 0 ? source.splats : most_splats),
            bodies_memory_bytes(plan.meshes, dots)};
}

/// Loads meshes and pictures where `count` alone does not tell and the set is not in the cache. Throws as
/// their readers do; of a file of splats that cannot be read nothing is needed: its reader will say why.
/// sampled: nullptr, of layers that are not.
LayerNeed need_of(const BatchPlan& plan, const LayerParams& layer, const SampledRun::Layer* sampled) {
    const bool is_kept = sampled && !sampled->is_made && layer.source.kind == SourceKind::mesh;
    Expected expected = is_kept ? Expected{} : expected_of(plan.cache, layer);
    if (sampled) expected.splats = sampled->splats;
    if (sampled && sampled->has_radius) expected.has_radius = true;
    expected.splats = std::min(expected.splats, most_splats);
    const Look look = look_of(layer);
    const OptionalColumns wanted = columns_read(look);
    const std::int64_t row = 40 + (wanted.uv ? 8 : 0) + (wanted.mesh ? 4 : 0) + (expected.has_radius ? 4 : 0);
    LayerNeed need{&layer, expected.splats, expected.has_shapes};
    need.making = std::max(expected.making_bytes, expected.splats * row);
    const bool used_up = is_shaded_alike(plan.scene, layer.name) && !expected.has_shapes;
    need.held = expected.splats * (used_up ? row : row + shaded_bytes);
    need.reads_pictures = !is_kept && layer.source.kind == SourceKind::mesh;
    need.making += expected.held_bytes;
    need.held += expected.held_bytes;
    if (expected.file)
        need.streamed = static_cast<std::int64_t>(expected.file->size()) * streamed_bytes_per_block;
    need.may_stream =
        expected.file && !is_encoded(layer.render) && why_not_streamed(*expected.file, look).empty();
    return need;
}

constexpr std::int64_t program_bytes = 45'000'000;  // with its libraries, before any scene
constexpr std::int64_t picture_bytes = 78'000'000;  // libraries that read pictures
constexpr std::int64_t drawing_bytes = 10'000'000;  // what rendering and writing any frame adds
constexpr std::int64_t worker_bytes = 800'000;      // a thread that renders, beside what folding takes
constexpr std::int64_t block_bytes = 6'700'000;     // the same where sets come by the block
constexpr std::int64_t reserve_bytes = 6'000'000;   // for what an estimate is short of, where a limit is kept
constexpr std::int64_t least_records = 24'000'000;  // bytes for projected splats that any frame is worth
// A projected splat lies in so many tiles, where nothing is known of the splats' places; and its place in a
// bin. A twentieth of the memory for those that are known stays unused, at the end of blocks.
constexpr double usual_records = 1.4, record_bytes = 44.0, fold_bytes = 56.0, unused_share = 1.05;
constexpr double split_records = 4.0;        // where large ones are split, in a pass close by
constexpr double shape_record_bytes = 40.0;  // outlines of those that are not round, while they are joined
constexpr std::int64_t largest_guess = 250'000'000;  // bytes, beyond which sets are made small to be sure

/// Of an environment's pictures: while they are read, and from then on, with borders and mip levels.
struct SkyBytes {
    std::int64_t making = 0, held = 0;
};

/// Nothing of files that cannot be read: their reader will say why.
SkyBytes sky_bytes(const EnvironmentParams& sky) try {
    constexpr std::int64_t held = 16, read = 16;  // bytes a texel, the latter of those read at once
    constexpr std::int64_t most_read = std::int64_t{64} << 20;  // bytes
    if (!sky.tile.empty()) {
        const std::int64_t texels = 6 * sky.tiling.face_px * sky.tiling.face_px;
        return {36 * texels, held * texels};  // of three floats: as made or read, and with borders
    }
    std::vector<std::filesystem::path> files = sky.cube;
    if (!sky.image.empty()) files = {sky.image};
    SkyBytes bytes;
    for (const std::filesystem::path& file : files) {
        const ImageRows rows = open_picture_rows(file).rows;
        const std::int64_t texels = rows.width * rows.height;
        bytes.making =
            std::max(bytes.making, bytes.held + held * texels + std::min(read * texels, most_read));
        bytes.held += held * texels;
    }
    return bytes;
} catch (const InputError&) {
    return {};
}

/// Of a sample while it is written: EXR takes floats.
std::int64_t written_bytes(const OutputParams& output) {
    switch (resolve_format(output, output.path).depth) {
        case OutputParams::Depth::uint8:
            return 1;
        case OutputParams::Depth::uint16:
            return 2;
        default:
            return sizeof(float);
    }
}

/// The frame, and what writing it takes.
std::int64_t frame_bytes(const BatchPlan& plan) {
    const OutputParams& output = plan.scene.output;
    const bool whole = plan.region.width == 0;
    const std::int64_t pixels = whole ? output.width * output.height : plan.region.width * plan.region.height;
    const std::int64_t layers =
        output.holds("layers") ? static_cast<std::int64_t>(plan.scene.layers.size()) : 0;
    const bool blurred =
        is_blurred(plan.scene.camera);  // two renderings, each with what depth is weighted by
    const std::int64_t planes =
        output.holds("depth") * (blurred ? 2 : 1) + output.holds("coverage") + output.holds("count");
    const std::int64_t images = blurred ? 2 : 1;
    const std::int64_t made = images * (4 + planes + 4 * layers);
    return pixels * (made * std::int64_t{sizeof(float)} + (4 + 4 * layers) * written_bytes(output));
}

bool uses_pictures(const BatchPlan& plan, const std::vector<LayerNeed>& needs) {
    const EnvironmentParams& sky = plan.scene.environment;
    return has_environment(sky) ||  // read also where it is not visible
           std::ranges::any_of(needs, &LayerNeed::reads_pictures);
}

/// Bytes of all layers: at the most while they are made one after the other, and when all are there.
struct SetBytes {
    std::int64_t making = 0, held = 0;
};
SetBytes sets_of(const std::vector<LayerNeed>& needs, const std::vector<std::string>& streamed) {
    SetBytes bytes;
    for (const LayerNeed& need : needs) {
        const bool on_disk = std::ranges::find(streamed, need.params->name) != streamed.end();
        if (!on_disk) bytes.making = std::max(bytes.making, bytes.held + need.making);
        bytes.held += on_disk ? need.streamed : need.held;
    }
    if (!streamed.empty()) bytes.held += thread_count() * block_bytes;
    return bytes;
}

bool is_split(const LayerParams& layer) { return layer.render.lod.max_px > 0.0; }

/// Bytes of projected splats of a layer of which nobody knows where they lie.
std::int64_t guessed_records(const OutputParams& output, const LayerNeed& need) {
    const double tiles = static_cast<double>(output.width * output.height) / 4096.0;
    const double folded = fold_bytes * std::min(1.0, 3.0 * thread_count() / std::max(1.0, tiles));
    const double each = (is_split(*need.params) ? split_records : usual_records) * (record_bytes + folded) +
                        (need.has_shapes ? shape_record_bytes : 0.0);
    return static_cast<std::int64_t>(each * static_cast<double>(need.splats));
}

}  // namespace

std::int64_t parse_memory(const std::string& text) {
    const std::optional<double> gib = parse_double(text);
    if (!gib || !(*gib > 0.0 && *gib < 1048576.0))
        bad_input("--memory", "", "a size in GiB, such as 4", "'" + text + "'");
    return static_cast<std::int64_t>(*gib * 1073741824.0);
}

void limit_bodies(LayerParams& layer, std::int64_t bytes, const SetCache& cache) {
    constexpr std::int64_t others_bytes = 189'000'000;  // never another number: pixels depend on it
    bytes = std::max<std::int64_t>(bytes - others_bytes, 1);
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
    {
        SampledRun sample(plan, SampledRun::Layers::there);
        JobEstimate job = estimate(plan, sample);
        if (job.guessed_bytes <= largest_guess) return job;
    }
    SampledRun sample(plan, SampledRun::Layers::meshes);
    return estimate(plan, sample);
}

JobEstimate estimate(const BatchPlan& plan, SampledRun& sample) {
    JobEstimate job;
    std::vector<LayerNeed> needs;
    for (const LayerParams& layer : plan.scene.layers) {
        if (!ever_visible(plan.scene, layer)) continue;
        needs.push_back(need_of(plan, layer, sample.find(layer.name)));
        job.layers.push_back({layer.name, needs.back().splats});
        job.splats += needs.back().splats;
    }
    const bool is_limited = plan.memory_limit_bytes > 0;
    const std::int64_t limit = is_limited ? plan.memory_limit_bytes : available_memory_bytes() / 10 * 9;
    const std::int64_t program = program_bytes + (uses_pictures(plan, needs) ? picture_bytes : 0);
    const std::int64_t working = program + drawing_bytes + frame_bytes(plan) + thread_count() * worker_bytes +
                                 (is_limited ? reserve_bytes : 0);
    auto records = static_cast<std::int64_t>(unused_share * static_cast<double>(sample.record_bytes()));
    for (const LayerNeed& need : needs) {
        if (sample.find(need.params->name)) continue;
        const std::int64_t bytes = guessed_records(plan.scene.output, need);
        records += bytes;
        if (need.params->source.kind == SourceKind::mesh) job.guessed_bytes += bytes;
    }
    const EnvironmentParams& sky = plan.scene.environment;
    const SkyBytes skies = sky_bytes(sky);
    if (sky.visible && !sky.tile.empty())
        job.sky_kept = is_kept(plan.cache, sky.tile, sky.tiling, Progress{{}, &interrupted()});
    const auto needed = [&](std::int64_t of_records) {
        const SetBytes sets = sets_of(needs, job.streamed);
        return std::max(program + std::max(sets.making + skies.held, skies.making),
                        working + sets.held + skies.held + of_records);
    };
    // Less than a part of the records makes many passes over what is in memory.
    std::vector<const LayerNeed*> largest;
    for (const LayerNeed& need : needs)
        if (need.may_stream) largest.push_back(&need);
    std::ranges::sort(largest, {}, [](const LayerNeed* need) { return -need->held; });
    for (const LayerNeed* need : largest)
        if (needed(std::max(records / 4, std::min(records, least_records))) > limit)
            job.streamed.push_back(need->params->name);
    job.bytes = needed(records);
    if (!is_limited && job.streamed.empty()) return job;
    const std::int64_t least = needed(std::min(records, least_records));
    if (is_limited && least > limit)
        bad_input("--memory", "",
                  fmt::format("at least {:.2f} GiB, which this needs",
                              static_cast<double>(least) / 1073741824.0 + 0.005),
                  fmt::format("{:.4g}", static_cast<double>(limit) / 1073741824.0));
    // Memory that malloc does not give back, and the last piece of each kind, is a thirtieth.
    job.renderer_bytes = std::max(
        limit - limit / 32 - working - sets_of(needs, job.streamed).held - skies.held, least_records);
    job.bytes = std::min(job.bytes, std::max(limit, least));
    return job;
}

}  // namespace astrosplat
