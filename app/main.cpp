// The command line, described once for parsing, help, manual page and completion, and what it asks for, run.
// Exceptions become one line and an exit code here.
#include <fmt/format.h>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

#include "batch_plan.h"
#include "command.h"
#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/text.h"
#include "exit.h"
#include "farm/child_process.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"

namespace astrosplat {

/// Of the sources, 12 hexadecimal digits, with "-dirty" where files had changed;
/// "unknown" outside a repository.
extern const char* const built_commit;  // of commit.cmake

namespace {

// Options of the program without a command.

void add_batch(CLI::App& app, Invocation& call) {
    CommandOptions& batch = call.options;
    app.add_flag("--batch", call.batch, "Renders the scene's frames without a window");
    app.add_option_function<std::string>(
        "SCENE", [&batch](const std::string& text) { batch.input = text; },
        "A scene; without --batch also a picture, mesh or splat file");
    add_frame_choice(app, batch);
    app.add_flag("--resume", batch.resume, "Skips frames that are there already, renders missing ones");
    app.add_flag("--overwrite", batch.overwrite, "Replaces files that are there already");
    app.add_flag("--dry-run", batch.dry_run, "Tells frames, time, memory and bytes, and does nothing");
    app.add_flag("--sets-only", batch.sets_only, "Generates the sets into the cache, renders nothing");
    add_value(app, "--stats", batch.stats, "FILE.json", "Writes figures as JSON");
    add_value(app, "--ffmetadata", batch.ffmetadata, "FILE",
              "Writes title, credit and settings of the frames, for a movie of them by ffmpeg (-i FILE "
              "-map_metadata 1)");
    add_value(
        app, "--movie", batch.movie, "FILE",
        "With --resume: renders nothing where this movie says (by --ffmetadata) that it was made of these "
        "very frames");
    add_device_option(app, batch);
    add_progress(app, batch);
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
}

// The text of --version.

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

/// Reports on stderr; the exit code. Throws InputError (also where another option asks for frames or there
/// is no cache), OutputError (the cache cannot be written), Cancelled.
int run_sets_only(const CommandOptions& options) {
    if (options.cache.folder.empty()) bad_input("--sets-only", "", "a cache that keeps them", "none");
    for (const auto& [given, option] : {std::pair(options.dry_run, "--dry-run"),
                                        {options.stats.has_value(), "--stats"},
                                        {options.ffmetadata.has_value(), "--ffmetadata"},
                                        {options.movie.has_value(), "--movie"}})
        if (given) bad_input("--sets-only", "", fmt::format("no {} with it", option), "both");
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
    check_unchanged(plan.hasher.files(), stoppable());
    return exit_done;
}

#ifdef ASTROSPLAT_WINDOW

void refuse_without_screenshot(const ScreenshotOptions& shot) {
    const char* option = shot.size      ? "--size"
                         : shot.frame   ? "--frame"
                         : shot.ui      ? "--ui"
                         : shot.settled ? "--settled"
                                        : nullptr;
    if (option) bad_input(option, "", "--screenshot OUT.png with it", "none");
}

/// The window, or a screenshot of it.
int run_window(Invocation& call) {
    CommandOptions& options = call.options;
    if (!options.input.empty()) options.input = find_by_name("scenes", options.input);
    const ViewerOptions viewer{options.input,
                               assignments_of(options),
                               options.cache,
                               options.device,
                               own_program(),
                               !call.threads.empty(),
                               !call.cache.empty() || call.no_cache};
    ScreenshotOptions& shot = call.screenshot;
    if (shot.output.empty()) {
        refuse_without_screenshot(shot);
        defer_interrupts();
        return run_viewer(viewer, interrupted());
    }
    prove_writable(folder_of(shot.output));
    shot.scene = viewer;
    return run_screenshot(shot);
}

#else

int run_window(Invocation&) {
    throw InputError(
        "this astrosplat was built without its window; --batch SCENE renders, --help names what else it "
        "does");
}

#endif

void apply_common(const Invocation& call) {
    if (call.quiet) set_log_level(LogLevel::warning);
    if (call.verbose) set_log_level(LogLevel::detail);
    if (!call.threads.empty())
        set_thread_count(
            static_cast<int>(option_count("--threads", call.threads, "a number from 1 to 1024", 1, 1024)));
}

SetCache cache_of(const Invocation& call) {
    if (call.no_cache) return {};
    return {call.cache.empty() ? default_cache_folder() : fs::path(call.cache)};
}

int run(Invocation& call) {
    apply_common(call);
    log_detail(fmt::format("threads {}, vector target {}", thread_count(), vector_target()));
    CommandOptions& options = call.options;
    options.cache = cache_of(call);
    if (call.quiet && options.progress == ProgressMode::automatic) options.progress = ProgressMode::none;
    if (call.command) {
        if (call.batch) bad_input("--batch", "", "a scene", "a command as well");
        return call.command(options);
    }
    const bool submits = !call.submit.system.empty();
    if (!submits && (call.submit.chunk || call.submit.partition))
        bad_input(call.submit.chunk ? "--chunk" : "--partition", "", "--submit slurm with it", "none");
    if (!call.batch && !submits) return run_window(call);
    const char* mode = submits ? "--submit" : "--batch";
    if (!call.screenshot.output.empty()) bad_input(mode, "", "no --screenshot with it", "both");
    if (options.input.empty()) bad_input(mode, "", "a scene file", "none (see --help)");
    if (submits) return run_submit(call.submit, options);
    return options.sets_only ? run_sets_only(options) : run_batch(options);
}

/// CLI11's message as one line.
int report_usage_error(const CLI::ParseError& error) {
    std::string line = error.what();
    std::replace(line.begin(), line.end(), '\n', ' ');
    log_error(line + " (see astrosplat --help)");
    return exit_not_started;
}

void add_everything(CLI::App& app, Invocation& call) {
    app.require_subcommand(0, 1);
    add_common(app, call);
    add_batch(app, call);
    add_submit(app, call.submit);
    add_screenshot(app, call);
    for (const auto add : {add_new, add_detail_command, add_prepare, add_generate, add_convert, add_export,
                           add_camera, add_status, add_info, add_compare, add_parameters, add_fidelity,
                           add_verify, add_device, add_manual, add_completion})
        add(app, call);
}

/// Parses argv and runs what it asks for; returns the exit code. A usage mistake is one line on stderr.
/// Throws what the commands throw.
int run_command_line(int argc, char** argv) {
    // A mistake in the command line is to be JSON, too.
    if (std::any_of(argv, argv + argc, [](const std::string& text) { return text == "--log-json"; }))
        log_as_json();
    Invocation call;
    CLI::App app("Turns a mesh and a telescope picture into a volume of soft splats and renders film frames.",
                 "astrosplat");
    add_everything(app, call);
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

}  // namespace
}  // namespace astrosplat

using namespace astrosplat;

int main(int argc, char** argv) {
    install_interrupt_handlers();
    try {
        use_vector_target_of_environment();
        return run_command_line(argc, argv);
    } catch (const InputError& error) {
        log_error(error.what());
        return exit_not_started;
    } catch (const OutputError& error) {
        log_error(error.what());
        return exit_not_writable;
    } catch (const Cancelled&) {
        log_error(stopped_message);
        return interrupt_exit_code();
    } catch (const std::bad_alloc&) {
        log_error("not enough memory");
        return exit_not_started;
    } catch (const std::system_error& error) {
        std::error_code gone;
        static_cast<void>(std::filesystem::current_path(gone));
        if (gone) {
            log_error("the working folder is not there any more: change to one that is");
            return exit_not_started;
        }
        const bool busy = error.code() == std::errc::resource_unavailable_try_again;  // no thread to be had
        log_error((busy ? "the system gives no more threads: " : "internal error: ") +
                  std::string(error.what()));
        return busy ? exit_not_started : exit_own_fault;
    } catch (const std::exception& error) {
        log_error(std::string("internal error: ") + error.what());
        return exit_own_fault;
    }
}
