// Shared by the commands of the command line: options as typed, their values, the places of results, reports
// on stdout; and their description by CLI11, which also becomes words for the manual page and the shells'
// completion. A command stands in a file of its own: its options with their help, and what it does.
#pragma once

#include <CLI/App.hpp>
#include <nlohmann/json_fwd.hpp>

#include "core/atomic_file.h"
#include "progress_report.h"
#include "render/device.h"
#include "scene/detail_tiles.h"
#include "scene/load.h"
#include "scene/scene.h"
#include "sets/kept.h"
#include "viewer/viewer.h"

namespace astrosplat {

/// Options as typed that several commands take; each command looks at those that it has, --batch at all
/// but `json`.
struct CommandOptions {
    fs::path input;                         // a scene, or whatever the command is about
    std::optional<fs::path> output;         // a file or a folder; of frames a pattern, relative to the
                                            // working directory, which replaces output.path
    std::vector<std::string> assignments;   // --set KEY=VALUE
    std::optional<std::string> frames;      // replaces output.frames
    std::optional<std::string> resolution;  // "1920x1080" or "50%"
    std::optional<std::string> layers;      // "A,B": only these
    std::optional<std::string> region;      // "X,Y,W,H" from the top left, px
    std::optional<std::string> memory_gib;  // limit of all that is taken
    std::optional<fs::path> stats;
    std::optional<fs::path> ffmetadata;  // what a movie of the frames is to say
    std::optional<fs::path> movie;       // that was made so: with `resume` it may stay
    SetCache cache;
    ProgressMode progress = ProgressMode::automatic;
    DeviceChoice device = DeviceChoice::automatic;
    bool resume = false, overwrite = false, dry_run = false, json = false;
    bool sets_only = false;  // generates and keeps the sets, and renders nothing
};

/// Of --set. Throws InputError.
std::vector<Assignment> assignments_of(const CommandOptions& options);

/// An option's value from `lo` to `hi`. Throws InputError, which names what was expected.
double option_number(const char* option, const std::string& text, const char* expected, double lo, double hi);
std::int64_t option_count(const char* option, const std::string& text, const char* expected, std::int64_t lo,
                          std::int64_t hi);

/// The parts between separators, trimmed; one at least.
std::vector<std::string> split(const std::string& text, char separator);

/// The layer that --layer names. Throws InputError, which lists those of the scene.
const LayerParams& layer_named(const Scene& scene, const std::string& name);

// Where results go: asked before any work is done, so that hours are not spent on a frame that cannot
// be written.

/// Creates `folder` where it is missing and tries a temporary file in it. Throws OutputError.
void prove_writable(const fs::path& folder);

/// Folder of a file as an absolute path.
fs::path folder_of(const fs::path& file);

/// Throws InputError when something lies at `file`, unless `overwrite`.
void refuse_to_overwrite(const fs::path& file, bool overwrite);

/// For files that appear while we work.
inline Existing existing_of(const CommandOptions& options) {
    return options.overwrite ? Existing::replace : Existing::keep;
}

/// The output, where it can be written; from now on interrupts are deferred (exit.h).
/// Throws InputError, OutputError.
WriteTarget claim_output(const CommandOptions& options);

// Results on stdout: one ordered tree of names and values, printed as JSON or as indented lines for people.

using Report = nlohmann::ordered_json;

/// A number, or the word "inf", "-inf" or "nan", for which JSON has no number.
Report number(double value);

void print_report(const Report& report, bool json);

/// Options of --submit, besides those of --batch.
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

/// The file or folder that the command is about, which has to be given.
void add_input(CLI::App& app, CommandOptions& options, const std::string& name, const std::string& help);
/// -o, which has to be given, and --overwrite; returns the former.
CLI::Option* add_output(CLI::App& app, CommandOptions& options, const std::string& placeholder,
                        const std::string& help);
void add_assignments(CLI::App& app, CommandOptions& options);  // --set
void add_progress(CLI::App& app, CommandOptions& options);
void add_json(CLI::App& app, CommandOptions& options);
void add_device_option(CLI::App& app, CommandOptions& options);  // --device
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

/// What set_detail() gave each layer.
Report to_report(std::span<const LayerDetail> found);

// The commands, in the order of the help. Each returns an exit code (exit.h), prints results on stdout, and
// throws InputError, OutputError and Cancelled.

void add_new(CLI::App& app, Invocation& call);             // a first scene around a picture
void add_detail_command(CLI::App& app, Invocation& call);  // detail where a scene's camera comes close
void add_prepare(CLI::App& app, Invocation& call);         // a picture made ready for a scene
void add_generate(CLI::App& app, Invocation& call);        // splats into files, without rendering
void add_convert(CLI::App& app, Invocation& call);         // likewise
void add_export(CLI::App& app, Invocation& call);          // splats with their look, for other programs
void add_camera(CLI::App& app, Invocation& call);          // the scene's camera, for other programs
void add_status(CLI::App& app, Invocation& call);          // frames that are there, missing or damaged
void add_info(CLI::App& app, Invocation& call);            // the content of any file that is read
void add_compare(CLI::App& app, Invocation& call);         // the difference of two images
void add_parameters(CLI::App& app, Invocation& call);      // every key of scene files, or those of one scene
void add_fidelity(CLI::App& app, Invocation& call);        // the likeness of a scene to its picture
void add_verify(CLI::App& app, Invocation& call);          // frames rendered again, compared with their files
void add_device(CLI::App& app, Invocation& call);          // what draws frames on this machine
void add_manual(CLI::App& app, Invocation& call);
void add_completion(CLI::App& app, Invocation& call);

// The program without a command.

int run_batch(const CommandOptions& options);

/// Submits nothing where nothing is missing, or what is missing is on its way already. Afterwards either both
/// jobs are in the queue or neither. Throws InputError (bad options, sbatch missing or refusing), OutputError
/// (no place for scripts beside the frames), Cancelled.
int run_submit(const SubmitOptions& options, const CommandOptions& batch);

}  // namespace astrosplat
