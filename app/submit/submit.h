// --submit slurm: hands the frames that are missing to a farm, as a job that makes the sets and an array of
// tasks that are plain --batch runs. Prints results to stdout, everything else to stderr, and returns the
// exit code.
#pragma once

#include <optional>
#include <string>

#include "batch.h"

namespace astrosplat {

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
