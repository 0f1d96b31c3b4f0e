// The subcommands of the command line. In: options as typed. Out: an exit code (exit_code.h), results on
// stdout, errors thrown for main to report. --batch and the viewer, which others call too, have headers of
// their own.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "batch.h"
#include "exit_code.h"
#include "progress_report.h"
#include "sets/kept.h"

namespace astrosplat {

// new: a first scene around a picture, of bodies in depth or of columns on a shape.

struct NewOptions {
    std::filesystem::path image;
    std::filesystem::path scene;  // empty: the picture's name with .toml, in the working folder
    std::string as;               // an object of the sky, or plane; empty: chosen by looking at the picture
    std::string shape;            // of a scene of columns; empty: a scene of bodies
    bool film = false;
    bool overwrite = false;
};
int run_new(NewOptions options);

// prepare: a picture made ready for a scene: without its stars and its sky, cut out, its holes filled.

/// As typed; values are checked before any work.
struct PrepareOptions {
    std::filesystem::path image, folder;
    std::filesystem::path red, green, blue;       // three filters in place of the image
    std::map<std::string, std::string> settings;  // by key of describe_preparation()
    std::optional<std::filesystem::path> split;
    bool overwrite = false;
    ProgressMode progress = ProgressMode::automatic;
};
int run_prepare(const PrepareOptions& options);

// generate, convert: splats into files, without rendering.

struct GenerateOptions {
    std::filesystem::path scene, output;
    std::string layer;
    std::vector<std::string> assignments;
    std::optional<std::string> memory_gib;  // limit of what bodies are made in
    SetCache cache;
    bool overwrite = false;
    ProgressMode progress = ProgressMode::automatic;
};
int run_generate(const GenerateOptions& options);

struct ConvertOptions {
    std::filesystem::path input, output;
    bool overwrite = false;
    ProgressMode progress = ProgressMode::automatic;
};
int run_convert(const ConvertOptions& options);

// export: a scene's splats with their look baked, as Gaussians or a volume for other programs.

struct ExportOptions {
    std::filesystem::path scene, output;
    std::optional<std::string> frame, layer, count, space, voxel_size;
    std::vector<std::string> assignments;
    SetCache cache;
    bool overwrite = false;
    ProgressMode progress = ProgressMode::automatic;
};

/// The text of --help, with all that is approximated.
extern const char* const export_help;

/// Throws InputError, OutputError, Cancelled.
int run_export(const ExportOptions& options);

// camera: the scene's camera as a file for other programs.

struct CameraOptions {
    std::filesystem::path scene, output;
    std::optional<std::string> frames;
    std::vector<std::string> assignments;
    bool overwrite = false;
};

/// Throws InputError, OutputError.
int run_camera(const CameraOptions& options);

// info: the content of any file that the program reads.

struct InfoOptions {
    std::filesystem::path file;
    bool json = false;
};
int run_info(const InfoOptions& options);

// compare: the difference of two images.

struct CompareOptions {
    std::filesystem::path a, b;
    bool json = false;
    std::optional<std::string> max_difference;  // exit_some_failed where a channel differs by more
};
int run_compare(const CompareOptions& options);

// fidelity: the likeness of a scene to its picture, as a page or as JSON.

struct FidelityOptions {
    std::filesystem::path scene, output;
    std::optional<std::filesystem::path> reference;  // in place of the layer's own picture
    std::vector<std::string> assignments;            // --set KEY=VALUE
    SetCache cache;
    bool overwrite = false;
    ProgressMode progress = ProgressMode::automatic;
};
int run_fidelity(const FidelityOptions& options);

// verify: frames rendered again and compared with their files.

struct VerifyOptions {
    BatchOptions batch;  // scene, assignments, layers, memory, cache and progress are used
    std::vector<std::filesystem::path> files;  // frames in any order, each of any size, region and eye
    bool json = false;
};
/// exit_done when all are equal, else exit_some_failed.
int run_verify(const VerifyOptions& options);

// parameters: every key of scene files, or those of one scene with the values in use.

struct ParametersOptions {
    std::string scene;  // a file or a short name; empty: keys as the manual has them
    bool names = false, json = false;
};
int run_parameters(const ParametersOptions& options);

// status: the frames of a scene that are there and right, missing, damaged or of other settings. Only reads.

struct StatusOptions {
    BatchOptions batch;  // what --batch would be given: the same frames are expected
    bool json = false;
};

/// exit_done where every frame is there, exit_some_failed otherwise. Throws InputError.
int run_status(const StatusOptions& options);

// --submit slurm: the frames that are missing for a farm, as a job that makes the sets and an array of tasks
// that are plain --batch runs.

struct SubmitOptions {
    std::string system;                    // "slurm"
    std::optional<std::string> chunk;      // frames of a task; default 10
    std::optional<std::string> partition;  // of the cluster; default: its own
};

/// Submits nothing where nothing is missing, or what is missing is on its way already. Afterwards either both
/// jobs are in the queue or neither. Throws InputError (bad options, sbatch missing or refusing), OutputError
/// (no place for scripts beside the frames), Cancelled.
int run_submit(const SubmitOptions& options, const BatchOptions& batch);

}  // namespace astrosplat
