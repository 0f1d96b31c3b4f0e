// What the commands of the command line share while they run: options as typed, their values, the places of
// results, and reports on stdout.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "progress_report.h"
#include "scene/load.h"
#include "scene/scene.h"
#include "sets/kept.h"

namespace astrosplat {

/// Options as typed that several commands take; each command looks at those that it has (cli.h), --batch at
/// all but `json`.
struct CommandOptions {
    std::filesystem::path input;                  // a scene, or whatever the command is about
    std::optional<std::filesystem::path> output;  // a file or a folder; of frames a pattern, relative to the
                                                  // working directory, which replaces output.path
    std::vector<std::string> assignments;         // --set KEY=VALUE
    std::optional<std::string> frames;            // replaces output.frames
    std::optional<std::string> resolution;        // "1920x1080" or "50%"
    std::optional<std::string> layers;            // "A,B": only these
    std::optional<std::string> region;            // "X,Y,W,H" from the top left, px
    std::optional<std::string> memory_gib;        // limit of all that is taken
    std::optional<std::filesystem::path> stats;
    SetCache cache;
    ProgressMode progress = ProgressMode::automatic;
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

// Where results go: asked before any work is done, so that hours are not spent on a frame nobody can write.

/// Creates `folder` where it is missing and tries a temporary file in it. Throws OutputError.
void prove_writable(const std::filesystem::path& folder);

/// Folder of a file as an absolute path.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// Throws InputError when something lies at `file`, unless `overwrite`.
void refuse_to_overwrite(const std::filesystem::path& file, bool overwrite);

/// For files that appear while we work.
inline Existing existing_of(const CommandOptions& options) {
    return options.overwrite ? Existing::replace : Existing::keep;
}

/// The output, where it can be written; from now on interrupts are deferred (exit.h). Throws InputError,
/// OutputError.
WriteTarget claim_output(const CommandOptions& options);

// Results on stdout: one ordered tree of names and values, printed as JSON or as indented lines for people.

using Report = nlohmann::ordered_json;

/// A number, or the word "inf", "-inf" or "nan", for which JSON has no number.
Report number(double value);

void print_report(const Report& report, bool json);

}  // namespace astrosplat
