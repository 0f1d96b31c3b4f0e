#include "cli.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>

#include "batch.h"
#include "camera_command.h"
#include "command_words.h"
#include "compare.h"
#include "completion.h"
#include "core/assets.h"
#include "core/error.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/text.h"
#include "core/vector_target.h"
#include "export_command.h"
#include "fidelity.h"
#include "info.h"
#include "interrupt.h"
#include "json_log.h"
#include "manual.h"
#include "new.h"
#include "parameters.h"
#include "places.h"
#include "prepare.h"
#include "prepare_settings.h"
#include "scene/describe.h"
#include "sets_only.h"
#include "splat_commands.h"
#include "status_command.h"
#include "submit/submit.h"
#include "verify.h"
#include "viewer/run_viewer.h"
#include "viewer/screenshot.h"

namespace astrosplat {
namespace {

constexpr const char* version_line = "astrosplat " ASTROSPLAT_VERSION;

/// Options that every command takes.
struct CommonOptions {
    std::string threads, cache;
    bool no_cache = false, verbose = false, quiet = false;
    bool log_json = false;  // was seen to before all else
};

struct Invocation {
    CommonOptions common;
    bool batch = false;
    std::string input;  // what the viewer opens
    BatchOptions batch_options;
    SubmitOptions submit;  // when its system is given; beside batch_options
    StatusOptions status;
    ScreenshotOptions screenshot;  // when its output is given
    NewOptions create;
    PrepareOptions prepare;
    GenerateOptions generate;
    ConvertOptions convert;
    ExportOptions export_options;
    CameraOptions camera;
    InfoOptions info;
    CompareOptions compare;
    FidelityOptions fidelity;
    VerifyOptions verify;
    ParametersOptions parameters;
    std::string manual, shell;    // which page, whose completion
    std::function<int()> action;  // of the subcommand, when there is one
};

/// `value` is text or a path, maybe optional.
template <class Value>
CLI::Option* add_value(CLI::App& app, const std::string& names, Value& value, const std::string& placeholder,
                       const std::string& help) {
    const auto set = [&value](const std::string& text) { value = text; };
    return app.add_option_function<std::string>(names, set, help)->option_text(placeholder);
}

void add_assignments(CLI::App& app, std::vector<std::string>& values) {
    app.add_option_function<std::vector<std::string>>(
           "--set", [&values](const std::vector<std::string>& texts) { values = texts; },
           "Sets a key of the scene; may be repeated")
        ->option_text("KEY=VALUE")
        ->expected(1)
        ->allow_extra_args(false)  // what follows is the scene
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_progress(CLI::App& app, ProgressMode& mode) {
    app.add_option_function<std::string>(
           "--progress",
           [&mode](const std::string& text) {
               if (text != "auto" && text != "plain" && text != "none") {
                   bad_input("--progress", "", "auto, plain or none", "'" + text + "'");
               }
               mode = text == "auto"    ? ProgressMode::automatic
                      : text == "plain" ? ProgressMode::plain
                                        : ProgressMode::none;
           },
           "How to report progress on stderr")
        ->option_text("auto|plain|none");
}

void add_common(CLI::App& app, CommonOptions& common) {
    app.set_help_flag("-h,--help", "Prints this help");
    app.set_version_flag("--version", version_line, "Prints the version");
    add_value(app, "-t,--threads", common.threads, "N", "Threads (default: the cores this process may use)");
    add_value(app, "--cache", common.cache, "DIR",
              "Folder that keeps generated sets and prepared pictures (default: $ASTROSPLAT_CACHE, "
              "$XDG_CACHE_HOME/astrosplat or "
              "~/.cache/astrosplat); at most 20 GiB or a tenth of the disk, the least recently used go");
    app.add_flag("--no-cache", common.no_cache, "Neither reads nor writes generated sets");
    app.add_flag("-v,--verbose", common.verbose, "Says more");
    app.add_flag("-q,--quiet", common.quiet, "Says only warnings and errors");
    app.add_flag("--log-json", common.log_json, "Messages and progress on stderr as JSON, one object a line");
}

/// What decides which frames there are, and what they hold.
void add_frame_choice(CLI::App& app, BatchOptions& batch) {
    add_value(app, "-f,--frames", batch.frames, "1-100,120,200-300x2", "Frames instead of output.frames");
    add_value(app, "-o,--output", batch.output, "PATTERN", "Frame files, such as frames/shot.####.exr");
    add_value(app, "--resolution", batch.resolution, "1920x1080|50%", "Size of the frame");
    add_assignments(app, batch.assignments);
    add_value(app, "--layers", batch.layers, "A,B", "Only these layers");
    add_value(
        app, "--memory", batch.memory_gib, "GiB",
        "Limit of the renderer's working memory, and of what bodies are made in: pictures that would take "
        "more are reduced");
    add_value(app, "--region", batch.region, "X,Y,W,H", "Part of the frame, from the top left, in pixels");
}

void add_batch(CLI::App& app, Invocation& call) {
    BatchOptions& batch = call.batch_options;
    app.add_flag("--batch", call.batch, "Renders the scene's frames without a window");
    app.add_option("SCENE", call.input, "A scene; without --batch also a picture, mesh or splat file");
    add_frame_choice(app, batch);
    app.add_flag("--resume", batch.resume, "Skips frames that are there already, renders missing ones");
    app.add_flag("--overwrite", batch.overwrite, "Replaces files that are there already");
    app.add_flag("--dry-run", batch.dry_run, "Says what would be done, and does nothing");
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

/// A subcommand whose run is remembered, not done while parsing.
CLI::App& add_command(CLI::App& app, Invocation& call, const char* name, const char* help,
                      std::function<int()> action) {
    CLI::App& command = *app.add_subcommand(name, help);
    add_common(command, call.common);
    command.callback([&call, action = std::move(action)] { call.action = action; });
    return command;
}

void add_new(CLI::App& app, Invocation& call) {
    CLI::App& command = add_command(app, call, "new", "Writes a scene for a picture",
                                    [&call] { return run_new(call.create); });
    add_value(command, "IMAGE", call.create.image, "IMAGE", "The picture")->required();
    add_value(command, "-o,--output", call.create.scene, "SCENE", "The scene file to write")->required();
    add_value(command, "--as", call.create.as, "galaxy|nebula|remnant|plane",
              "What the picture shows (default: by looking at it)");
    command.add_flag("--film", call.create.film, "With a camera move of ten seconds");
    add_value(command, "--shape", call.create.shape, "plane|relief|disk|sphere",
              "Columns on this mesh instead of bodies");
    command.add_flag("--overwrite", call.create.overwrite, "Replaces the scene file");
}

void add_three_filters(CLI::App& command, PrepareOptions& prepare) {
    add_value(command, "--r", prepare.red, "FILE",
              "With --g and --b in place of IN: three filters, brought onto the grid of the first where FITS "
              "headers tell the sky, and shown with one asinh for all (Lupton)");
    add_value(command, "--g", prepare.green, "FILE", "The filter shown as green");
    add_value(command, "--b", prepare.blue, "FILE", "The filter shown as blue");
}

void add_prepare(CLI::App& app, Invocation& call) {
    PrepareOptions& prepare = call.prepare;
    CLI::App& command = add_command(app, call, "prepare", "Makes a picture ready for a scene",
                                    [&call] { return run_prepare(call.prepare); });
    add_value(command, "IN", prepare.image, "IN", "The picture, also in FITS");
    add_value(command, "-o,--output", prepare.folder, "FOLDER",
              "Gets picture.exr in linear light, stars.csv, background.json, front.exr and back.exr")
        ->required();
    add_three_filters(command, prepare);
    for (const PrepareOption& option : prepare_options()) {
        const auto set = [&prepare, key = option.key](const std::string& text) {
            prepare.settings[key] = text;
        };
        command.add_option_function<std::string>(option.option, set, option.help)
            ->option_text(option.placeholder);
    }
    add_value(
        command, "--split", prepare.split, "FILE",
        "Writes front.exr, what is not black in that picture, and back.exr, the rest with that part filled");
    command.add_flag("--overwrite", prepare.overwrite, "Replaces the files in the folder");
    add_progress(command, prepare.progress);
}

void add_generate(CLI::App& app, Invocation& call) {
    CLI::App& command = add_command(app, call, "generate", "Generates a layer's splats into a file",
                                    [&call] { return run_generate(call.generate); });
    add_value(command, "SCENE", call.generate.scene, "SCENE", "The scene")->required();
    add_value(command, "--layer", call.generate.layer, "NAME", "Name of the layer")->required();
    add_value(command, "-o,--output", call.generate.output, "FILE.(pda|ply|splats)",
              "The splat file to write")
        ->required();
    add_assignments(command, call.generate.assignments);
    add_value(command, "--memory", call.generate.memory_gib, "GiB",
              "Limit of what bodies are made in: pictures that would take more are reduced");
    command.add_flag("--overwrite", call.generate.overwrite, "Replaces the file");
    add_progress(command, call.generate.progress);
}

void add_convert(CLI::App& app, Invocation& call) {
    CLI::App& command = add_command(app, call, "convert", "Converts between splat files",
                                    [&call] { return run_convert(call.convert); });
    add_value(command, "IN", call.convert.input, "IN", "A .pda, .ply or .splats file")->required();
    add_value(command, "OUT", call.convert.output, "OUT", "A .pda, .ply or .splats file")->required();
    command.add_flag("--overwrite", call.convert.overwrite, "Replaces the file");
    add_progress(command, call.convert.progress);
}

void add_camera(CLI::App& app, Invocation& call) {
    CLI::App& command = add_command(app, call, "camera", "Writes the scene's camera for other programs",
                                    [&call] { return run_camera(call.camera); });
    add_value(command, "SCENE", call.camera.scene, "SCENE", "The scene")->required();
    add_value(command, "-o,--output", call.camera.output, "FILE.(chan|csv|gltf|usda)",
              "The camera file to write")
        ->required();
    add_value(command, "-f,--frames", call.camera.frames, "1-100,120,200-300x2", "Instead of output.frames");
    add_assignments(command, call.camera.assignments);
    command.add_flag("--overwrite", call.camera.overwrite, "Replaces the file");
}

void add_status(CLI::App& app, Invocation& call) {
    CLI::App& command =
        add_command(app, call, "status", "Lists which frames are done, missing, damaged or of other settings",
                    [&call] { return run_status(call.status); });
    add_value(command, "SCENE", call.status.batch.scene, "SCENE", "The scene")->required();
    add_frame_choice(command, call.status.batch);
    command.add_flag("--json", call.status.json, "Prints JSON");
}

void add_export(CLI::App& app, Invocation& call) {
    ExportOptions& options = call.export_options;
    CLI::App& command =
        add_command(app, call, "export", export_help, [&call] { return run_export(call.export_options); });
    add_value(command, "SCENE", options.scene, "SCENE", "The scene")->required();
    add_value(command, "-o,--output", options.output, "FILE.(ply|glb)", "The file to write")->required();
    add_value(command, "--frame", options.frame, "N", "The frame (default: the scene's first)");
    add_value(command, "--layer", options.layer, "NAME", "Only this layer (default: all that are visible)");
    add_value(command, "--count", options.count, "N", "Merges splats until so many are left");
    add_value(command, "--space", options.space, "display|linear",
              "Of colours (default: display in .ply, linear in .glb)");
    add_assignments(command, options.assignments);
    command.add_flag("--overwrite", options.overwrite, "Replaces the file");
    add_progress(command, options.progress);
}

void add_reports(CLI::App& app, Invocation& call) {
    CLI::App& info = add_command(app, call, "info", "Describes any file the program reads",
                                 [&call] { return run_info(call.info); });
    add_value(info, "FILE", call.info.file, "FILE", "Scene, mesh, picture, frame or splat file")->required();
    info.add_flag("--json", call.info.json, "Prints JSON");

    CLI::App& compare = add_command(app, call, "compare", "Compares the linear light of two images",
                                    [&call] { return run_compare(call.compare); });
    add_value(compare, "A", call.compare.a, "A", "An image")->required();
    add_value(compare, "B", call.compare.b, "B", "An image of the same size")->required();
    compare.add_flag("--json", call.compare.json, "Prints JSON");
    add_value(compare, "--max-difference", call.compare.max_difference, "X",
              "Largest difference allowed in any channel; beyond it the exit code is 3");

    CLI::App& parameters = add_command(app, call, "parameters", "Lists every key of a scene file",
                                       [&call] { return run_parameters(call.parameters); });
    parameters.add_flag("--json", call.parameters.json, "Prints JSON");
}

void add_fidelity(CLI::App& app, Invocation& call) {
    FidelityOptions& fidelity = call.fidelity;
    CLI::App& command = add_command(app, call, "fidelity", "Measures how true a scene is to its picture",
                                    [&call] { return run_fidelity(call.fidelity); });
    add_value(command, "SCENE", fidelity.scene, "SCENE", "The scene")->required();
    add_value(command, "-o,--output", fidelity.output, "REPORT.(html|json)", "The report to write")
        ->required();
    add_value(command, "--reference", fidelity.reference, "IMAGE",
              "A picture to compare with, in place of the layer's own");
    add_assignments(command, fidelity.assignments);
    command.add_flag("--overwrite", fidelity.overwrite, "Replaces the report");
    add_progress(command, fidelity.progress);
}

void add_verify(CLI::App& app, Invocation& call) {
    VerifyOptions& verify = call.verify;
    CLI::App& command =
        add_command(app, call, "verify", "Renders frames again and says whether files hold them",
                    [&call] { return run_verify(call.verify); });
    add_value(command, "SCENE", verify.batch.scene, "SCENE", "The scene")->required();
    command
        .add_option_function<std::vector<std::string>>(
            "FRAME",
            [&verify](const std::vector<std::string>& files) {
                verify.files.assign(files.begin(), files.end());
            },
            "Frame files; each says itself which frame, size, region and eye it holds")
        ->option_text("FRAME...")
        ->required();
    add_assignments(command, verify.batch.assignments);
    add_value(command, "--layers", verify.batch.layers, "A,B", "Where --batch had it too");
    add_value(command, "--memory", verify.batch.memory_gib, "GiB", "Where --batch had it too");
    command.add_flag("--json", verify.json, "Prints JSON");
    add_progress(command, verify.batch.progress);
}

/// Keys that --set takes as they stand: those of layers need a layer's name.
std::vector<std::string> keys_to_set() {
    std::vector<std::string> keys;
    for (const ParameterRow& row : parameter_rows())
        if (!row.spec.key.is_below("layer")) keys.push_back(row.spec.key.text());
    return keys;
}

/// What the words of the whole command line are written into.
void add_words(CLI::App& app, Invocation& call) {
    CLI::App& manual = add_command(
        app, call, "manual", "Prints a manual page: 1 of the program, 5 of scene files", [&app, &call] {
            if (call.manual != "1" && call.manual != "5")
                bad_input("manual", "", "1 or 5", "'" + call.manual + "'");
            fmt::print("{}", call.manual == "1" ? command_manual(command_words(app)) : scene_manual());
            return exit_done;
        });
    add_value(manual, "SECTION", call.manual, "SECTION", "1: the program, 5: scene files")->required();
    CLI::App& completion = add_command(
        app, call, "completion", "Prints a script with which a shell completes commands", [&app, &call] {
            fmt::print("{}", completion_script(call.shell, command_words(app), keys_to_set()));
            return exit_done;
        });
    add_value(completion, "SHELL", call.shell, "bash|zsh|fish", "The shell")->required();
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

void refuse_without_screenshot(const ScreenshotOptions& shot) {
    const char* option = shot.size      ? "--size"
                         : shot.frame   ? "--frame"
                         : shot.ui      ? "--ui"
                         : shot.settled ? "--settled"
                         : shot.opengl  ? "--opengl"
                                        : nullptr;
    if (option) bad_input(option, "", "--screenshot OUT.png beside it", "none");
}

/// The window, or a screenshot of it.
int run_window(Invocation& call) {
    if (!call.input.empty()) call.input = find_by_name("scenes", call.input).string();
    ViewerOptions viewer{call.input, {}, call.batch_options.cache, !call.common.threads.empty()};
    for (const std::string& text : call.batch_options.assignments)
        viewer.assignments.push_back(parse_assignment(text));
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
    add_common(app, call.common);
    add_batch(app, call);
    add_submit(app, call.submit);
    add_screenshot(app, call);
    add_new(app, call);
    add_prepare(app, call);
    add_generate(app, call);
    add_convert(app, call);
    add_export(app, call);
    add_camera(app, call);
    add_status(app, call);
    add_reports(app, call);
    add_fidelity(app, call);
    add_verify(app, call);
    add_words(app, call);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        const auto commands = app.get_subcommands();
        fmt::print("{}", commands.empty() ? app.help() : commands.front()->help());
        return exit_done;
    } catch (const CLI::CallForVersion&) {
        fmt::print("{}\n", version_line);
        return exit_done;
    } catch (const CLI::ParseError& error) {
        return report_usage_error(error);
    }
    return run(call);
}

}  // namespace astrosplat
