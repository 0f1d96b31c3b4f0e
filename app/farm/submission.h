// The record of a submission to Slurm, and the state of its tasks. A submission lies beside the
// frames, in FRAMES_FOLDER/slurm/0001 and so on: sets.sh, frames.sh, submission.json (this record) and a log
// for each task.
#pragma once

#include <map>

#include "core/standard.h"

namespace astrosplat {

struct Submission {
    fs::path folder;                   // its own
    std::string name;                  // of the jobs; the first one's ends in -sets
    std::string output;                // the pattern of its frames
    std::vector<std::string> options;  // what else decides the frames: words of the command line
    std::int64_t sets_job = 0, frames_job = 0;
    std::vector<std::string> chunks;  // frames of each task, as --frames reads them
};

/// Where submissions of this pattern lie: below the last folder of it that all frames share.
fs::path submissions_folder(const std::string& output);

/// The pattern as records hold it.
std::string comparable_output(const std::string& output);

/// Of the same scene, with the same words that decide frames.
bool have_same_options(const Submission& a, const Submission& b);

/// Into its folder. Throws OutputError.
void write_submission(const Submission& submission);

/// All submissions of this pattern, in the order they were made; folders without a record are passed over.
std::vector<Submission> submissions_of(const std::string& output);

/// Frames that were handed over with the same options, in one submission or several.
struct SubmittedFrames {
    std::vector<std::string> options;
    std::string frames;  // as --frames reads them: "1-240"
};
/// In the order in which they were first submitted; submissions whose options or frames are no longer known
/// are left out.
std::vector<SubmittedFrames> submitted_frames(const std::vector<Submission>& submissions);

/// States as squeue names them, "PENDING", "RUNNING", "FAILED"; Slurm forgets tasks some minutes
/// after their end.
struct SubmissionState {
    std::string sets;                           // empty: forgotten
    std::map<std::int64_t, std::string> tasks;  // by index of the chunk; those not forgotten

    std::map<std::string, std::int64_t> counts() const;  // of tasks in each state
    bool is_active() const;                              // a task waits or runs
};

/// The task waits or runs.
bool is_active(const std::string& state);

struct QueueState {
    std::vector<SubmissionState> submissions;  // as asked for
    std::string problem;                       // why nothing is known of them; empty when it is
};
/// Asks squeue, unless there is nothing to ask.
QueueState ask_queue(const std::vector<Submission>& submissions);

/// Ascending; of tasks that wait or run.
std::vector<std::int64_t> frames_on_their_way(const Submission& submission, const SubmissionState& state);

}  // namespace astrosplat
