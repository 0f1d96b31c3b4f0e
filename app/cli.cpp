// The command line, described once for parsing, help, manual page and completion. In: its words. Out: the
// command that they ask for, run.
#include "cli.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cstdio>
#include <string>

#include "batch.h"
#include "batch_plan.h"
#include "cli_parts.h"
#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/text.h"
#include "interrupt.h"
#include "json_log.h"
#include "places.h"
#include "progress_report.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"
#include "window.h"

namespace astrosplat {

/// Of the sources, 12 hexadecimal digits, with "-dirty" where files had changed; "unknown" outside a
/// repository.
extern const char* const built_commit;  // of commit.cmake

namespace {

// Options of the program without a command; those of the commands are in cli_commands.cpp.

void add_batch(CLI::App& app, Invocation& call) {
    BatchOptions& batch = call.batch_options;
    app.add_flag("--batch", call.batch, "Renders the scene's frames without a window");
    app.add_option("SCENE", call.input, "A scene; without --batch also a picture, mesh or splat file");
    add_frame_choice(app, batch);
    app.add_flag("--resume", batch.resume, "Skips frames that are there already, renders missing ones");
    app.add_flag("--overwrite", batch.overwrite, "Replaces files that are there already");
    app.add_flag("--dry-run", batch.dry_run, "Tells frames, time, memory and bytes, and does nothing");
    app.add_flag("--sets-only", batch.sets_only, "Generates the sets into the cache, renders nothing");
    add_value(app, "--stats", batch.stats, "FILE.json", "Writes figures as JSON");
    add_progress(app, batch.progress);
}

void add_submit(CLI::App& app, SubmitOptions& submit) {
    add_value(app, "--submit", submit.system, "slurm",
              "Renders what is missing of the scene's frames on a farm, by --batch with --resume");
    add_value(app, "--chunk", submit.chunk, "N", "With --submit: frames of a task (default: 10)");
    add_value(app, "--partition", submit.partition, "NAME", "With --submit: where the tasks run");
}

void add_screenshot(CLI::App& app, Invocation& call) {
    ScreenshotOptions& shot = call.screenshot;
    add_value(app, "--screenshot", shot.output, "OUT.png|OUT.exr",
              "Saves what the window would show, without one");
    add_value(app, "--size", shot.size, "WxH", "With --screenshot: its size in pixels (default: 960x540)");
    add_value(app, "--frame", shot.frame, "N", "With --screenshot: the frame (default: the first)");
    app.add_flag("--ui", shot.ui, "With --screenshot: the whole window with its panels");
    app.add_flag("--settled", shot.settled, "With --screenshot: the final frame, not the preview");
    app.add_flag("--opengl", shot.opengl, "With --screenshot: a preview drawn by OpenGL on any machine");
}

/// Of window, --batch, --submit and --screenshot.
void add_program_options(CLI::App& app, Invocation& call) {
    add_common(app, call.common);
    add_batch(app, call);
    add_submit(app, call.submit);
    add_screenshot(app, call);
}

// --version

#if defined(__clang__)
constexpr const char* compiler = "Clang " __clang_version__;
#else
constexpr const char* compiler = "GCC " __VERSION__;
#endif

/// "astrosplat VERSION" on the first line; then one fact a line: "commit ...", "built with ..." (compiler,
/// kind of build), "libraries ..." (name and version of each, as they were at the build) and "instructions
/// ..." (the set in use on this machine).
std::string version_text() {
    return fmt::format(
        "astrosplat {}\n"
        "commit {}\n"
        "built with {}, {}\n"
        "libraries {}\n"
        "instructions {}\n",
        ASTROSPLAT_VERSION, built_commit, compiler, ASTROSPLAT_BUILD_KIND, ASTROSPLAT_LIBRARIES,
        vector_target());
}

// --batch --sets-only: generates the sets of the frames into the cache, one after the other, and renders
// nothing. A farm does so once before its tasks begin.

/// Reports on stderr; the exit code. Throws InputError (also where an option beside asks for frames or there
/// is no cache), OutputError (the cache cannot be written), Cancelled.
int run_sets_only(const BatchOptions& options) {
    if (options.cache.folder.empty()) bad_input("--sets-only", "", "a cache that keeps them", "none");
    if (options.dry_run || options.stats)
        bad_input("--sets-only", "",
                  fmt::format("no {} beside it", options.dry_run ? "--dry-run" : "--stats"), "both");
    const BatchPlan plan = plan_frames(options);
    defer_interrupts();
    prove_writable(options.cache.folder);
    ProgressReport report(options.progress);
    for (const LayerParams& layer : plan.scene.layers) {
        if (!ever_visible(plan.scene, layer)) continue;
        const LoadedSet loaded = load_source(plan.cache, source_of(plan.scene, layer), layer.name,
                                             report.begin_step("preparing " + layer.name));
        log_info(fmt::format("layer {}: {}{}", layer.name, human_count(loaded.set.size(), "splat"),
                             loaded.cached ? ", kept already" : ""));
    }
    check_unchanged(plan.hasher.files(), Progress{{}, &interrupted()});
    return exit_done;
}

void apply_common(const CommonOptions& common) {
    if (common.quiet) set_log_level(LogLevel::warning);
    if (common.verbose) set_log_level(LogLevel::detail);
    if (!common.threads.empty()) {
        const std::optional<std::int64_t> threads = parse_int64(common.threads);
        if (!threads || *threads < 1 || *threads > 1024) {
            bad_input("--threads", "", "a number from 1 to 1024", "'" + common.threads + "'");
        }
        set_thread_count(static_cast<int>(*threads));
    }
}

SetCache cache_of(const CommonOptions& common) {
    if (common.no_cache) return {};
    return {common.cache.empty() ? default_cache_folder() : std::filesystem::path(common.cache)};
}

/// Of every command, unless a mode was asked for.
void silence_progress(Invocation& call) {
    for (ProgressMode* mode : {&call.batch_options.progress, &call.generate.progress, &call.convert.progress,
                               &call.export_options.progress, &call.fidelity.progress, &call.prepare.progress,
                               &call.verify.batch.progress})
        if (*mode == ProgressMode::automatic) *mode = ProgressMode::none;
}

int run(Invocation& call) {
    apply_common(call.common);
    log_detail(fmt::format("threads {}, vector target {}", thread_count(), vector_target()));
    for (SetCache* cache : {&call.batch_options.cache, &call.status.batch.cache, &call.verify.batch.cache,
                            &call.generate.cache, &call.export_options.cache, &call.fidelity.cache})
        *cache = cache_of(call.common);
    if (call.common.quiet) silence_progress(call);
    if (call.action) {
        if (call.batch) bad_input("--batch", "", "a scene", "a command as well");
        return call.action();
    }
    const bool submits = !call.submit.system.empty();
    if (!submits && (call.submit.chunk || call.submit.partition))
        bad_input(call.submit.chunk ? "--chunk" : "--partition", "", "--submit slurm beside it", "none");
    if (!call.batch && !submits) return run_window(call);
    const char* mode = submits ? "--submit" : "--batch";
    if (!call.screenshot.output.empty()) bad_input(mode, "", "no --screenshot beside it", "both");
    if (call.input.empty()) bad_input(mode, "", "a scene file", "none (see --help)");
    call.batch_options.scene = call.input;
    if (submits) return run_submit(call.submit, call.batch_options);
    return call.batch_options.sets_only ? run_sets_only(call.batch_options) : run_batch(call.batch_options);
}

/// CLI11's message as one line.
int report_usage_error(const CLI::ParseError& error) {
    std::string line = error.what();
    std::replace(line.begin(), line.end(), '\n', ' ');
    log_error(line + " (see astrosplat --help)");
    return exit_not_started;
}

}  // namespace

int run_command_line(int argc, char** argv) {
    // A mistake in the command line is to be JSON, too.
    if (std::any_of(argv, argv + argc, [](const std::string& text) { return text == "--log-json"; }))
        log_as_json();
    Invocation call;
    CLI::App app("Turns a mesh and a telescope picture into a volume of soft splats and renders film frames.",
                 "astrosplat");
    app.require_subcommand(0, 1);
    add_program_options(app, call);
    add_commands(app, call);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        const auto commands = app.get_subcommands();
        fmt::print("{}", commands.empty() ? app.help() : commands.front()->help());
        return exit_done;
    } catch (const CLI::CallForVersion&) {
        fmt::print("{}", version_text());
        return exit_done;
    } catch (const CLI::ParseError& error) {
        return report_usage_error(error);
    }
    return run(call);
}

}  // namespace astrosplat
