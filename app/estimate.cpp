// Memory, time and bytes that a batch run will take, before it takes them: from the scene, from file sizes
// and from a sample.
#include "estimate.h"

#include <fmt/format.h>

#include "bodies/bodies.h"
#include "camera/camera.h"
#include "command.h"
#include "core/error.h"
#include "core/file_format.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/text.h"
#include "exit.h"
#include "generate/generate.h"
#include "generate/lattice.h"
#include "output/format.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"
#include "sets/load_source.h"
#include "source/picture.h"
#include "splat_files/native.h"
#include "splat_files/splat_file.h"
#include "streamed/streamed_set.h"

namespace astrosplat {
namespace {

// One layer: from its source and the sizes of its files, and from its sample where there is one.

struct LayerNeed {
    const LayerParams* params = nullptr;
    std::int64_t splats = 0;
    std::int64_t making = 0, held = 0;  // bytes while it is made, and from then on
    std::int64_t streamed = 0;          // bytes held where it stays on disk
    bool has_radius = false;
    bool has_shapes = false;  // captures: their look leaves the set whole, as it has the shapes
    bool may_stream = false, reads_pictures = false;
};

constexpr std::int64_t shaded_bytes = 40;
// Of captures: a row of a file with normals; and, on top of what all splats have, shape and radius, harmonics
// and colours by direction.
constexpr std::int64_t capture_row_bytes = 68, harmonics_row_bytes = 180;
constexpr std::int64_t shape_bytes = 68, harmonics_bytes = 204;
// A row of a .splats file on top of its bytes, whose rows are put in order of id: bins, the order and a
// column in it; and the last pages of all arrays, 2 MiB each. As VmHWM shows for files of 1 to 12 M splats.
constexpr std::int64_t sorting_bytes = 20, most_last_pages = 22'000'000;
constexpr std::int64_t streamed_bytes_per_block = 128 * shaded_bytes + 256;  // sample, bounds
constexpr std::int64_t catalogue_bytes_per_star = 100;                       // HYG; Hipparcos, compressed

// More than any machine holds, few enough that bytes of many layers still fit 63 bits.
constexpr std::int64_t most_splats = 1'000'000'000'000'000;

LayerNeed need_of_columns(const SourceParams& source, const std::vector<TexturedMesh>& meshes) {
    Bounds box;
    for (const TexturedMesh& textured : meshes) box.add(bounds(textured.mesh));
    const double max_distance = resolved_max_distance(source, box);
    const Lattice lattice = make_lattice(source, meshes, max_distance);
    return {.splats = static_cast<std::int64_t>(expected_splats(source, lattice, meshes, max_distance)),
            .making = columns_memory_bytes(meshes, lattice, max_distance)};
}

/// Of a file that cannot be read nothing: the reader will say why.
LayerNeed need_of_file(const LayerParams& layer) try {
    const fs::path& path = layer.source.file;
    LayerNeed need;
    const std::vector<std::string> attributes = splat_attributes(path);
    const auto has = [&](const char* name) {
        return std::ranges::find(attributes, name) != attributes.end();
    };
    const std::string_view format = format_of_file(path)->id;
    if (format == "splats") {
        const NativeBlocks file(path);
        need.splats = file.splats();
        need.making = file.bytes() + need.splats * sorting_bytes +
                      std::min(need.splats * sorting_bytes, most_last_pages);
        need.streamed = static_cast<std::int64_t>(file.size()) * streamed_bytes_per_block;
        need.may_stream =
            !is_mixed_in_display_space(layer.render) && why_not_streamed(file, look_of(layer)).empty();
    } else if (format == "gltf") {
        const auto bytes = static_cast<std::int64_t>(fs::file_size(path));
        need.splats = bytes / (capture_row_bytes + (has("harmonics") ? harmonics_row_bytes : 0));
    } else {
        need.splats = splat_count(path);
    }
    need.has_radius = has("radius") || has("scale");
    need.has_shapes = has("scale");
    if (need.has_shapes) need.held = need.splats * (shape_bytes + (has("harmonics") ? harmonics_bytes : 0));
    return need;
} catch (const InputError&) {
    return {};
}

LayerNeed need_of_source(const SetCache& cache, const LayerParams& layer) {
    const SourceParams& source = layer.source;
    if (source.kind == SourceKind::splats) return need_of_file(layer);
    if (source.kind == SourceKind::stars) {
        if (!source.stars.along.empty()) return {.splats = source.count};
        std::error_code ignored;
        const auto size = fs::file_size(source.stars.catalogue, ignored);
        return {.splats = ignored ? 0 : static_cast<std::int64_t>(size) / catalogue_bytes_per_star};
    }
    const bool bodies = source.structure.kind != StructureKind::columns;
    if (!bodies && has_automatic_voxels(source) && source.splats <= 0)
        return {.splats = source.count, .making = columns_memory_bytes(source.count)};
    std::vector<TexturedMesh> meshes =
        load_meshes(cache, source, stoppable(), most_texels_read(source, room_for_bodies()));
    if (!bodies) return need_of_columns(source, meshes);
    const BodiesPlan plan = plan_bodies(source, std::move(meshes), layer.name);
    const std::int64_t splats = expected_splats(plan.meshes, plan.structure);
    return {.splats = std::min(splats, source.splats > 0 ? source.splats : most_splats),
            .making = bodies_memory_bytes(plan.meshes, plan.structure, splats)};
}

/// Loads meshes and pictures where `count` alone does not tell and the set is not in the cache. Throws as
/// their readers do; of a file of splats that cannot be read nothing is needed: its reader will say why.
/// sampled: nullptr, of layers that are not.
LayerNeed need_of(const BatchPlan& plan, const LayerParams& layer, const SampledRun::Layer* sampled) {
    const bool is_kept = sampled && !sampled->is_made && layer.source.kind == SourceKind::mesh;
    const bool planned = sampled && sampled->making_bytes > 0;  // its pictures need not be read again
    LayerNeed need = is_kept   ? LayerNeed{}
                     : planned ? LayerNeed{.making = sampled->making_bytes}
                               : need_of_source(plan.cache, layer);
    need.params = &layer;
    if (sampled) need.splats = sampled->splats;
    need.splats = std::min(need.splats, most_splats);
    need.has_radius |= sampled && sampled->has_radius;
    need.reads_pictures = !is_kept && layer.source.kind == SourceKind::mesh;
    const OptionalColumns wanted = columns_read(look_of(layer));
    const std::int64_t row = 40 + (wanted.uv ? 8 : 0) + (wanted.mesh ? 4 : 0) + (need.has_radius ? 4 : 0);
    const bool used_up = is_shaded_alike(plan.scene, layer.name) && !need.has_shapes;
    need.making = need.held + std::max(need.making, need.splats * row);
    need.held += need.splats * (used_up ? row : row + shaded_bytes);
    return need;
}

constexpr std::int64_t program_bytes = 44'000'000;  // with its libraries, before any scene
constexpr std::int64_t picture_bytes = 92'000'000;  // libraries that read pictures
// What malloc keeps of one layer while the next is read: two and three of 1 M splats each took 8 to 14 MB
// more.
constexpr std::int64_t next_layer_bytes = 12'000'000;
constexpr std::int64_t drawing_bytes = 10'000'000;  // what rendering and writing any frame adds
constexpr std::int64_t worker_bytes = 800'000;      // a thread that renders, besides what folding takes
constexpr std::int64_t block_bytes = 6'700'000;     // the same where sets come by the block
// Over what is counted: buffers grow by steps, malloc keeps holes, AOVs take more than their planes. Without
// it 30 runs took from 16 % less to 8 % more than estimated: files and meshes in memory and on disk, one to
// three layers, every AOV, blur, panoramas, split splats, each format, up to 4K.
constexpr double estimate_margin = 1.1;
constexpr std::int64_t reserve_bytes = 8'000'000;   // for what an estimate is short of, where a limit is kept
constexpr std::int64_t least_records = 24'000'000;  // bytes for projected splats that any frame is worth
// A projected splat lies in so many tiles, where nothing is known of the splats' places; and its place in a
// bin. Up to a twelfth of the memory for those that are known stays unused, at the end of blocks.
constexpr double usual_records = 1.4, record_bytes = 44.0, fold_bytes = 56.0, unused_share = 1.08;
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
    std::vector<fs::path> files = sky.cube;
    if (!sky.image.empty()) files = {sky.image};
    SkyBytes bytes;
    for (const fs::path& file : files) {
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

// Of a file of EXR: rows that are stored together, and what OpenEXR takes for the planes of a layer (from
// 640x360 to 3840x2160 px the peak rose by 9 to 13 MB a layer besides its floats).
constexpr std::int64_t stored_rows = 256, layer_plane_bytes = 11'000'000;

/// Bytes of memory that writing a frame takes. `layers` have planes of their own.
std::int64_t written_bytes(const OutputParams& output, std::int64_t width, std::int64_t height,
                           std::int64_t layers) {
    const FrameFormat format = resolve_format(output, output.path);
    const std::int64_t values = 4 + 4 * layers;  // a pixel, of light and alpha
    if (format.kind != FrameKind::exr) {
        const bool is_8_bit = format.depth == OutputParams::Depth::uint8;
        const bool is_16_bit = format.depth == OutputParams::Depth::uint16;
        return width * height * values * (is_8_bit ? 1 : is_16_bit ? 2 : 4);
    }
    const std::int64_t stored =
        (values + output.holds("coverage")) * (format.depth == OutputParams::Depth::float32 ? 4 : 2) +
        4 * (output.holds("depth") + output.holds("count"));
    return width * (height * values * std::int64_t{sizeof(float)} + std::min(height, stored_rows) * stored) +
           layers * layer_plane_bytes;
}

/// The frame, and what writing it takes. A blurred one is made of two renderings, each with what depth is
/// weighted by; the second is gone when it is written.
std::int64_t frame_bytes(const BatchPlan& plan) {
    const OutputParams& output = plan.scene.output;
    const bool whole = plan.region.width == 0;
    const std::int64_t width = whole ? output.width : plan.region.width,
                       height = whole ? output.height : plan.region.height;
    const std::int64_t layers =
        output.holds("layers") ? static_cast<std::int64_t>(plan.scene.layers.size()) : 0;
    const bool blurred = is_blurred(plan.scene.camera);
    const std::int64_t planes = 4 + output.holds("depth") * (blurred ? 2 : 1) + output.holds("coverage") +
                                output.holds("count") + 4 * layers;
    const std::int64_t made = width * height * planes * std::int64_t{sizeof(float)};
    return made + std::max(written_bytes(output, width, height, layers), blurred ? made : 0);
}

bool uses_pictures(const BatchPlan& plan, const std::vector<LayerNeed>& needs) {
    const EnvironmentParams& sky = plan.scene.environment;
    return has_environment(sky) ||  // read also where it is not visible
           std::ranges::any_of(needs, &LayerNeed::reads_pictures);
}

/// All layers of a job, and what it takes besides them.
struct JobNeed {
    std::vector<LayerNeed> layers;
    SkyBytes sky;
    std::int64_t program = 0;  // bytes from its start on
    std::int64_t working = 0;  // the same and what rendering takes besides sets, sky and records
};

using Names = std::vector<std::string>;

std::int64_t held_bytes(const JobNeed& job, const Names& streamed) {
    std::int64_t held = job.sky.held + (streamed.empty() ? 0 : thread_count() * block_bytes), whole = 0;
    for (const LayerNeed& need : job.layers) {
        const bool on_disk = std::ranges::count(streamed, need.params->name) > 0;
        held += on_disk ? need.streamed : need.held;
        whole += !on_disk;
    }
    return held + std::max<std::int64_t>(0, whole - 1) * next_layer_bytes;
}

/// While sets and sky are made one after the other, sky last.
std::int64_t making_bytes(const JobNeed& job, const Names& streamed) {
    std::int64_t most = job.sky.making, held = job.sky.held;
    for (const LayerNeed& need : job.layers) {
        const bool on_disk = std::ranges::count(streamed, need.params->name) > 0;
        if (!on_disk) most = std::max(most, held + need.making);
        held += on_disk ? need.streamed : need.held + next_layer_bytes;
    }
    return job.program + most;
}

/// At its peak, with so many bytes of records.
std::int64_t peak_bytes(const JobNeed& job, const Names& streamed, std::int64_t records) {
    return std::max(making_bytes(job, streamed), job.working + held_bytes(job, streamed) + records);
}

/// Those that have to stay on disk, the largest first. With less than a part of the records in memory there
/// would be many passes over what is in memory.
Names layers_on_disk(const JobNeed& job, std::int64_t all_records, std::int64_t limit) {
    std::vector<const LayerNeed*> largest;
    for (const LayerNeed& need : job.layers)
        if (need.may_stream) largest.push_back(&need);
    std::ranges::sort(largest, {}, [](const LayerNeed* need) { return -need->held; });
    const std::int64_t records = std::max(all_records / 4, std::min(all_records, least_records));
    Names streamed;
    for (const LayerNeed* need : largest)
        if (peak_bytes(job, streamed, records) > limit) streamed.push_back(need->params->name);
    return streamed;
}

bool is_split(const LayerParams& layer) { return layer.render.lod.max_px > 0.0; }

/// Bytes of projected splats of a layer whose places are not known yet.
std::int64_t guessed_records(const OutputParams& output, const LayerNeed& need) {
    const double tiles = static_cast<double>(output.width * output.height) / 4096.0;
    const double folded = fold_bytes * std::min(1.0, 3.0 * thread_count() / std::max(1.0, tiles));
    const double each = (is_split(*need.params) ? split_records : usual_records) * (record_bytes + folded) +
                        (need.has_shapes ? shape_record_bytes : 0.0);
    return static_cast<std::int64_t>(each * static_cast<double>(need.splats));
}

/// Bytes of projected splats in the fullest frame. Sets guesses_much.
std::int64_t expected_records(const BatchPlan& plan, const std::vector<LayerNeed>& needs, SampledRun& sample,
                              JobEstimate& job) {
    auto records = static_cast<std::int64_t>(unused_share * static_cast<double>(sample.record_bytes()));
    std::int64_t guessed = 0;
    for (const LayerNeed& need : needs) {
        if (sample.find(need.params->name)) continue;
        const std::int64_t bytes = guessed_records(plan.scene.output, need);
        records += bytes;
        if (need.params->source.kind != SourceKind::mesh) continue;
        guessed += bytes;
        job.guesses_much |= guessed > largest_guess || is_split(*need.params);
    }
    return records;
}

JobNeed need_of(const BatchPlan& plan, std::vector<LayerNeed> layers) {
    JobNeed need;
    need.program = program_bytes + (uses_pictures(plan, layers) ? picture_bytes : 0);
    need.working = need.program + drawing_bytes + frame_bytes(plan) + thread_count() * worker_bytes +
                   (plan.memory_limit_bytes > 0 ? reserve_bytes : 0);
    need.sky = sky_bytes(plan.scene.environment);
    need.layers = std::move(layers);
    return need;
}

/// Pictures that take seconds to read are read once, for a sample: of so many texels bodies are hardly ever
/// so few that none is wanted.
bool has_large_picture(const BatchPlan& plan) try {
    constexpr std::int64_t large = 16'000'000;  // texels
    return std::ranges::any_of(plan.scene.layers, [&](const LayerParams& layer) {
        const SourceParams& source = layer.source;
        if (!ever_visible(plan.scene, layer) || source.kind != SourceKind::mesh || makes_columns(source))
            return false;
        return std::ranges::any_of(source.meshes, [](const MeshInput& mesh) {
            if (mesh.texture.empty()) return false;
            const ImageRows rows = open_picture_rows(mesh.texture.front()).rows;
            return rows.width * rows.height >= large;
        });
    });
} catch (const InputError&) {  // which its reader will say
    return false;
}

[[noreturn]] void refuse_limit(std::int64_t least, std::int64_t limit) {
    constexpr double gib = 1073741824.0;
    bad_input("--memory", "",
              fmt::format("at least {:.2f} GiB, which this needs", static_cast<double>(least) / gib + 0.005),
              fmt::format("{:.4g}", static_cast<double>(limit) / gib));
}

}  // namespace

JobEstimate estimate(const BatchPlan& plan) {
    if (!has_large_picture(plan)) {
        SampledRun sample(plan, SampledRun::Layers::there);
        JobEstimate job = estimate(plan, sample);
        if (!job.guesses_much) return job;
    }
    SampledRun sample(plan, SampledRun::Layers::meshes);
    return estimate(plan, sample);
}

JobEstimate estimate(const BatchPlan& plan, SampledRun& sample) {
    JobEstimate job;
    std::vector<LayerNeed> layers;
    for (const LayerParams& layer : plan.scene.layers) {
        if (!ever_visible(plan.scene, layer)) continue;
        layers.push_back(need_of(plan, layer, sample.find(layer.name)));
        job.layers.push_back({layer.name, layers.back().splats});
        job.splats += layers.back().splats;
    }
    const EnvironmentParams& sky = plan.scene.environment;
    if (sky.visible && !sky.tile.empty())
        job.sky_kept = is_kept(plan.cache, sky.tile, sky.tiling, stoppable());
    const std::int64_t records = expected_records(plan, layers, sample, job);
    const JobNeed need = need_of(plan, std::move(layers));
    const bool is_limited = plan.memory_limit_bytes > 0;
    const std::int64_t limit = is_limited ? plan.memory_limit_bytes : available_memory_bytes() / 10 * 9;
    job.streamed = layers_on_disk(need, records, limit);
    job.bytes = static_cast<std::int64_t>(estimate_margin *
                                          static_cast<double>(peak_bytes(need, job.streamed, records)));
    if (!is_limited && job.streamed.empty()) return job;
    const std::int64_t least = peak_bytes(need, job.streamed, std::min(records, least_records));
    if (is_limited && least > limit) refuse_limit(least, limit);
    // Memory that malloc does not give back, and the last piece of each kind, is a thirtieth.
    job.renderer_bytes =
        std::max(limit - limit / 32 - need.working - held_bytes(need, job.streamed), least_records);
    job.bytes = std::min(job.bytes, std::max(limit, least));
    return job;
}

}  // namespace astrosplat
