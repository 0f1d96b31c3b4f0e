// Rendering to files while the window stays usable: the program itself as a child process with --batch, on a
// copy of the scene as it stands. So a frame of the viewer is a frame of the farm, and a cancelled or crashed
// job harms nothing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "farm/child_process.h"

namespace astrosplat {

struct ProcessStep {
    std::string name;                    // "Rendering", "Writing the movie"
    std::vector<std::string> arguments;  // [0] is the program
};

/// The work of one job.
struct JobPlan {
    std::vector<ProcessStep> steps;  // one after the other
    std::int64_t frames = 0;         // that are saved; 0: none
    std::filesystem::path folder;    // its own, removed at the end; empty: it needs none
    std::string scene_text;          // which is written there as scene.toml
};

/// How much of all frames is done, 0..1, by a line of --progress plain such as
/// "astrosplat: frame 12 (3/10) 37% eta 00:04:10"; nothing for other lines.
std::optional<float> share_of_line(const std::string& line);

class RenderJob {
  public:
    RenderJob() = default;
    ~RenderJob();  // cancels and waits

    /// Throws OutputError, and InputError while a job runs.
    void start(JobPlan plan);
    void cancel();

    enum class State { none, running, done, failed, cancelled };
    State state() const { return state_; }
    /// Takes what the process has said since the last call. Cheap; call every frame.
    void poll();
    std::string text() const;                     // "frame 12 (3/10)", or the last line of a job that failed
    float progress() const { return progress_; }  // 0..1
    /// Frames it has saved, in the order in which they came.
    const std::vector<std::filesystem::path>& saved_files() const { return saved_; }
    /// done, failed or cancelled: seen once, then none.
    State take_result();

  private:
    void begin_step();
    void take_line(const std::string& line);
    void read_output();
    void finish_step(bool good);
    void clean();

    JobPlan plan_;
    State state_ = State::none;
    std::size_t step_ = 0;
    std::optional<ChildProcess> process_;
    std::string partial_, last_line_;
    float progress_ = 0.0f;
    std::vector<std::filesystem::path> saved_;
};

}  // namespace astrosplat
