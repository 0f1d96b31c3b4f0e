// generate and convert: splats into files, without rendering.
#include "commands.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/file.h"
#include "core/file_format.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/text.h"
#include "estimate.h"
#include "interrupt.h"
#include "places.h"
#include "progress_report.h"
#include "scene/layer_setup.h"
#include "scene/load.h"
#include "scene/parameter_key.h"
#include "sets/load_source.h"
#include "splat_files/splat_file.h"

namespace astrosplat {
namespace {

const LayerParams& layer_named(const Scene& scene, const std::string& name) {
    std::vector<std::string> names;
    for (const LayerParams& layer : scene.layers) {
        if (layer.name == name) return layer;
        names.push_back(layer.name);
    }
    bad_input(scene.file.string(), "",
              fmt::format("--layer to name one of its layers ({})", fmt::join(names, ", ")),
              "'" + name + "'" + did_you_mean(name, names));
}

void check_splat_output(const std::filesystem::path& file, bool overwrite) {
    const FileFormat* format = format_by_name(file);
    if (kind_of(format) != FileKind::splats || !includes(format->uses, FileUse::written))
        bad_input(file.string(), "",
                  fmt::format("a name ending in {}",
                              fmt::join(endings_of({FileKind::splats}, FileUse::written), " or ")),
                  "'" + file.extension().string() + "'");
    refuse_to_overwrite(file, overwrite);
    defer_interrupts();
    prove_writable(folder_of(file));
}

void report_file(const std::filesystem::path& file, std::int64_t splats) {
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

}  // namespace

int run_generate(const GenerateOptions& options) {
    std::vector<Assignment> assignments;
    for (const std::string& text : options.assignments) assignments.push_back(parse_assignment(text));
    const Scene scene = load_scene(options.scene, assignments);
    LayerParams layer = layer_named(scene, options.layer);
    const std::int64_t most_bytes = options.memory_gib ? parse_memory(*options.memory_gib) : 0;
    check_splat_output(options.output, options.overwrite);
    ProgressReport report(options.progress);
    if (most_bytes > 0) limit_bodies(layer, most_bytes, options.cache);
    const SourceParams source = source_of(scene, layer);
    const WriteTarget target{options.output, existing_of(options.overwrite)};
    const bool columns = makes_columns(source);
    if (columns && most_bytes > 0) limit_memory(most_bytes);
    try {
        const SplatSet set =
            load_source(options.cache, source, layer.name, report.begin_step("generating " + layer.name)).set;
        write_and_report(target, set, report);
    } catch (const NotEnoughMemory&) {
        if (!columns || format_by_name(options.output)->id != "splats") throw;
        write_in_parts(target, source, layer.name, report);
    }
    return exit_done;
}

int run_convert(const ConvertOptions& options) {
    require_readable(options.input);
    check_splat_output(options.output, options.overwrite);
    ProgressReport report(options.progress);
    const SplatSet set = read_splats(options.input, report.begin_step("reading"));
    write_and_report({options.output, existing_of(options.overwrite)}, set, report);
    return exit_done;
}

}  // namespace astrosplat
