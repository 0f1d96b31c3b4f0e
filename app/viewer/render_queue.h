// Jobs that write files for the window: renderings and prepared pictures, one after the other, and renderings
// that a farm has. In: a request and the document as it stood then. Out: each job's progress and its result.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "edit/command_lines.h"
#include "edit/document.h"
#include "edit/settings.h"
#include "edit/status.h"
#include "sets/set_cache.h"
#include "viewer/farm_job.h"
#include "viewer/render_job.h"

namespace astrosplat {

class RenderQueue {
  public:
    /// `program`: this very program's file, which does the jobs, each within these limits.
    RenderQueue(SetCache cache, std::string program, MachineLimits limits = {})
        : cache_(std::move(cache)), program_(std::move(program)), limits_(limits) {}
    ~RenderQueue();  // jobs that wait are dropped

    /// Renders the scene as it stands, once all before it is done; a farm's job is submitted at once, with a
    /// copy of the scene beside its frames. Throws InputError where the task cannot be rendered, OutputError.
    void add(const RenderTask& task, const Document& document);
    /// Writes a layer's prepared picture, as the command `prepare` does. Throws InputError.
    void add_preparation(const SourceParams& source, const std::filesystem::path& folder);

    /// Earlier submissions of the document's frames to a farm come into the list, once poll() has heard of
    /// it. In place of another document's.
    void list_earlier(const Document& document);

    /// A job that waits never begins; one that runs, here or on a farm, ends, and its finished files stay.
    void cancel(std::uint64_t number);
    void cancel_running() { job_.cancel(); }
    /// Takes a job that has ended, or waits, off the list.
    void remove(std::uint64_t number);
    bool running() const { return job_.state() == RenderJob::State::running; }

    struct News {
        std::string text;
        bool error = false;
    };
    /// Takes what the running job has said and begins the next; news where one has ended. `now` in seconds.
    std::optional<News> poll(double now);
    /// Oldest first.
    const std::vector<QueuedJob>& jobs() const { return jobs_; }

  private:
    /// Arguments of a new job.
    struct Work {
        JobPlan plan;
        std::unique_ptr<FarmJob> farm;  // null: this machine does it
        bool is_news = true;            // what becomes of it
    };
    /// The question about earlier jobs.
    struct Lookup {
        std::vector<std::string> command;
        std::string title;
        std::optional<ChildProcess> process;  // once it is asked
        std::string answer;
    };

    void push(QueuedJob job, Work work);
    void begin_next(double now);
    QueuedJob* running_job();
    std::optional<News> take_end(QueuedJob& job);
    void add_to_farm(const RenderTask& task, const Document& document);
    void add_farm_job(FarmCommands commands, const std::string& title, std::filesystem::path target,
                      bool is_news);
    void take_earlier();
    void add_earlier(const SubmittedFrames& submitted, const std::string& output);
    std::optional<News> poll_farm(QueuedJob& job, Work& work, double now);

    SetCache cache_;
    std::string program_;
    MachineLimits limits_;
    std::optional<Lookup> lookup_;
    RenderJob job_;
    std::vector<QueuedJob> jobs_;
    std::vector<Work> work_;  // of each
    std::uint64_t last_number_ = 0;
    double began_ = 0.0;  // seconds
};

}  // namespace astrosplat
