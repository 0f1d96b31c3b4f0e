// Rendering to files while the window stays usable: the program itself as a child process with --batch, on a
// copy of the scene as it stands. So a frame of the viewer is a frame of the farm, and a cancelled or crashed
// job harms nothing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace astrosplat {

/// One step of a job.
struct ProcessStep {
    std::string name;                    // "Rendering", "Writing the movie"
    std::vector<std::string> arguments;  // [0] is the program
};

/// How much of all frames is done, 0..1, by a line of --progress plain such as
/// "astrosplat: frame 12 (3/10) 37% eta 00:04:10"; nothing for other lines.
std::optional<float> share_of_line(const std::string& line);

class RenderJob {
  public:
    RenderJob();
    ~RenderJob();  // cancels and waits

    /// `frames` frames of the scene `scene_text` as `arguments` after --batch SCENE say, then `afterwards`.
    /// `folder` is the job's own: scene.toml is written there, and it is removed at the end. Throws
    /// OutputError, and InputError while a job runs.
    void start(const std::filesystem::path& folder, const std::string& scene_text, std::int64_t frames,
               const std::vector<std::string>& arguments, std::vector<ProcessStep> afterwards = {});
    /// One step, whose arguments are those of the program itself. Throws as above.
    void start(ProcessStep step);
    void cancel();

    enum class State { none, running, done, failed, cancelled };
    State state() const;
    /// Takes what the process has said since the last call. Cheap; call every frame.
    void poll();
    std::string text() const;  // "frame 12 (3/10)", or the last line of a job that failed
    float progress() const;    // 0..1
    /// Frames it has saved, in the order in which they came.
    const std::vector<std::filesystem::path>& saved_files() const;
    /// done, failed or cancelled: seen once, then none.
    State take_result();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace astrosplat
