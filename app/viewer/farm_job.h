// A rendering on the machines of a farm: the program itself hands the frames to Slurm (--submit slurm), and
// is asked again and again (status) until all are there. So the window does what the command line does, and
// what was submitted goes on when the window is closed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "viewer/child_process.h"
#include "viewer/farm_report.h"

namespace astrosplat {

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

    enum class State { running, done, failed, cancelled };
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
