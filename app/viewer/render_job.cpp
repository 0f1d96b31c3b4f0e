#include "viewer/render_job.h"

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/text.h"
#include "farm/child_process.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

constexpr const char* busy_message = "a rendering is under way: cancel it first, or wait";

// "frame 12 (3/10)" of "frame 12 (3/10) 37% eta 00:04:10".
std::string without_share(const std::string& line) {
    const std::size_t percent = line.find("% eta ");
    if (percent == std::string::npos) return line;
    const std::size_t blank = line.rfind(' ', percent);
    return blank == std::string::npos ? line : line.substr(0, blank);
}

// Of "saved FILE 3.59s".
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

struct RenderJob::Impl {
    State state = State::none;
    std::vector<ProcessStep> steps;
    std::size_t step = 0;
    std::optional<ChildProcess> process;
    std::string partial, last_line;
    float progress = 0.0f;
    std::int64_t frames = 0;
    std::vector<fs::path> saved;
    fs::path folder;

    void begin_step() {
        partial.clear();
        process.emplace(steps[step].arguments);
    }
    void take_line(const std::string& line) {
        if (trim(line).empty()) return;
        last_line = without_share(without_prefix(line));
        if (const auto file = file_of_line(last_line)) saved.push_back(*file);
        if (const auto share = share_of_line(line)) progress = *share;
        // Short frames are saved faster than progress is reported.
        if (frames > 0)
            progress = std::max(progress, static_cast<float>(saved.size()) / static_cast<float>(frames));
    }
    void read_output() {
        partial += process->output();
        for (std::size_t end; (end = partial.find_first_of("\r\n")) != std::string::npos;) {
            take_line(partial.substr(0, end));
            partial.erase(0, end + 1);
        }
    }
    void finish_step(bool good) {
        take_line(partial);
        process.reset();
        if (state == State::running && good && ++step < steps.size()) return begin_step();
        if (state == State::running) state = good ? State::done : State::failed;
        clean();
    }
    void clean() {
        std::error_code ignored;
        if (!folder.empty()) fs::remove_all(folder, ignored);
        folder.clear();
    }
};

RenderJob::RenderJob() : impl_(std::make_unique<Impl>()) {}

RenderJob::~RenderJob() {
    impl_->process.reset();
    impl_->clean();
}

void RenderJob::start(ProcessStep step) {
    if (impl_->process) throw InputError(busy_message);
    impl_ = std::make_unique<Impl>();
    step.arguments.insert(step.arguments.begin(), own_program());
    step.arguments.insert(step.arguments.end(), {"--progress", "plain"});
    impl_->steps.push_back(std::move(step));
    impl_->begin_step();
    impl_->state = State::running;
}

void RenderJob::start(const fs::path& folder, const std::string& scene_text, std::int64_t frames,
                      const std::vector<std::string>& arguments, std::vector<ProcessStep> afterwards) {
    if (impl_->process) throw InputError(busy_message);
    impl_ = std::make_unique<Impl>();
    impl_->folder = folder;
    impl_->frames = frames;
    const fs::path scene = folder / "scene.toml";
    ProcessStep render{"Rendering", {own_program(), "--batch", scene.string(), "--progress", "plain"}};
    render.arguments.insert(render.arguments.end(), arguments.begin(), arguments.end());
    impl_->steps.push_back(std::move(render));
    for (ProcessStep& step : afterwards) impl_->steps.push_back(std::move(step));
    try {
        write_file_atomically(scene, scene_text);
        impl_->begin_step();
        impl_->state = State::running;
    } catch (...) {
        impl_->clean();
        throw;
    }
}

void RenderJob::cancel() {
    if (!impl_->process) return;
    impl_->state = State::cancelled;
    impl_->process->terminate();
}

RenderJob::State RenderJob::state() const { return impl_->state; }

void RenderJob::poll() {
    if (!impl_->process) return;
    const std::optional<int> code = impl_->process->exit_code();
    impl_->read_output();  // after the question, so that nothing written before the end is lost
    if (!code) return;
    try {
        impl_->finish_step(*code == 0);
    } catch (const OutputError& error) {  // the next step did not start
        impl_->last_line = error.what();
        impl_->state = State::failed;
        impl_->clean();
    }
}

std::string RenderJob::text() const {
    if (impl_->state == State::running && impl_->step > 0) return impl_->steps[impl_->step].name;
    return impl_->last_line.empty() ? "Rendering" : impl_->last_line;
}

const std::vector<fs::path>& RenderJob::saved_files() const { return impl_->saved; }

float RenderJob::progress() const { return impl_->progress; }

RenderJob::State RenderJob::take_result() {
    if (impl_->state == State::running || impl_->process) return State::none;
    return std::exchange(impl_->state, State::none);
}

}  // namespace astrosplat
