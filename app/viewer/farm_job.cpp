#include "viewer/farm_job.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/text.h"
#include "frame/output_pattern.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

constexpr double pause_s = 3.0;  // between questions, and the longer the more frames there are to look at:
constexpr double pause_share = 5.0;  // times what the last question took

std::string last_line(const std::string& text) {
    const std::string whole(trim(text));
    const std::size_t end = whole.rfind('\n');
    return without_prefix(end == std::string::npos ? whole : whole.substr(end + 1));
}

std::vector<fs::path> files_of(const std::string& output, const std::vector<std::int64_t>& frames) {
    const OutputPattern pattern = output_pattern({}, output);
    std::vector<fs::path> files;
    if (pattern.is_stereo()) return files;
    for (const std::int64_t frame : frames) files.push_back(pattern.resolve(frame));
    return files;
}

}  // namespace

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
