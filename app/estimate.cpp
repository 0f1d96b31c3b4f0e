// Memory, time and bytes that a batch run will take, before it takes them: from the scene, from file sizes
// and from a sample.
#include "estimate.h"

#include <fmt/format.h>

#include <algorithm>

#include "bodies/picture_size.h"
#include "camera/aperture.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/text.h"
#include "interrupt.h"
#include "layer_need.h"
#include "output/format.h"
#include "pipeline.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"
#include "sets/kept.h"
#include "sets/load_source.h"
#include "source/picture.h"

namespace astrosplat {
namespace {

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
