#include "cli.h"

#include "core/error.h"

namespace astrosplat {

void add_input(CLI::App& app, CommandOptions& options, const std::string& name, const std::string& help) {
    add_value(app, name, options.input, name, help)->required();
}

CLI::Option* add_output(CLI::App& app, CommandOptions& options, const std::string& placeholder,
                        const std::string& help) {
    CLI::Option* const output = add_value(app, "-o,--output", options.output, placeholder, help)->required();
    app.add_flag("--overwrite", options.overwrite, "Replaces what is there already");
    return output;
}

void add_assignments(CLI::App& app, CommandOptions& options) {
    app.add_option_function<std::vector<std::string>>(
           "--set", [&options](const std::vector<std::string>& texts) { options.assignments = texts; },
           "Sets a key of the scene; may be repeated")
        ->option_text("KEY=VALUE")
        ->expected(1)
        ->allow_extra_args(false)  // what follows is the scene
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_progress(CLI::App& app, CommandOptions& options) {
    app.add_option_function<std::string>(
           "--progress",
           [&options](const std::string& text) {
               if (text != "auto" && text != "plain" && text != "none")
                   bad_input("--progress", "", "auto, plain or none", "'" + text + "'");
               options.progress = text == "auto"    ? ProgressMode::automatic
                                  : text == "plain" ? ProgressMode::plain
                                                    : ProgressMode::none;
           },
           "How to report progress on stderr")
        ->option_text("auto|plain|none");
}

void add_json(CLI::App& app, CommandOptions& options) { app.add_flag("--json", options.json, "Prints JSON"); }

void add_common(CLI::App& app, Invocation& call) {
    app.set_help_flag("-h,--help", "Prints this help");
    app.set_version_flag("--version", "astrosplat " ASTROSPLAT_VERSION,
                         "Prints version, commit and libraries");
    add_value(app, "-t,--threads", call.threads, "N", "Threads (default: the cores this process may use)");
    add_value(
        app, "--cache", call.cache, "DIR",
        "Folder that keeps generated sets and prepared pictures (default: $ASTROSPLAT_CACHE, "
        "$XDG_CACHE_HOME/astrosplat or ~/.cache/astrosplat); at most 20 GiB or a tenth of the disk, the "
        "least recently used go");
    app.add_flag("--no-cache", call.no_cache, "Neither reads nor writes generated sets");
    app.add_flag("-v,--verbose", call.verbose, "Says more");
    app.add_flag("-q,--quiet", call.quiet, "Says only warnings and errors");
    const std::string log_json = "Messages and progress on stderr as JSON, one object a line";
    app.add_flag("--log-json", log_json);  // was seen to before all else
}

void add_frame_choice(CLI::App& app, CommandOptions& options) {
    add_value(app, "-f,--frames", options.frames, "1-100,120,200-300x2", "Frames instead of output.frames");
    add_value(app, "-o,--output", options.output, "PATTERN", "Frame files, such as frames/shot.####.exr");
    add_value(app, "--resolution", options.resolution, "1920x1080|50%", "Size of the frame");
    add_assignments(app, options);
    add_value(app, "--layers", options.layers, "A,B", "Only these layers");
    add_value(app, "--memory", options.memory_gib, "GiB",
              "Limit of all that the program takes: larger .splats files are read block by block, and "
              "pictures that bodies are made of are reduced");
    add_value(app, "--region", options.region, "X,Y,W,H", "Part of the frame, from the top left, in pixels");
}

CLI::App& add_command(CLI::App& app, Invocation& call, const char* name, const char* help,
                      std::function<int(const CommandOptions&)> run) {
    CLI::App& command = *app.add_subcommand(name, help);
    add_common(command, call);
    command.callback([&call, run = std::move(run)] { call.command = run; });
    return command;
}

}  // namespace astrosplat
