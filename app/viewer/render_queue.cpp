#include "viewer/render_queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/temporary_folder.h"
#include "edit/prepare_command.h"
#include "scene/frames.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;
using JobState = QueuedJob::State;

void remove_folder(const fs::path& folder) {
    std::error_code ignored;
    if (!folder.empty()) fs::remove_all(folder, ignored);
}

void expect_no_movie(const RenderTask& task) {
    const fs::path movie = render_target(task);
    if (task.kind == RenderKind::movie && task.existing == ExistingFrames::refuse && fs::exists(movie))
        throw InputError(movie.string() + ": exists already");
}

}  // namespace

void RenderQueue::push(QueuedJob job, Work work) {
    job.number = ++last_number_;
    jobs_.push_back(std::move(job));
    work_.push_back(std::move(work));
}

void RenderQueue::add(const RenderTask& task, const Document& document) {
    const std::string problem = render_problem(task);
    if (!problem.empty()) throw InputError(problem);
    expect_no_movie(task);
    QueuedJob job;
    job.title = document.name() + ": " + render_title(task);
    job.target = render_target(task);
    Work work;
    work.frames = static_cast<std::int64_t>(parse_frames(task.frames, "frames").size());
    work.arguments = batch_arguments(task);
    if (!cache_.folder.empty())
        work.arguments.insert(work.arguments.end(), {"--cache", cache_.folder.string()});
    if (task.kind == RenderKind::movie)
        work.movie = {"Writing the movie", movie_command(job.target, document.scene().output.fps)};
    work.folder = make_temporary_folder();
    try {
        work.scene_text = document.text_for(work.folder / "scene.toml");
    } catch (...) {
        remove_folder(work.folder);
        throw;
    }
    push(std::move(job), std::move(work));
}

void RenderQueue::add_preparation(const SourceParams& source, const fs::path& folder) {
    QueuedJob job;
    job.title = "Prepared picture";
    job.target = folder;
    Work work;
    work.arguments = prepare_command(source, folder);
    push(std::move(job), std::move(work));
}

QueuedJob* RenderQueue::running_job() {
    const auto found = std::ranges::find(jobs_, JobState::running, &QueuedJob::state);
    return found == jobs_.end() ? nullptr : &*found;
}

RenderQueue::~RenderQueue() {
    for (std::size_t i = 0; i < jobs_.size(); ++i)
        if (jobs_[i].state == JobState::waiting) remove_folder(work_[i].folder);
}

void RenderQueue::cancel(std::uint64_t number) {
    const auto job = std::ranges::find(jobs_, number, &QueuedJob::number);
    if (job == jobs_.end()) return;
    if (job->state == JobState::running) job_.cancel();
    if (job->state != JobState::waiting) return;
    job->state = JobState::cancelled;
    remove_folder(work_[static_cast<std::size_t>(job - jobs_.begin())].folder);
}

void RenderQueue::remove(std::uint64_t number) {
    cancel(number);
    const auto job = std::ranges::find(jobs_, number, &QueuedJob::number);
    if (job == jobs_.end() || job->state == JobState::running) return;
    work_.erase(work_.begin() + (job - jobs_.begin()));
    jobs_.erase(job);
}

void RenderQueue::begin(const Work& work) {
    if (work.folder.empty()) return job_.start({"Preparing", work.arguments});
    std::vector<ProcessStep> afterwards;
    if (work.movie) afterwards.push_back(*work.movie);
    job_.start(work.folder, work.scene_text, work.frames, work.arguments, std::move(afterwards));
}

void RenderQueue::begin_next(double now) {
    const auto next = std::ranges::find(jobs_, JobState::waiting, &QueuedJob::state);
    if (next == jobs_.end()) return;
    next->state = JobState::running;
    began_ = now;
    try {
        begin(work_[static_cast<std::size_t>(next - jobs_.begin())]);
    } catch (const std::exception& error) {
        next->state = JobState::failed;
        next->text = error.what();
        throw;
    }
}

std::optional<RenderQueue::News> RenderQueue::take_end(QueuedJob& job) {
    const std::string last = job_.text();
    switch (job_.take_result()) {
        case RenderJob::State::done: {
            const bool movie = work_[static_cast<std::size_t>(&job - jobs_.data())].movie.has_value();
            std::error_code ignored;
            if (movie) fs::remove_all(movie_folder(job.target), ignored);
            if (movie) job.files.clear();
            job.state = JobState::done;
            job.progress = 1.0f;
            return News{"Saved " + job.target.string()};
        }
        case RenderJob::State::failed:
            job.state = JobState::failed;
            job.text = last;
            return News{last, true};
        case RenderJob::State::cancelled:
            job.state = JobState::cancelled;
            return News{"Cancelled; finished files are kept"};
        default:
            return std::nullopt;
    }
}

std::optional<RenderQueue::News> RenderQueue::poll(double now) {
    constexpr float enough = 0.02f;  // of the work, to tell how long the rest takes
    job_.poll();
    QueuedJob* const job = running_job();
    if (!job) {
        begin_next(now);
        return std::nullopt;
    }
    job->text = job_.text();
    job->progress = job_.progress();
    job->files = job_.saved_files();
    job->seconds_left.reset();
    if (job->progress >= enough)
        job->seconds_left = (now - began_) * static_cast<double>(1.0f / job->progress - 1.0f);
    if (running()) return std::nullopt;
    job->seconds_left.reset();
    return take_end(*job);
}

}  // namespace astrosplat
