#include "viewer/render_queue.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "core/error.h"
#include "core/text.h"
#include "frame/output_pattern.h"
#include "scene/frames.h"

namespace astrosplat {
namespace {

using Json = nlohmann::json;

void add_eye(const Json& eye, FarmReport& report) {
    report.frames += eye.at("frames").get<std::int64_t>();
    const Json& done = eye.at("done");
    const auto count = done.at("count").get<std::int64_t>();
    if (report.done == 0 && count > 0) report.done_frames = parse_frames(done.at("frames"), "status");
    report.done += count;
}

std::string queue_text(const Json& status) {
    const std::string problem = status.at("queue_problem");
    if (!problem.empty()) return ", queue unknown: " + problem;
    std::vector<std::string> parts;
    for (const Json& submission : status.at("queue")) {
        if (!submission.at("active")) continue;
        const std::string sets = submission.at("sets");
        if (!sets.empty() && sets != "COMPLETED") parts.push_back("the sets " + lower_case(sets));
        for (const auto& [state, count] : submission.at("tasks").items())
            parts.push_back(fmt::format("{} {}", count.get<std::int64_t>(), lower_case(state)));
    }
    return parts.empty() ? "" : fmt::format(", in the queue: {}", fmt::join(parts, ", "));
}

constexpr double pause_s = 3.0;  // between questions, and the longer the more frames there are to look at:
constexpr double pause_share = 5.0;  // times what the last question took

std::string last_line(const std::string& text) {
    const std::string whole(trim(text));
    const std::size_t end = whole.rfind('\n');
    return without_prefix(end == std::string::npos ? whole : whole.substr(end + 1));
}

/// Of pairs those of the left eye.
std::vector<fs::path> files_of(const std::string& output, const std::vector<std::int64_t>& frames) {
    const OutputPattern pattern = output_pattern({}, output);
    std::vector<fs::path> files;
    for (const std::int64_t frame : frames) files.push_back(pattern.resolve(frame, Eye::left));
    return files;
}

}  // namespace

std::optional<FarmReport> read_farm_report(const std::string& output) try {
    const std::size_t begin = output.rfind("{", 0) == 0 ? 0 : output.find("\n{");
    const std::size_t end = output.rfind('}');
    if (begin == std::string::npos || end == std::string::npos || end < begin) return std::nullopt;
    const Json status = Json::parse(output.substr(begin, end + 1 - begin));
    FarmReport report;
    report.complete = status.at("complete");
    report.active = !status.at("queue_problem").get<std::string>().empty();
    for (const Json& eye : status.at("eyes")) add_eye(eye, report);
    for (const Json& submission : status.at("queue")) {
        if (!submission.at("active")) continue;
        report.active = true;
        for (const char* job : {"sets_job", "frames_job"}) report.jobs.push_back(submission.at(job));
    }
    report.output = status.at("output");
    for (const Json& one : status.at("submitted"))
        report.submitted.push_back({one.at("options").get<std::vector<std::string>>(), one.at("frames")});
    report.text = fmt::format("{} of {} done{}", report.done, report.frames, queue_text(status));
    return report;
} catch (const Json::exception&) {
    return std::nullopt;
} catch (const InputError&) {  // of the list of frames
    return std::nullopt;
}

std::vector<std::int64_t> submitted_jobs(const std::string& output) {
    static const std::regex words(R"( submitted as job (\d+), which waits for the sets of job (\d+))");
    std::smatch jobs;
    if (!std::regex_search(output, jobs, words)) return {};
    return {std::stoll(jobs[1]), std::stoll(jobs[2])};
}

FarmJob::FarmJob(FarmCommands commands) : commands_(std::move(commands)) {
    const bool submitted = commands_.submit.empty();
    if (submitted) text_ = "Looking at its frames";
    begin(submitted ? Task::watch : Task::submit, 0.0);
}

float FarmJob::progress() const {
    return report_.frames > 0 ? static_cast<float>(report_.done) / static_cast<float>(report_.frames) : 0.0f;
}

void FarmJob::begin(Task task, double now) {
    task_ = task;
    began_s_ = now;
    output_.clear();
    process_.emplace(task == Task::submit  ? commands_.submit
                     : task == Task::watch ? commands_.status
                                           : cancel_command());
}

void FarmJob::fail(std::string why) {
    state_ = State::failed;
    text_ = std::move(why);
}

std::vector<std::string> FarmJob::cancel_command() const {
    std::vector<std::string> words = {"scancel"};
    for (const std::int64_t job : jobs_.empty() ? report_.jobs : jobs_) words.push_back(std::to_string(job));
    return words;
}

void FarmJob::take_report(const FarmReport& report) {
    constexpr int enough = 2;  // frames may come between the look at them and the question to the queue
    report_ = report;
    text_ = report.text;
    files_ = files_of(commands_.pattern, report.done_frames);
    if (report.complete) state_ = State::done;
    idle_reports_ = report.active ? 0 : idle_reports_ + 1;
    if (!report.complete && idle_reports_ == enough)
        fail(fmt::format("{} of {} frames are missing, and nothing is in the queue any more",
                         report.frames - report.done, report.frames));
}

void FarmJob::end(int code, double now) {
    const Task ended = task_;
    process_.reset();
    next_s_ = now + std::max(pause_s, pause_share * (now - began_s_));
    if (ended == Task::cancel) {
        state_ = State::cancelled;
        if (code != 0) fail(last_line(output_));
        return;
    }
    if (ended == Task::submit) {
        jobs_ = submitted_jobs(output_);
        next_s_ = now;
        if (cancelled_ && jobs_.empty())
            state_ = State::cancelled;
        else if (code != 0)
            fail(last_line(output_));
        else
            text_ = last_line(output_);
        return;
    }
    if (cancelled_) return;
    if (const auto report = read_farm_report(output_))
        take_report(*report);
    else
        text_ = last_line(output_);  // a folder that is away for a moment, for instance
}

void FarmJob::poll(double now) try {
    if (state_ != State::running) return;
    if (process_) {
        const std::optional<int> code = process_->exit_code();
        output_ += process_->output();  // after the question, so that nothing written before the end is lost
        if (!code) return;
        end(*code, now);
    }
    if (state_ != State::running) return;
    if (cancelled_ && (!jobs_.empty() || !report_.jobs.empty())) return begin(Task::cancel, now);
    if (cancelled_) {  // nothing of it is in the queue
        state_ = State::cancelled;
        return;
    }
    if (now >= next_s_) begin(Task::watch, now);
} catch (const OutputError& error) {
    fail(error.what());
}

void FarmJob::cancel() {
    cancelled_ = true;
    text_ = "Cancelling";
    if (process_ && task_ != Task::cancel) process_->terminate();
}

}  // namespace astrosplat
