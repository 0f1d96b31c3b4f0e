#include "viewer/render_job.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/text.h"

extern char** environ;

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

/// A running program and the end of the pipe that its stdout and stderr go to.
struct Process {
    pid_t id = -1;
    int output = -1;
};

Process spawn(const std::vector<std::string>& arguments) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw OutputError("cannot start " + arguments[0] + ": no pipe");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    std::vector<char*> words;
    for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    Process process;
    const int error = posix_spawnp(&process.id, words[0], &actions, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    if (error != 0) {
        close(ends[0]);
        throw OutputError(
            fmt::format("cannot start {}: {}", arguments[0], std::generic_category().message(error)));
    }
    fcntl(ends[0], F_SETFL, O_NONBLOCK);
    process.output = ends[0];
    return process;
}

/// The share of a line such as "astrosplat: frame 12 (3/10) 37% eta 00:04:10"; nothing for other lines.
std::optional<float> share_of(const std::string& line) {
    const std::size_t percent = line.find("% ");
    if (percent == std::string::npos) return std::nullopt;
    const std::size_t blank = line.rfind(' ', percent);
    if (blank == std::string::npos) return std::nullopt;
    const auto part = parse_int64(line.substr(blank + 1, percent - blank - 1));
    if (!part) return std::nullopt;
    double done = 0.01 * static_cast<double>(*part);
    const std::size_t open = line.find('('), slash = line.find('/', open), shut = line.find(')', open);
    if (open == std::string::npos || slash == std::string::npos || shut == std::string::npos || slash > shut)
        return static_cast<float>(done);
    const auto index = parse_int64(line.substr(open + 1, slash - open - 1));
    const auto count = parse_int64(line.substr(slash + 1, shut - slash - 1));
    if (index && count && *count > 0)
        done = (static_cast<double>(*index - 1) + done) / static_cast<double>(*count);
    return static_cast<float>(std::clamp(done, 0.0, 1.0));
}

std::string without_prefix(const std::string& line) {
    constexpr std::string_view prefix = "astrosplat: ";
    return line.rfind(prefix, 0) == 0 ? line.substr(prefix.size()) : line;
}

}  // namespace

struct RenderJob::Impl {
    State state = State::none;
    std::vector<ProcessStep> steps;
    std::size_t step = 0;
    Process process;
    std::string partial, last_line;
    float progress = 0.0f;
    fs::path folder;

    void begin_step() {
        process = spawn(steps[step].arguments);
        partial.clear();
    }
    void take_line(const std::string& line) {
        if (trim(line).empty()) return;
        last_line = without_prefix(line);
        if (const auto share = share_of(line)) progress = *share;
    }
    void read_output() {
        char buffer[4096];
        for (ssize_t n; process.output >= 0 && (n = read(process.output, buffer, sizeof buffer)) > 0;) {
            partial.append(buffer, static_cast<std::size_t>(n));
            for (std::size_t end; (end = partial.find_first_of("\r\n")) != std::string::npos;) {
                take_line(partial.substr(0, end));
                partial.erase(0, end + 1);
            }
        }
    }
    void reap(int status) {
        read_output();
        take_line(partial);
        close(process.output);
        process = {};
        const bool good = WIFEXITED(status) && WEXITSTATUS(status) == 0;
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
    cancel();
    if (impl_->process.id > 0) {
        int status = 0;
        waitpid(impl_->process.id, &status, 0);
        impl_->reap(status);
    }
}

void RenderJob::start(const fs::path& folder, const std::string& scene_text,
                      const std::vector<std::string>& arguments, std::vector<ProcessStep> afterwards) {
    if (impl_->process.id > 0) throw InputError("a rendering is under way: cancel it first, or wait");
    *impl_ = Impl{};
    impl_->folder = folder;
    const fs::path scene = folder / "scene.toml";
    write_file_atomically(scene, scene_text);
    ProcessStep render{
        "Rendering",
        {fs::read_symlink("/proc/self/exe").string(), "--batch", scene.string(), "--progress", "plain"}};
    render.arguments.insert(render.arguments.end(), arguments.begin(), arguments.end());
    impl_->steps.push_back(std::move(render));
    for (ProcessStep& step : afterwards) impl_->steps.push_back(std::move(step));
    impl_->state = State::running;
    try {
        impl_->begin_step();
    } catch (...) {
        impl_->state = State::none;
        impl_->clean();
        throw;
    }
}

void RenderJob::cancel() {
    if (impl_->process.id <= 0) return;
    impl_->state = State::cancelled;
    kill(impl_->process.id, SIGTERM);
}

RenderJob::State RenderJob::state() const { return impl_->state; }

void RenderJob::poll() {
    if (impl_->process.id <= 0) return;
    impl_->read_output();
    int status = 0;
    if (waitpid(impl_->process.id, &status, WNOHANG) == impl_->process.id) {
        try {
            impl_->reap(status);
        } catch (const OutputError& error) {  // the next step did not start
            impl_->last_line = error.what();
            impl_->state = State::failed;
            impl_->clean();
        }
    }
}

std::string RenderJob::text() const {
    if (impl_->state == State::running && impl_->step < impl_->steps.size() && impl_->step > 0)
        return impl_->steps[impl_->step].name;
    return impl_->last_line.empty() ? "Rendering" : impl_->last_line;
}

float RenderJob::progress() const { return impl_->progress; }

RenderJob::State RenderJob::take_result() {
    if (impl_->state == State::running || impl_->process.id > 0) return State::none;
    return std::exchange(impl_->state, State::none);
}

}  // namespace astrosplat
