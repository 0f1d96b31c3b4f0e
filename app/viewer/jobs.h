// Rendering to files for the window: one job at a time, of one frame, the scene's frames or a movie of them.
// In: what the person asked for and the document as it stands. Out: how far it is, and what has come of it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "edit/commands.h"
#include "edit/document.h"
#include "edit/status.h"
#include "sets/set_cache.h"
#include "viewer/render_job.h"

namespace astrosplat {

class Jobs {
  public:
    explicit Jobs(SetCache cache) : cache_(std::move(cache)) {}

    /// `command`: render_frame, render_range or render_movie; `frame` is the one seen. Throws OutputError,
    /// and InputError while a job runs.
    void start(const Command& command, const Document& document, double frame);
    /// Writes a layer's prepared picture, as the command `prepare` does. Throws as start() does.
    void prepare(const SourceParams& source, const std::filesystem::path& folder);
    void cancel() { job_.cancel(); }
    bool running() const { return job_.state() == RenderJob::State::running; }

    struct News {
        std::string text;
        bool error = false;
    };
    /// Takes what the job has said; news once it has ended.
    std::optional<News> poll(JobStatus& status);

  private:
    void start_in(const std::filesystem::path& folder, const Command& command, const Document& document,
                  double frame);

    SetCache cache_;
    RenderJob job_;
    std::filesystem::path target_;  // as it is told to the person
};

}  // namespace astrosplat
