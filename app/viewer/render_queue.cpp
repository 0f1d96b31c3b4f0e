#include "viewer/render_queue.h"

#include <fmt/format.h>

#include <regex>
#include <system_error>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/memory.h"
#include "core/text.h"
#include "edit/edits.h"
#include "scene/frames.h"

namespace astrosplat {
namespace {

/// "frame 12 (3/10)" of "frame 12 (3/10) 37% eta 00:04:10".
std::string without_share(const std::string& line) {
    static const std::regex share(" [^ ]*% eta .*");
    return std::regex_replace(line, share, "");
}

/// Of "saved FILE 3.59s".
std::optional<fs::path> file_of_line(const std::string& line) {
    static const std::regex saved("saved (.*) [^ ]*");
    std::smatch parts;
    return std::regex_match(line, parts, saved) ? std::optional<fs::path>(parts[1].str()) : std::nullopt;
}

/// Of "astrosplat: error: frame 3: a.0003.png: cannot be written: No space left on device".
std::optional<std::string> error_of_line(const std::string& line) {
    constexpr std::string_view mark = "error: ";
    const std::string said = without_prefix(line);
    return said != line && said.starts_with(mark) ? std::optional(said.substr(mark.size())) : std::nullopt;
}

using JobState = QueuedJob::State;

constexpr const char* cancelled_text = "Cancelled; finished files are kept";

void remove_folder(const fs::path& folder) {
    std::error_code ignored;
    if (!folder.empty()) fs::remove_all(folder, ignored);
}

/// Throws InputError.
void expect_none(const fs::path& movie) {
    if (fs::exists(movie)) throw InputError(movie.string() + ": exists already");
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

std::optional<float> share_of_line(const std::string& line) {
    static const std::regex share(R"( (?:\((\d+)/([1-9]\d*)\) )?(\d+)% )");
    std::smatch parts;
    if (!std::regex_search(line, parts, share)) return std::nullopt;
    double done = 0.01 * std::stod(parts[3]);
    if (parts[1].matched) done = (std::stod(parts[1]) - 1.0 + done) / std::stod(parts[2]);
    return static_cast<float>(std::clamp(done, 0.0, 1.0));
}

RenderJob::RenderJob(JobPlan plan) : plan_(std::move(plan)) {
    try {
        if (!plan_.folder.empty()) {
            fs::create_directory(plan_.folder);  // gone with the last try
            fs::permissions(plan_.folder, fs::perms::owner_all);
            write_file_atomically(plan_.folder / "scene.toml", plan_.scene_text);
        }
        begin_step();
    } catch (...) {
        remove_folder(plan_.folder);
        throw;
    }
}

RenderJob::~RenderJob() {
    process_.reset();
    remove_folder(plan_.folder);
}

void RenderJob::begin_step() {
    partial_.clear();
    why_.clear();
    process_.emplace(plan_.steps[step_].arguments);
}

void RenderJob::take_line(const std::string& line) {
    if (trim(line).empty()) return;
    last_line_ = without_share(without_prefix(line));
    if (plan_.keeps_lines) lines_.push_back(last_line_);
    kept_ = kept_ || last_line_.starts_with("kept ");
    const bool is_own = step_ == 0;  // ffmpeg says errors only
    const std::optional<std::string> error = is_own ? error_of_line(line) : last_line_;
    if (error && why_.empty()) {
        why_ = *error;
        if (is_own && why_.starts_with("frame ")) process_->terminate();
    }
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
    if (end_ == State::cancelled) return;
    if (good && !kept_ && ++step_ < plan_.steps.size()) return begin_step();
    if (good && !kept_ && !plan_.movie.empty()) {
        if (!plan_.may_replace) expect_none(plan_.movie);  // that came meanwhile
        fs::rename(movie_part(plan_.movie), plan_.movie);
    }
    end_ = good ? State::done : State::failed;
}

void RenderJob::cancel() {
    end_ = State::cancelled;
    if (process_) process_->terminate();
}

void RenderJob::poll() {
    if (!process_) return;
    const std::optional<int> code = process_->exit_code();
    read_output();  // after the question, so that nothing written before the end is lost
    if (!code) return;
    try {
        finish_step(*code == 0);
    } catch (const std::exception& error) {  // the next step did not start, or the movie has no place
        why_ = error.what();
        end_ = State::failed;
    }
}

std::string RenderJob::text() const {
    if (process_ && step_ > 0) return plan_.steps[step_].name;
    if (end_ == State::failed && !why_.empty()) return why_;
    return last_line_.empty() ? "Rendering" : last_line_;
}

RenderQueue::Job& RenderQueue::push(std::string title, fs::path target) {
    Job& job = jobs_.emplace_back();
    job.number = ++last_number_;
    job.title = std::move(title);
    job.target = std::move(target);
    return job;
}

RenderQueue::Job& RenderQueue::add_farm_job(FarmCommands commands, const std::string& title,
                                            fs::path target) {
    auto farm = std::make_unique<FarmJob>(std::move(commands));
    Job& job = push(title + ", Slurm", std::move(target));
    job.state = JobState::submitted;
    job.farm = std::move(farm);
    return job;
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
    append(commands.submit, limit_arguments({.device = limits_.device}));
    append(commands.status, frame_arguments(task));
    if (!cache_.folder.empty()) append(commands.submit, {"--cache", cache_.folder.string()});
    add_farm_job(std::move(commands), document.name() + ": " + render_title(task), render_target(task));
}

/// Looks at a single frame: the answer tells of the others' submissions, too.
void RenderQueue::list_earlier(const Document& document) {
    lookup_.reset();
    if (document.file().empty()) return;
    Lookup& lookup = lookup_.emplace();
    lookup.title = document.name();
    lookup.command = {program_, "status", document.file().string(), "--json"};
    append(lookup.command, frame_arguments(make_render_task(document, RenderKind::frame,
                                                            frame_range(document.scene().output).first)));
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
    const auto is_known = [&](const Job& job) { return job.farm && is_same(job.farm->commands(), commands); };
    if (std::ranges::any_of(jobs_, is_known)) return;
    add_farm_job(std::move(commands), lookup_->title + ": Frames " + submitted.frames, output).is_news =
        false;
}

void RenderQueue::add(const RenderTask& task, const Document& document) {
    const std::string problem = render_problem(task, document.scene().camera);
    if (!problem.empty()) throw InputError(problem);
    if (renders_by_slurm(task)) return add_to_farm(task, document);
    JobPlan plan = plan_of(task, document);
    Job& job = push(document.name() + ": " + render_title(task), render_target(task));
    job.is_movie = task.kind == RenderKind::movie;
    job.is_splats = task.kind == RenderKind::splats;
    job.plan = std::move(plan);
}

JobPlan RenderQueue::plan_of(const RenderTask& task, const Document& document) const {
    const fs::path target = render_target(task);
    JobPlan plan;
    if (task.kind == RenderKind::movie) plan.movie = target;
    plan.may_replace = task.existing != ExistingFrames::refuse;
    if (!plan.movie.empty() && !plan.may_replace) expect_none(target);
    const bool splats = task.kind == RenderKind::splats;
    if (!splats) plan.frames = static_cast<std::int64_t>(parse_frames(task.frames, "frames").size());
    plan.folder = make_temporary_folder();
    const fs::path scene = plan.folder / "scene.toml";
    ProcessStep& render = plan.steps.emplace_back();
    render = {splats ? "Writing the splats" : "Rendering",
              {program_, splats ? export_mode(task) : "--batch", scene.string(), "--progress", "plain"}};
    append(render.arguments, splats ? export_arguments(task) : batch_arguments(task, limits_));
    if (splats) append(render.arguments, limit_arguments({.threads = limits_.threads}));
    if (!cache_.folder.empty()) append(render.arguments, {"--cache", cache_.folder.string()});
    if (task.kind == RenderKind::movie)
        plan.steps.push_back({"Writing the movie", movie_command(target, document.scene().output.fps)});
    try {
        plan.scene_text = document.text_for(scene);
    } catch (...) {
        remove_folder(plan.folder);
        throw;
    }
    return plan;
}

void RenderQueue::add_preparation(const SourceParams& source, const fs::path& folder) {
    ProcessStep step{"Preparing", {program_}};
    append(step.arguments, prepare_command(source, folder));
    append(step.arguments, limit_arguments({.threads = limits_.threads}));
    append(step.arguments, {"--progress", "plain"});
    push("Prepared picture", folder).plan.steps = {std::move(step)};
}

RenderQueue::~RenderQueue() {
    for (const Job& job : jobs_)
        if (job.state == JobState::waiting) remove_folder(job.plan.folder);
}

void RenderQueue::cancel(std::uint64_t number) {
    const auto job = std::ranges::find(jobs_, number, &Job::number);
    if (job == jobs_.end()) return;
    if (job->state == JobState::running) job->run->cancel();
    if (job->state == JobState::submitted) job->farm->cancel();
    if (job->state != JobState::waiting) return;
    job->state = JobState::cancelled;
    remove_folder(job->plan.folder);
}

void RenderQueue::release(std::uint64_t number) {
    for (Job& job : jobs_)
        if (job.held_by == number) job.held_by = 0;
}

void RenderQueue::retry(std::uint64_t number) {
    const auto job = std::ranges::find(jobs_, number, &Job::number);
    if (job == jobs_.end() || job->state != JobState::failed || job->farm) return;
    release(number);
    job->state = JobState::waiting;
    std::vector<std::string>& words = job->plan.steps.front().arguments;
    if (job->plan.frames > 0 && std::ranges::find(words, "--resume") == words.end())
        words.push_back("--resume");
}

void RenderQueue::remove(std::uint64_t number) {
    cancel(number);
    release(number);
    std::erase_if(jobs_, [&](const Job& job) {
        return job.number == number && job.state != JobState::running && job.state != JobState::submitted;
    });
}

bool RenderQueue::running() const {
    return std::ranges::find(jobs_, JobState::running, &Job::state) != jobs_.end();
}

void RenderQueue::cancel_running() {
    for (Job& job : jobs_)
        if (job.state == JobState::running) job.run->cancel();
}

void RenderQueue::begin_next(double now) {
    const auto next = std::ranges::find_if(
        jobs_, [](const Job& job) { return job.state == JobState::waiting && job.held_by == 0; });
    if (next == jobs_.end()) return;
    next->state = JobState::running;
    began_ = now;
    try {
        next->run = std::make_unique<RenderJob>(next->plan);
    } catch (const std::exception& error) {
        next->text = error.what();
        take_end(*next, JobState::failed);
        throw;
    }
}

namespace {

std::string size_of(const fs::path& file) {
    std::error_code failed;
    const std::uintmax_t bytes = fs::file_size(file, failed);
    return failed ? "" : human_bytes(static_cast<double>(bytes));
}

}  // namespace

/// Nothing while the job has not ended.
std::optional<Message> RenderQueue::take_end(Job& job, JobState end) {
    if (end != JobState::done && end != JobState::failed && end != JobState::cancelled) return std::nullopt;
    job.state = end;
    for (Job& other : jobs_)  // disks that are full are so for all
        if (end == JobState::failed && !job.farm && other.state == JobState::waiting && other.held_by == 0)
            other.held_by = job.number;
    if (end == JobState::failed) return Message{job.text, true};
    if (end == JobState::cancelled) return Message{cancelled_text};
    return Message{job.kept ? "Kept " + job.target.string() + ", which was made of these very frames"
                            : "Saved " + (job.is_splats ? job.text : job.target.string())};
}

std::optional<Message> RenderQueue::poll_farm(Job& job, double now) {
    FarmJob& farm = *job.farm;
    farm.poll(now);
    job.is_news = job.is_news || farm.is_active() || farm.state() == JobState::cancelled;
    job.text = farm.text();
    job.progress = farm.progress();
    job.files = farm.files();
    const std::optional<Message> news = take_end(job, farm.state());
    return job.is_news ? news : std::nullopt;
}

std::optional<Message> RenderQueue::poll(double now) {
    constexpr float enough = 0.02f;  // of the work, to tell how long the rest takes
    if (lookup_) take_earlier();
    for (Job& job : jobs_)
        if (job.state == JobState::submitted)
            if (auto news = poll_farm(job, now)) return news;
    const auto job = std::ranges::find(jobs_, JobState::running, &Job::state);
    if (job == jobs_.end()) {
        begin_next(now);
        return std::nullopt;
    }
    job->run->poll();
    job->text = job->run->text();
    job->progress = job->run->progress();
    job->files = job->run->files();
    job->kept = job->run->kept();
    job->seconds_left.reset();
    const JobState state = job->run->state();
    if (state == JobState::running) {
        if (job->progress >= enough)
            job->seconds_left = (now - began_) * static_cast<double>(1.0f / job->progress - 1.0f);
        return std::nullopt;
    }
    job->run.reset();
    if (state == JobState::done) job->progress = 1.0f;
    if (state == JobState::done && job->is_splats) job->text += ", " + size_of(job->target);
    if (state == JobState::done && job->is_movie) {  // its frames go
        remove_folder(movie_folder(job->target));
        job->files.clear();
    }
    return take_end(*job, state);
}

std::string estimate_text(const std::vector<std::string>& lines, bool movie) {
    static const std::regex frames(R"(frames (\d+): (\d+) to render, (\d+) there already)"),
        cost("(time|files) about .*, (.*) in all");
    std::string costs, there;
    std::smatch parts;
    for (const std::string& line : lines) {
        if (line.starts_with("kept ")) return "A movie of these very frames is there already";
        if (std::regex_match(line, parts, frames)) {
            if (parts[2] == "0" && !movie) return "All frames are there already";
            if (parts[3] != "0")
                there = fmt::format("; {} of {} frames are there already", parts[3].str(), parts[1].str());
        } else if (std::regex_match(line, parts, cost)) {
            const bool bytes = parts[1] == "files";
            costs += bytes ? movie ? ", with " : " and " : "About ";
            costs += parts[2].str() + (bytes && movie ? " of frames until the movie is written" : "");
        }
    }
    return costs.empty() || movie ? costs + there : costs + " in all" + there;
}

void RenderEstimate::want(const RenderQueue& jobs, const RenderTask& task, const Document& document,
                          double now) {
    constexpr double rest_s = 0.4;  // while a person types
    if (asked_ != std::pair(document.revision(), task)) {
        *this = {};
        asked_ = {document.revision(), task};
        since_ = now;
        waits_ = task.kind != RenderKind::splats && !renders_by_slurm(task) &&
                 render_problem(task, document.scene().camera).empty();
    }
    if (waits_ && now - since_ >= rest_s) {
        waits_ = false;
        JobPlan plan = jobs.plan_of(task, document);
        plan.steps.resize(1);
        plan.steps[0].arguments.push_back("--dry-run");
        movie_ = !std::exchange(plan.movie, {}).empty();
        plan.keeps_lines = true;
        run_ = std::make_unique<RenderJob>(std::move(plan));
    }
    if (!run_) return;
    run_->poll();
    if (run_->state() == RenderJob::State::running) return;
    text_ = run_->state() == RenderJob::State::done ? estimate_text(run_->lines(), movie_) : run_->text();
    run_.reset();
}

}  // namespace astrosplat
