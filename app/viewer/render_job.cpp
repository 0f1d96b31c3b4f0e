#include "viewer/render_job.h"

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/text.h"

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

}  // namespace astrosplat
