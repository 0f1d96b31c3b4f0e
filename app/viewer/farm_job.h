// A rendering on the machines of a farm: the program itself hands the frames to Slurm (--submit slurm), and
// is asked again and again (status --json) until all are there. So the window does what the command line
// does, and what was submitted goes on when the window is closed. All that the window knows of Slurm it reads
// here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "edit/status.h"
#include "farm/child_process.h"
#include "farm/submission.h"

namespace astrosplat {

/// The state of the frames that a farm was given.
struct FarmReport {
    bool complete = false;  // every frame is there
    bool active = false;    // a task waits or runs, or that is not known
    std::int64_t frames = 0, done = 0;
    std::vector<std::int64_t> done_frames;   // their numbers, ascending; of pairs those of the first eye
    std::vector<std::int64_t> jobs;          // in Slurm's queue, of submissions that are not over
    std::string output;                      // the pattern of their files, with an absolute folder
    std::vector<SubmittedFrames> submitted;  // of this pattern, whatever their options
    std::string text;                        // "12 of 240 done, in the queue: 3 running, 21 pending"
};

/// Of what `status --json` has written; nothing where that is no report.
std::optional<FarmReport> read_farm_report(const std::string& output);

/// Jobs of "30 frames in 3 tasks submitted as job 2, which waits for the sets of job 1": 2, 1. None where
/// nothing was submitted.
std::vector<std::int64_t> submitted_jobs(const std::string& output);

struct FarmCommands {
    std::vector<std::string> submit, status;  // [0] is the program; submit is empty: that was done before
    std::string pattern;                      // of the frames' files
};

class FarmJob {
  public:
    /// Begins to submit, or to watch what was submitted. Throws OutputError where the program cannot be
    /// started.
    explicit FarmJob(FarmCommands commands);

    /// Takes what came, and asks anew where it is time. Cheap; call every frame. `now` in seconds.
    void poll(double now);
    /// Takes the tasks out of the queue; finished frames stay.
    void cancel();

    using State = QueuedJob::State;  // running, done, failed or cancelled
    State state() const { return state_; }
    const std::string& text() const { return text_; }  // one line
    float progress() const;                            // 0..1, of frames
    const FarmCommands& commands() const { return commands_; }
    /// At the last look a task waited or ran.
    bool is_active() const { return report_.active; }
    /// Of frames that are there.
    const std::vector<std::filesystem::path>& files() const { return files_; }

  private:
    enum class Task { submit, watch, cancel };

    void begin(Task task, double now);
    void end(int code, double now);
    void take_report(const FarmReport& report);
    std::vector<std::string> cancel_command() const;
    void fail(std::string why);

    FarmCommands commands_;
    State state_ = State::running;
    Task task_ = Task::submit;
    std::optional<ChildProcess> process_;  // none: waits for the time to ask again
    std::string output_, text_ = "Submitting";
    std::vector<std::int64_t> jobs_;  // its own in Slurm's queue; none: others had taken all frames
    FarmReport report_;
    std::vector<std::filesystem::path> files_;
    double began_s_ = 0.0, next_s_ = 0.0;
    int idle_reports_ = 0;  // that found frames missing and nothing in the queue
    bool cancelled_ = false;
};

}  // namespace astrosplat
