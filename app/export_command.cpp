// generate, convert, camera and export: splats and cameras into files, without rendering. export writes the
// shaded splats of one frame, baked, as Gaussians (.ply, .glb, .usda, .spz) or as an OpenVDB volume (.vdb).
// One line about the file goes to stdout.
#include <fmt/format.h>

#include <glm/common.hpp>

#include "batch_plan.h"
#include "camera/camera.h"
#include "command.h"
#include "core/color.h"
#include "core/error.h"
#include "core/file.h"
#include "core/file_format.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/progress.h"
#include "core/text.h"
#include "exit.h"
#include "gaussians/gaussian_file.h"
#include "gaussians/gaussians.h"
#include "pipeline.h"
#include "render/frame.h"
#include "scene/camera_file.h"
#include "scene/frames.h"
#include "scene/layer_setup.h"
#include "scene/source_metadata.h"
#include "sets/load_source.h"
#include "splat_files/splat_file.h"
#include "volumes/openvdb_file.h"
#include "volumes/voxel_grid.h"

namespace astrosplat {
namespace {

/// The output, once it is sure that it can be written.
WriteTarget claim_splat_output(const CommandOptions& options) {
    const fs::path& file = *options.output;
    const FileFormat* format = format_by_name(file);
    if (kind_of(format) != FileKind::splats || !includes(format->uses, FileUse::written))
        bad_input(file.string(), "",
                  fmt::format("a name ending in {}",
                              fmt::join(endings_of({FileKind::splats}, FileUse::written), " or ")),
                  "'" + file.extension().string() + "'");
    return claim_output(options);
}

void report_file(const fs::path& file, std::int64_t splats) {
    fmt::print("{}: {}\n", printable(file.string()), counted(splats, "splat"));
}

void write_and_report(const WriteTarget& target, const SplatSet& set, ProgressReport& report) {
    write_splats(target, set, report.begin_step("writing"));
    report_file(target.file, set.size());
}

/// The set of columns that memory does not hold, of which nothing is kept in the cache.
void write_in_parts(const WriteTarget& target, const SourceParams& source, const std::string& layer_name,
                    ProgressReport& report) {
    log_info(fmt::format(
        "layer '{}': more than memory holds; it is written in parts, for which space is searched twice",
        layer_name));
    const Progress progress = report.begin_step("generating " + layer_name);
    report_file(target.file,
                write_columns(target, plan_columns(source, layer_name, progress), layer_name, progress));
}

struct GenerateOptions {
    std::string layer;
};

int run_generate(const CommandOptions& options, const GenerateOptions& own) {
    const Scene scene = load_scene(options.input, assignments_of(options));
    LayerParams layer = layer_named(scene, own.layer);
    const std::int64_t most_bytes = options.memory_gib ? parse_memory(*options.memory_gib) : 0;
    const WriteTarget target = claim_splat_output(options);
    ProgressReport report(options.progress);
    if (most_bytes > 0) limit_bodies(layer, most_bytes, options.cache);
    const SourceParams source = source_of(scene, layer);
    const bool columns = makes_columns(source);
    if (columns && most_bytes > 0) limit_memory(most_bytes);
    try {
        const SplatSet set =
            load_source(options.cache, source, layer.name, report.begin_step("generating " + layer.name)).set;
        write_and_report(target, set, report);
    } catch (const NotEnoughMemory&) {
        if (!columns || format_by_name(target.file)->id != "splats") throw;
        write_in_parts(target, source, layer.name, report);
    }
    return exit_done;
}

int run_convert(const CommandOptions& options) {
    require_readable(options.input);
    const WriteTarget target = claim_splat_output(options);
    ProgressReport report(options.progress);
    write_and_report(target, read_splats(options.input, report.begin_step("reading")), report);
    return exit_done;
}

int run_camera(const CommandOptions& options) {
    const Scene scene = load_scene(options.input, assignments_of(options));
    const std::vector<std::int64_t> frames =
        options.frames ? parse_frames(*options.frames, "--frames")
                       : parse_frames(scene.output.frames, scene.file.string() + ": output.frames");
    const fs::path& file = *options.output;
    refuse_to_overwrite(file, options.overwrite);
    if (const std::string missed = missed_camera_frames(scene, frames); !missed.empty()) log_warning(missed);
    write_file_atomically(file, camera_text(camera_track(scene, frames), scene, file), existing_of(options));
    fmt::print("{}: {}\n", printable(file.string()), counted(std::ssize(frames), "frame"));
    return exit_done;
}

}  // namespace

void add_generate(CLI::App& app, Invocation& call) {
    auto [command, own] =
        add_command(app, call, "generate", "Generates a layer's splats into a file", run_generate);
    add_input(command, call.options, "SCENE", "The scene");
    add_value(command, "--layer", own.layer, "NAME", "Name of the layer")->required();
    add_output(command, call.options, "FILE.(pda|ply|splats)", "The splat file to write");
    add_assignments(command, call.options);
    add_value(command, "--memory", call.options.memory_gib, "GiB",
              "Limit of what is taken: pictures of bodies that would take more are reduced, columns written "
              "in parts");
    add_progress(command, call.options);
}

void add_convert(CLI::App& app, Invocation& call) {
    const auto a_file = [](const std::vector<std::string>& endings) {
        return "A " + alternatives(endings) + " file";
    };
    CLI::App& command = add_command(app, call, "convert", "Converts between splat files", run_convert);
    add_input(command, call.options, "IN", a_file(endings_of({FileKind::splats})));
    add_value(command, "OUT", call.options.output, "OUT",
              a_file(endings_of({FileKind::splats}, FileUse::written)))
        ->required();
    command.add_flag("--overwrite", call.options.overwrite, "Replaces what is there already");
    add_progress(command, call.options);
}

void add_camera(CLI::App& app, Invocation& call) {
    CLI::App& command =
        add_command(app, call, "camera", "Writes the scene's camera for other programs", run_camera);
    add_input(command, call.options, "SCENE", "The scene");
    add_output(command, call.options, "FILE.(chan|csv|gltf|usda)", "The camera file to write");
    add_value(command, "-f,--frames", call.options.frames, "1-100,120,200-300x2", "Instead of output.frames");
    add_assignments(command, call.options);
}

namespace {

// Export of volumes.

struct VolumeExport {
    double gain = 1.0;        // of light
    double voxel_size = 0.0;  // scene units; 0: default_voxel_size
    VolumeWords words;
    WriteTarget target;
};

struct GridFacts {
    double density = 0.0;  // sums over voxels times their volume: square scene units
    glm::dvec3 emission{0.0};
    std::int64_t active = 0;
    glm::ivec3 lo{0}, hi{0};  // voxels
};

GridFacts facts_of(const VoxelGrid& grid) {
    GridFacts facts;
    facts.lo = glm::ivec3(1 << 30);
    facts.hi = -facts.lo;
    for (std::size_t i = 0; i < grid.density.size(); ++i) {
        if (grid.density[i] == 0.0f && grid.emission[i] == glm::vec3(0.0f)) continue;
        const auto in = static_cast<int>(i % block_voxels);
        const glm::ivec3 voxel =
            block_side * grid.blocks[i / block_voxels] + glm::ivec3(in / 64, in / 8 % 8, in % 8);
        facts.lo = glm::min(facts.lo, voxel);
        facts.hi = glm::max(facts.hi, voxel);
        ++facts.active;
        facts.density += grid.density[i];
        facts.emission += grid.emission[i];
    }
    const double volume = grid.voxel_size * grid.voxel_size * grid.voxel_size;
    facts.density *= volume;
    facts.emission *= volume;
    return facts;
}

double luminance_of(const glm::dvec3& c) { return luminance(float(c.x), float(c.y), float(c.z)); }

double percent_lost(double put, double there) { return put > 0.0 ? 100.0 * (1.0 - there / put) : 0.0; }

void report(const WriteTarget& target, const VoxelGrid& grid, const BakeCounts& counts) {
    const GridFacts facts = facts_of(grid);
    const glm::ivec3 side = facts.hi - facts.lo + 1;
    std::string line = fmt::format(
        "{}: {} x {} x {} voxels of {:.4g}, {} in use; density adds up to {:.4g}, light to {:.4g} square "
        "scene "
        "units; {:.2f} % of the light lost",
        printable(target.file.string()), side.x, side.y, side.z, grid.voxel_size,
        human_count(double(facts.active)), facts.density, luminance_of(facts.emission),
        std::fabs(percent_lost(luminance_of(grid.emission_put), luminance_of(facts.emission))));
    if (facts.density == 0.0) line += "; nothing hides, so density is empty";
    if (counts.dust > 0) line += fmt::format("; {} of dust are grey", counts.dust);
    fmt::print("{}\n", line);
}

/// Of the scene, or of its files where it gives none.
ProvenanceParams provenance_of(const FrameScene& frame, const Pipeline& pipeline) {
    return resolved(frame.scene.provenance, pipeline.input_metadata());
}

VolumeWords words_about(const FrameScene& frame, const Pipeline& pipeline) {
    const ProvenanceParams from = provenance_of(frame, pipeline);
    VolumeWords words = {{"creator", std::string("astrosplat ") + ASTROSPLAT_VERSION},
                         {"title", from.title},
                         {"credit", from.credit},
                         {"type", from.type},
                         {"origin", pipeline.input_origin()},
                         {"frame", fmt::format("{}", frame.number)},
                         {"exposure_stops", fmt::format("{}", render_settings(frame.scene.output).exposure)},
                         {"density", "extinction per scene unit"},
                         {"emission", "linear light per scene unit, primaries of Rec. 709"},
                         {"Cd", "straight colour: emission / density of what blends over"},
                         {"up", "y"}};
    std::erase_if(words, [](const auto& word) { return word.second.empty(); });
    return words;
}

/// False where no splat is seen, and then nothing is written. Throws InputError (memory, voxels too small),
/// OutputError, Cancelled.
bool export_volume(const std::vector<RenderLayer>& layers, const Camera& camera, const VolumeExport& volume,
                   const Progress& progress) {
    std::vector<VoxelSplat> splats;
    BakeCounts counts;
    for (const RenderLayer& layer : layers) add_voxel_splats(layer, camera, volume.gain, splats, counts);
    if (splats.empty()) return false;
    const double size = volume.voxel_size > 0.0 ? volume.voxel_size : default_voxel_size(splats);
    const VoxelGrid grid = fill_voxels(splats, size, progress);
    write_openvdb(volume.target, grid, volume.words, progress);
    report(volume.target, grid, counts);
    return true;
}

// Gaussians, and what both share.

constexpr std::int64_t fitted_height_px = 540;

struct ExportOptions {
    std::optional<std::string> frame, layer, count, space, voxel_size;
};

/// One of the table of formats: "ply", "gltf", "usda", "spz" or "openvdb".
std::string_view format_of_output(const fs::path& file) {
    if (const FileFormat* const format = format_by_name(file, FileUse::exported)) return format->id;
    bad_input(file.string(), "", "a name ending in " + alternatives(endings_of(FileUse::exported)),
              "'" + file.extension().string() + "'");
}

bool is_volume(std::string_view format) { return format == "openvdb"; }

/// Whether colours are encoded for a display.
bool has_display_values(const ExportOptions& options, std::string_view format) {
    const bool linear = format == "gltf" || is_volume(format);
    const std::string space = options.space.value_or(linear ? "linear" : "display");
    if (space != "display" && space != "linear")
        bad_input("--space", "", "display or linear", "'" + space + "'");
    if (space == "display" && is_volume(format))
        bad_input("--space", "", "linear for .vdb, which holds light", "'display'");
    if (space == "linear" && !linear)
        bad_input("--space", "", "display for .ply, .usda and .spz, whose readers know no other", "'linear'");
    return space == "display";
}

double frame_of(const ExportOptions& options, const Scene& scene) {
    constexpr double most = std::numeric_limits<double>::max();
    return options.frame ? option_number("--frame", *options.frame, "a number", -most, most)
                         : static_cast<double>(parse_frames(scene.output.frames, "output.frames").front());
}

/// 0: all.
std::int64_t count_of(const ExportOptions& options) {
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
    return options.count ? option_count("--count", *options.count, "a number of splats, 1 or more", 1, most)
                         : 0;
}

/// 0: none was asked for.
double voxel_size_of(const ExportOptions& options, const fs::path& output) {
    using Limits = std::numeric_limits<double>;
    if (!options.voxel_size) return 0.0;
    const double size = option_number("--voxel-size", *options.voxel_size, "a number above 0, in scene units",
                                      Limits::denorm_min(), Limits::max());
    if (!is_volume(format_of_output(output)))
        bad_input("--voxel-size", "", "a name ending in .vdb", "'" + output.string() + "'");
    return size;
}

/// Hides all other layers, and what no Gaussian can be.
void keep_exported(Scene& scene, const std::optional<std::string>& wanted) {
    if (wanted) layer_named(scene, *wanted);
    std::erase_if(scene.layers, [&](const LayerParams& layer) {
        if (wanted && layer.name != *wanted) return true;
        if (layer.source.kind != SourceKind::stars) return false;
        log_warning(fmt::format("layer '{}' is left out: stars have their size in pixels, not in the scene",
                                layer.name));
        return true;
    });
    const auto is_gone = [&](const Track& track) {
        return !track.key.layer().empty() &&
               std::ranges::none_of(
                   scene.layers, [&](const LayerParams& layer) { return layer.name == track.key.layer(); });
    };
    std::erase_if(scene.animation, is_gone);
    scene.environment.visible = false;
    scene.camera.shutter = scene.camera.f_number = 0.0;
}

/// The frame that display colours are fitted to: the scene's, smaller.
RenderSettings fitted_settings(const FrameScene& now) {
    RenderSettings settings = render_settings(now.scene.output);
    settings.aov_depth = settings.aov_coverage = settings.aov_count = settings.aov_layers = false;
    const double scale = std::min(1.0, double(fitted_height_px) / double(settings.height));
    settings.width = std::max<std::int64_t>(1, std::llround(scale * double(settings.width)));
    settings.height = std::max<std::int64_t>(1, std::llround(scale * double(settings.height)));
    return settings;
}

/// Layers of merged splats, which `reduced` holds.
void merge_splats(std::vector<RenderLayer>& layers, std::vector<ShadedSplats>& reduced, const Camera& camera,
                  std::int64_t count, const Progress& progress) {
    std::int64_t all = 0;
    for (const RenderLayer& layer : layers) all += layer.splats->size();
    reduced = reduce_splats(layers, camera.world_from_camera, count, progress);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        layers[i].splats = &reduced[i];
        layers[i].render.opacity = 1.0f;
        if (all > count) layers[i].directional = nullptr;  // splats that stand for many look alike all around
    }
}

struct Baked {
    Gaussians gaussians;
    BakeCounts counts;
};

Baked bake(const std::vector<RenderLayer>& layers, const Camera& camera, double gain) {
    Baked baked;
    for (const RenderLayer& layer : layers) bake_layer(layer, camera, gain, baked.gaussians, baked.counts);
    return baked;
}

[[noreturn]] void refuse_nothing(const Scene& scene) {
    bad_input(scene.file.string(), "", "splats that are visible at this frame", "none");
}

void report(const fs::path& file, const Baked& baked) {
    const BakeCounts& n = baked.counts;
    std::string line =
        fmt::format("{}: {}; {:.2f} % of the light lost, {} above 1", printable(file.string()),
                    counted(baked.gaussians.size(), "splat"), 100.0 * n.share_lost(), n.bright);
    if (n.faint > 0) line += fmt::format("; {} fainter than 1/255, which some programs do not draw", n.faint);
    if (n.dust > 0) line += fmt::format("; {} of dust are grey", n.dust);
    fmt::print("{}\n", line);
}

int run_export(const CommandOptions& options, const ExportOptions& own) {
    const std::string_view format = format_of_output(*options.output);
    const bool encoded = has_display_values(own, format);
    const std::int64_t count = count_of(own);
    const double voxel_size = voxel_size_of(own, *options.output);
    Scene scene = load_scene(options.input, assignments_of(options));
    const double frame = frame_of(own, scene);
    keep_exported(scene, own.layer);
    const WriteTarget target = claim_output(options);
    ProgressReport progress(options.progress);
    Pipeline pipeline(scene, progress.begin_step("loading"), options.cache);
    const FrameScene now = pipeline.frame_scene(frame);
    const RenderSettings settings = fitted_settings(now);
    const Camera camera = pipeline.camera(now, settings);
    const double gain = std::exp2(double(settings.exposure));
    Image wanted;
    std::vector<RenderLayer> layers = pipeline.shaded_layers(now);
    const bool fits = std::ranges::all_of(layers, [](const RenderLayer& l) { return l.splats->encoded; });
    if (encoded && !fits) {
        wanted = pipeline.frame(now, settings, progress.begin_step("rendering")).beauty;
        layers = pipeline.shaded_layers(now);
    }
    for (float& value : wanted.pixels) value *= static_cast<float>(gain);
    std::vector<ShadedSplats> reduced;
    const Progress baking = progress.begin_step("baking");
    if (count > 0) merge_splats(layers, reduced, camera, count, baking);
    if (is_volume(format)) {
        const VolumeExport volume{gain, voxel_size, words_about(now, pipeline), target};
        if (!export_volume(layers, camera, volume, baking)) refuse_nothing(scene);
        return exit_done;
    }
    Baked baked = bake(layers, camera, gain);
    if (baked.gaussians.size() == 0) refuse_nothing(scene);
    if (encoded) encode_for_display(baked.gaussians);
    if (encoded && !fits) fit_to_view(baked.gaussians, wanted, camera, settings);
    finish_harmonics(baked.gaussians, camera, encoded);
    baked.gaussians.credit = provenance_of(now, pipeline).credit;
    baked.gaussians.origin = pipeline.input_origin();
    const Progress writing = progress.begin_step("writing");
    if (format == "ply")
        write_gaussian_ply(target, baked.gaussians, writing);
    else if (format == "usda")
        write_gaussian_usda(target, baked.gaussians, writing);
    else if (format == "spz")
        write_gaussian_spz(target, baked.gaussians, writing);
    else
        write_gaussian_glb(target, baked.gaussians, encoded, writing);
    report(target.file, baked);
    return exit_done;
}

/// With all that is approximated.
constexpr const char* export_help =
    "Writes the scene's splats for other programs, with the look and the exposure of one frame: as "
    "Gaussians (3D Gaussian Splatting) in .ply, .glb, .usda and .spz, as a volume in .vdb (OpenVDB). "
    "Approximated: other falloffs by the nearest Gaussian of the same integral; screen and hybrid by what "
    "they hide (hybrid as seen from that frame's camera); dust by grey; Gaussians that were read keep "
    "their shapes, and their harmonics up to the degree of their file: exact in the direction of that "
    "frame's camera, in all others times what the look and the frame did to that one, channel by channel "
    "(.vdb and splats merged by --count have the one colour that the camera sees). As Gaussians: add by "
    "over, light above 1 by more opacity; of display colours the light is fitted to that frame, unless all "
    "layers are mixed in display values (space = \"display\"). As a volume: float grid density (extinction "
    "per scene unit), vector grids emission (linear light per scene unit) and Cd (straight colour); each "
    "splat alone hides and shines through the grid what it does on the frame. Isolated layers lie among "
    "the others. Left out: stars, environment, children of level of detail, near fade, the view transform. "
    "Axes and units are the scene's, y up";

}  // namespace

void add_export(CLI::App& app, Invocation& call) {
    auto [command, own] = add_command(app, call, "export", export_help, run_export);
    add_input(command, call.options, "SCENE", "The scene");
    add_output(command, call.options, "FILE.(ply|glb|usda|spz|vdb)", "The file to write");
    add_value(command, "--frame", own.frame, "N", "The frame (default: the scene's first)");
    add_value(command, "--layer", own.layer, "NAME", "Only this layer (default: all that are visible)");
    add_value(command, "--count", own.count, "N", "Merges splats until so many are left");
    add_value(command, "--space", own.space, "display|linear",
              "Of colours (default: display in .ply, .usda and .spz, linear in .glb and .vdb)");
    add_value(command, "--voxel-size", own.voxel_size, "X",
              "Side of the voxels of a .vdb, scene units (default: as the splats are wide, 128 to 512 along "
              "the longest side)");
    add_assignments(command, call.options);
    add_progress(command, call.options);
}

}  // namespace astrosplat
