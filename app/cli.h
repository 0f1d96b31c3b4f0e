// The command line's description, by CLI11: parts that commands share, and the commands. A command stands in
// a file of its own: its options with their help, and what it does. In: CLI11's command. Out: the same with
// one option more, whose value is written where it belongs.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "viewer/viewer.h"

namespace astrosplat {

/// --submit, beside the options of --batch.
struct SubmitOptions {
    std::string system;                    // "slurm"; empty: not asked for
    std::optional<std::string> chunk;      // frames of a task; default 10
    std::optional<std::string> partition;  // of the cluster; default: its own
};

/// A command line that was read, before anything is done.
struct Invocation {
    std::string threads, cache;  // as typed
    bool no_cache = false, verbose = false, quiet = false;
    bool batch = false;
    CommandOptions options;
    SubmitOptions submit;
    ScreenshotOptions screenshot;                       // when its output is given
    std::function<int(const CommandOptions&)> command;  // when there is one
};

/// `value` is text or a path, maybe optional.
template <class Value>
CLI::Option* add_value(CLI::App& app, const std::string& names, Value& value, const std::string& placeholder,
                       const std::string& help) {
    const auto set = [&value](const std::string& text) { value = text; };
    return app.add_option_function<std::string>(names, set, help)->option_text(placeholder);
}

/// What the command is about, which has to be given.
void add_input(CLI::App& app, CommandOptions& options, const std::string& name, const std::string& help);
/// -o, which has to be given, and --overwrite; returns the former.
CLI::Option* add_output(CLI::App& app, CommandOptions& options, const std::string& placeholder,
                        const std::string& help);
void add_assignments(CLI::App& app, CommandOptions& options);  // --set
void add_progress(CLI::App& app, CommandOptions& options);
void add_json(CLI::App& app, CommandOptions& options);
/// Options that every command takes.
void add_common(CLI::App& app, Invocation& call);
/// The options that choose frames and their content.
void add_frame_choice(CLI::App& app, CommandOptions& options);

/// A subcommand whose run is remembered, not done while parsing.
CLI::App& add_command(CLI::App& app, Invocation& call, const char* name, const char* help,
                      std::function<int(const CommandOptions&)> run);

/// The same with options of its own.
template <class Own>
std::pair<CLI::App&, Own&> add_command(CLI::App& app, Invocation& call, const char* name, const char* help,
                                       int (*run)(const CommandOptions&, const Own&)) {
    const auto own = std::make_shared<Own>();
    const auto run_with = [own, run](const CommandOptions& options) { return run(options, *own); };
    return {add_command(app, call, name, help, run_with), *own};
}

// The commands, in the order of the help. Each returns an exit code (exit.h), prints results on stdout, and
// throws InputError, OutputError and Cancelled.

void add_new(CLI::App& app, Invocation& call);         // a first scene around a picture
void add_prepare(CLI::App& app, Invocation& call);     // a picture made ready for a scene
void add_generate(CLI::App& app, Invocation& call);    // splats into files, without rendering
void add_convert(CLI::App& app, Invocation& call);     // likewise
void add_export(CLI::App& app, Invocation& call);      // splats with their look, for other programs
void add_camera(CLI::App& app, Invocation& call);      // the scene's camera, for other programs
void add_status(CLI::App& app, Invocation& call);      // frames that are there, missing or damaged
void add_info(CLI::App& app, Invocation& call);        // the content of any file that is read
void add_compare(CLI::App& app, Invocation& call);     // the difference of two images
void add_parameters(CLI::App& app, Invocation& call);  // every key of scene files, or those of one scene
void add_fidelity(CLI::App& app, Invocation& call);    // the likeness of a scene to its picture
void add_verify(CLI::App& app, Invocation& call);      // frames rendered again, compared with their files
void add_manual(CLI::App& app, Invocation& call);
void add_completion(CLI::App& app, Invocation& call);

// The program without a command.

int run_batch(const CommandOptions& options);

/// Submits nothing where nothing is missing, or what is missing is on its way already. Afterwards either both
/// jobs are in the queue or neither. Throws InputError (bad options, sbatch missing or refusing), OutputError
/// (no place for scripts beside the frames), Cancelled.
int run_submit(const SubmitOptions& options, const CommandOptions& batch);

/// The window, or a screenshot of it. A build without the window says so.
int run_window(Invocation& call);

}  // namespace astrosplat
