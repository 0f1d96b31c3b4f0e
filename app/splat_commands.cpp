// generate, convert and camera: splats and cameras into files, without rendering.
#include <fmt/format.h>

#include <algorithm>

#include "cli.h"
#include "core/error.h"
#include "core/file.h"
#include "core/file_format.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/text.h"
#include "estimate.h"
#include "exit.h"
#include "progress_report.h"
#include "scene/camera_file.h"
#include "scene/frames.h"
#include "scene/layer_setup.h"
#include "scene/load.h"
#include "sets/load_source.h"
#include "splat_files/splat_file.h"

namespace astrosplat {
namespace fs = std::filesystem;
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

}  // namespace astrosplat
