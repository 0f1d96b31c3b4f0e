#include "viewer/render_queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/text.h"
#include "edit/command_lines.h"
#include "scene/frames.h"

namespace astrosplat {

namespace {

namespace fs = std::filesystem;

/// "frame 12 (3/10)" of "frame 12 (3/10) 37% eta 00:04:10".
std::string without_share(const std::string& line) {
    const std::size_t percent = line.find("% eta ");
    if (percent == std::string::npos) return line;
    const std::size_t blank = line.rfind(' ', percent);
    return blank == std::string::npos ? line : line.substr(0, blank);
}

/// Of "saved FILE 3.59s".
std::optional<fs::path> file_of_line(const std::string& line) {
    constexpr std::string_view begin = "saved ";
    const std::size_t end = line.rfind(' ');
    if (line.rfind(begin, 0) != 0 || end < begin.size()) return std::nullopt;
    return line.substr(begin.size(), end - begin.size());
}

}  // namespace

std::optional<float> share_of_line(const std::string& line) {
    const std::size_t percent = line.find("% ");
    if (percent == std::string::npos) return std::nullopt;
    const std::size_t blank = line.rfind(' ', percent);
    if (blank == std::string::npos) return std::nullopt;
    const auto part = parse_int64(line.substr(blank + 1, percent - blank - 1));
    if (!part) return std::nullopt;
    double done = 0.01 * static_cast<double>(*part);
    const std::size_t open = line.find('('), slash = line.find('/', open), shut = line.find(')', slash);
    if (open == std::string::npos || slash == std::string::npos || shut == std::string::npos)
        return static_cast<float>(done);
    const auto index = parse_int64(line.substr(open + 1, slash - open - 1));
    const auto count = parse_int64(line.substr(slash + 1, shut - slash - 1));
    if (index && count && *count > 0)
        done = (static_cast<double>(*index - 1) + done) / static_cast<double>(*count);
    return static_cast<float>(std::clamp(done, 0.0, 1.0));
}

RenderJob::~RenderJob() {
    process_.reset();
    clean();
}

void RenderJob::begin_step() {
    partial_.clear();
    process_.emplace(plan_.steps[step_].arguments);
}

void RenderJob::take_line(const std::string& line) {
    if (trim(line).empty()) return;
    last_line_ = without_share(without_prefix(line));
    if (const auto file = file_of_line(last_line_)) saved_.push_back(*file);
    if (const auto share = share_of_line(line)) progress_ = *share;
    // Short frames are saved faster than progress is reported.
    if (plan_.frames > 0)
        progress_ = std::max(progress_, static_cast<float>(saved_.size()) / static_cast<float>(plan_.frames));
}

void RenderJob::read_output() {
    partial_ += process_->output();
    for (std::size_t end; (end = partial_.find_first_of("\r\n")) != std::string::npos;) {
        take_line(partial_.substr(0, end));
        partial_.erase(0, end + 1);
    }
}

void RenderJob::finish_step(bool good) {
    take_line(partial_);
    process_.reset();
    if (state_ == State::running && good && ++step_ < plan_.steps.size()) return begin_step();
    if (state_ == State::running) state_ = good ? State::done : State::failed;
    clean();
}

void RenderJob::clean() {
    std::error_code ignored;
    if (!plan_.folder.empty()) fs::remove_all(plan_.folder, ignored);
    plan_.folder.clear();
}

void RenderJob::start(JobPlan plan) {
    if (process_) throw InputError("a rendering is under way: cancel it first, or wait");
    plan_ = std::move(plan);
    step_ = 0;
    last_line_.clear();
    progress_ = 0.0f;
    saved_.clear();
    try {
        if (!plan_.folder.empty()) write_file_atomically(plan_.folder / "scene.toml", plan_.scene_text);
        begin_step();
        state_ = State::running;
    } catch (...) {
        clean();
        throw;
    }
}

void RenderJob::cancel() {
    if (!process_) return;
    state_ = State::cancelled;
    process_->terminate();
}

void RenderJob::poll() {
    if (!process_) return;
    const std::optional<int> code = process_->exit_code();
    read_output();  // after the question, so that nothing written before the end is lost
    if (!code) return;
    try {
        finish_step(*code == 0);
    } catch (const OutputError& error) {  // the next step did not start
        last_line_ = error.what();
        state_ = State::failed;
        clean();
    }
}

std::string RenderJob::text() const {
    if (state_ == State::running && step_ > 0) return plan_.steps[step_].name;
    return last_line_.empty() ? "Rendering" : last_line_;
}

RenderJob::State RenderJob::take_result() {
    if (state_ == State::running || process_) return State::none;
    return std::exchange(state_, State::none);
}

namespace {

namespace fs = std::filesystem;
using JobState = QueuedJob::State;

constexpr const char* cancelled_text = "Cancelled; finished files are kept";

void remove_folder(const fs::path& folder) {
    std::error_code ignored;
    if (!folder.empty()) fs::remove_all(folder, ignored);
}

void expect_no_movie(const RenderTask& task) {
    const fs::path movie = render_target(task);
    if (task.kind == RenderKind::movie && task.existing == ExistingFrames::refuse && fs::exists(movie))
        throw InputError(movie.string() + ": exists already");
}

/// A submission of the window has a scene file of its own.
bool is_same(const FarmCommands& listed, const FarmCommands& found) {
    constexpr std::size_t scene = 2;  // behind the program and "status"
    return listed.status == found.status ||
           (!listed.submit.empty() && listed.status.at(scene) == found.status.at(scene));
}

void append(std::vector<std::string>& words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
}

}  // namespace

void RenderQueue::push(QueuedJob job, Work work) {
    job.number = ++last_number_;
    jobs_.push_back(std::move(job));
    work_.push_back(std::move(work));
}

void RenderQueue::add_farm_job(FarmCommands commands, const std::string& title, fs::path target,
                               bool is_news) {
    QueuedJob job;
    job.state = JobState::submitted;
    job.title = title + ", Slurm";
    job.target = std::move(target);
    push(std::move(job), {{}, std::make_unique<FarmJob>(std::move(commands)), is_news});
}

/// Tasks read the scene until the last of them has run, whatever becomes of the document meanwhile. The same
/// text has the same name, so that what is submitted again is known to be the same.
void RenderQueue::add_to_farm(const RenderTask& task, const Document& document) {
    constexpr std::size_t few = 8;  // digits
    const fs::path folder = render_target(task).parent_path() / "slurm";
    const std::string text = document.text_for(folder / "scene.toml");
    const std::string name = fs::path(document.name()).stem().string();
    const fs::path scene = folder / fmt::format("{}-{}.toml", name, Sha256().add(text).hex().substr(0, few));
    std::error_code failed;
    fs::create_directories(folder, failed);
    write_file_atomically(scene, text);
    FarmCommands commands;
    commands.pattern = render_files(task).string();
    commands.submit = {program_, "--submit", "slurm", scene.string()};
    commands.status = {program_, "status", scene.string(), "--json"};
    append(commands.submit, submit_arguments(task));
    append(commands.status, frame_arguments(task));
    if (!cache_.folder.empty()) append(commands.submit, {"--cache", cache_.folder.string()});
    add_farm_job(std::move(commands), document.name() + ": " + render_title(task), render_target(task), true);
}

/// Looks at a single frame: the answer tells of the others' submissions, too.
void RenderQueue::list_earlier(const Document& document) {
    lookup_.reset();
    if (document.file().empty()) return;
    const auto first =
        static_cast<double>(parse_frames(document.scene().output.frames, "output.frames").front());
    Lookup& lookup = lookup_.emplace();
    lookup.title = document.name();
    lookup.command = {program_, "status", document.file().string(), "--json"};
    append(lookup.command, frame_arguments(make_render_task(document, RenderKind::frame, first)));
}

void RenderQueue::take_earlier() try {
    if (!lookup_->process) lookup_->process.emplace(lookup_->command);
    const std::optional<int> code = lookup_->process->exit_code();
    lookup_->answer += lookup_->process->output();  // after the question, so that nothing is lost
    if (!code) return;
    if (const std::optional<FarmReport> report = read_farm_report(lookup_->answer))
        for (const SubmittedFrames& submitted : report->submitted) add_earlier(submitted, report->output);
    lookup_.reset();
} catch (const OutputError&) {  // a program that does not start, which is not tried again
    lookup_.reset();
    throw;
}

/// Unless it is in the list.
void RenderQueue::add_earlier(const SubmittedFrames& submitted, const std::string& output) {
    FarmCommands commands;
    commands.pattern = output;
    commands.status = {program_, "status"};
    append(commands.status, submitted.options);
    append(commands.status, {"--frames=" + submitted.frames, "--json"});
    const auto is_known = [&](const Work& work) {
        return work.farm && is_same(work.farm->commands(), commands);
    };
    if (std::ranges::none_of(work_, is_known))
        add_farm_job(std::move(commands), lookup_->title + ": Frames " + submitted.frames, output, false);
}

void RenderQueue::add(const RenderTask& task, const Document& document) {
    const std::string problem = render_problem(task, document.scene().camera);
    if (!problem.empty()) throw InputError(problem);
    if (renders_by_slurm(task)) return add_to_farm(task, document);
    expect_no_movie(task);
    QueuedJob job;
    job.title = document.name() + ": " + render_title(task);
    job.target = render_target(task);
    JobPlan plan;
    plan.frames = static_cast<std::int64_t>(parse_frames(task.frames, "frames").size());
    plan.folder = make_temporary_folder();
    const fs::path scene = plan.folder / "scene.toml";
    ProcessStep& render = plan.steps.emplace_back();
    render = {"Rendering", {program_, "--batch", scene.string(), "--progress", "plain"}};
    append(render.arguments, batch_arguments(task, limits_));
    if (!cache_.folder.empty()) append(render.arguments, {"--cache", cache_.folder.string()});
    if (task.kind == RenderKind::movie)
        plan.steps.push_back({"Writing the movie", movie_command(job.target, document.scene().output.fps)});
    try {
        plan.scene_text = document.text_for(scene);
    } catch (...) {
        remove_folder(plan.folder);
        throw;
    }
    push(std::move(job), {std::move(plan), nullptr, true});
}

void RenderQueue::add_preparation(const SourceParams& source, const fs::path& folder) {
    QueuedJob job;
    job.title = "Prepared picture";
    job.target = folder;
    JobPlan plan;
    plan.steps = {{"Preparing", {program_}}};
    append(plan.steps[0].arguments, prepare_command(source, folder));
    append(plan.steps[0].arguments, limit_arguments({.threads = limits_.threads}));
    append(plan.steps[0].arguments, {"--progress", "plain"});
    push(std::move(job), {std::move(plan), nullptr, true});
}

QueuedJob* RenderQueue::running_job() {
    const auto found = std::ranges::find(jobs_, JobState::running, &QueuedJob::state);
    return found == jobs_.end() ? nullptr : &*found;
}

RenderQueue::~RenderQueue() {
    for (std::size_t i = 0; i < jobs_.size(); ++i)
        if (jobs_[i].state == JobState::waiting) remove_folder(work_[i].plan.folder);
}

void RenderQueue::cancel(std::uint64_t number) {
    const auto job = std::ranges::find(jobs_, number, &QueuedJob::number);
    if (job == jobs_.end()) return;
    const Work& work = work_[static_cast<std::size_t>(job - jobs_.begin())];
    if (job->state == JobState::running) job_.cancel();
    if (job->state == JobState::submitted) work.farm->cancel();
    if (job->state != JobState::waiting) return;
    job->state = JobState::cancelled;
    remove_folder(work.plan.folder);
}

void RenderQueue::remove(std::uint64_t number) {
    cancel(number);
    const auto job = std::ranges::find(jobs_, number, &QueuedJob::number);
    if (job == jobs_.end() || job->state == JobState::running || job->state == JobState::submitted) return;
    work_.erase(work_.begin() + (job - jobs_.begin()));
    jobs_.erase(job);
}

void RenderQueue::begin_next(double now) {
    const auto next = std::ranges::find(jobs_, JobState::waiting, &QueuedJob::state);
    if (next == jobs_.end()) return;
    next->state = JobState::running;
    began_ = now;
    try {
        job_.start(work_[static_cast<std::size_t>(next - jobs_.begin())].plan);
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
            const bool movie = work_[static_cast<std::size_t>(&job - jobs_.data())].plan.steps.size() > 1;
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
            return News{cancelled_text};
        default:
            return std::nullopt;
    }
}

std::optional<RenderQueue::News> RenderQueue::poll_farm(QueuedJob& job, Work& work, double now) {
    FarmJob& farm = *work.farm;
    farm.poll(now);
    work.is_news = work.is_news || farm.is_active();
    const auto news = [&](News told) { return work.is_news ? std::optional(std::move(told)) : std::nullopt; };
    job.text = farm.text();
    job.progress = farm.progress();
    job.files = farm.files();
    switch (farm.state()) {
        case FarmJob::State::done:
            job.state = JobState::done;
            return news({"Saved " + job.target.string()});
        case FarmJob::State::failed:
            job.state = JobState::failed;
            return news({job.text, true});
        case FarmJob::State::cancelled:
            job.state = JobState::cancelled;
            return News{cancelled_text};
        default:
            return std::nullopt;
    }
}

std::optional<RenderQueue::News> RenderQueue::poll(double now) {
    constexpr float enough = 0.02f;  // of the work, to tell how long the rest takes
    if (lookup_) take_earlier();
    for (std::size_t i = 0; i < jobs_.size(); ++i)
        if (jobs_[i].state == JobState::submitted)
            if (auto news = poll_farm(jobs_[i], work_[i], now)) return news;
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
