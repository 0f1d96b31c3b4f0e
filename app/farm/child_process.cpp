// A tool's two outputs are read as they come: one that has filled a pipe would wait for us for ever.
#include "farm/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "core/error.h"
#include "core/text.h"

extern char** environ;

namespace astrosplat {
namespace {

/// A pipe whose ends are closed with it.
struct Pipe {
    std::array<int, 2> ends = {-1, -1};

    Pipe() {
        if (pipe2(ends.data(), O_CLOEXEC) != 0) ends = {-1, -1};
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    ~Pipe() {
        for (int& end : ends) close_end(end);
    }
    static void close_end(int& end) {
        if (end >= 0) close(end);
        end = -1;
    }
};

struct Started {
    pid_t id = -1;
    int error = 0;  // as errno; 0: it was started
};

/// With nothing to read on stdin; stdout and stderr go to these ends.
Started start(const std::vector<std::string>& words, const fs::path& folder, int out, int err) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err, STDERR_FILENO);
    if (!folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    Started started;
    started.error = posix_spawnp(&started.id, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    return started;
}

int as_exit_code(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

/// Appends what can be read; closes the end once there will be no more.
void read_some(int& end, std::string& text) {
    std::array<char, 4096> bytes;
    const ssize_t size = read(end, bytes.data(), bytes.size());
    if (size > 0) text.append(bytes.data(), static_cast<std::size_t>(size));
    if (size == 0 || (size < 0 && errno != EINTR)) Pipe::close_end(end);
}

void read_both(Pipe& out, Pipe& err, ToolResult& result) {
    while (out.ends[0] >= 0 || err.ends[0] >= 0) {
        std::array<pollfd, 2> ready = {pollfd{out.ends[0], POLLIN, 0}, pollfd{err.ends[0], POLLIN, 0}};
        if (poll(ready.data(), ready.size(), -1) < 0) continue;  // a signal
        if (ready[0].revents != 0) read_some(out.ends[0], result.out);
        if (ready[1].revents != 0) read_some(err.ends[0], result.err);
    }
}

}  // namespace

bool has_program(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::string_view rest = path ? path : "/usr/bin:/bin";
    while (!rest.empty()) {
        const std::size_t colon = rest.find(':');
        const fs::path candidate = fs::path(rest.substr(0, colon)) / name;
        std::error_code ignored;
        if (fs::is_regular_file(candidate, ignored) && access(candidate.c_str(), X_OK) == 0) return true;
        rest = colon == std::string_view::npos ? std::string_view{} : rest.substr(colon + 1);
    }
    return false;
}

std::string own_program() { return fs::read_symlink("/proc/self/exe").string(); }

std::string without_prefix(const std::string& line) {
    constexpr std::string_view prefix = "astrosplat: ";
    return line.starts_with(prefix) ? line.substr(prefix.size()) : line;
}

std::optional<ToolResult> run_tool(const std::vector<std::string>& words, const fs::path& folder) {
    Pipe out, err;
    if (out.ends[1] < 0 || err.ends[1] < 0) return std::nullopt;  // no descriptors left
    const Started tool = start(words, folder, out.ends[1], err.ends[1]);
    if (tool.error != 0) return std::nullopt;
    for (Pipe* pipe : {&out, &err}) Pipe::close_end(pipe->ends[1]);
    ToolResult result;
    read_both(out, err, result);
    int status = 0;
    while (waitpid(tool.id, &status, 0) < 0 && errno == EINTR) {
    }
    result.code = as_exit_code(status);
    return result;
}

std::string failure_of(const ToolResult& result) {
    const std::string_view text = trim(result.err.empty() ? result.out : result.err);
    if (text.empty()) return fmt::format("exit code {}", result.code);
    return std::string(trim(text.substr(0, text.find('\n'))));
}

ChildProcess::ChildProcess(const std::vector<std::string>& words) {
    Pipe pipe;
    const Started child = start(words, {}, pipe.ends[1], pipe.ends[1]);
    if (child.error != 0)
        throw OutputError(
            fmt::format("cannot start {}: {}", words[0], std::generic_category().message(child.error)));
    id_ = child.id;
    pipe_ = std::exchange(pipe.ends[0], -1);
    fcntl(pipe_, F_SETFL, O_NONBLOCK);
}

ChildProcess::~ChildProcess() {
    constexpr int again_ms = 10;
    terminate();
    // One that waits to be read would never end.
    for (pollfd ready{pipe_, POLLIN, 0}; !exit_code(); poll(&ready, 1, again_ms)) output();
    close(pipe_);
}

std::string ChildProcess::output() {
    std::string text;
    read_up_to(text.max_size(), 0, text);
    return text;
}

bool ChildProcess::read_up_to(std::size_t size, int most_ms, std::string& bytes) {
    constexpr std::size_t piece = 1 << 16;
    while (bytes.size() < size) {
        const std::size_t before = bytes.size();
        bytes.resize(std::min(size, before + piece));
        const ssize_t n = read(pipe_, bytes.data() + before, bytes.size() - before);
        bytes.resize(before + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
        if (n == 0) return false;
        pollfd ready{pipe_, POLLIN, 0};
        if (n < 0 && (bytes.empty() || poll(&ready, 1, most_ms) <= 0)) return true;
    }
    return true;
}

std::optional<int> ChildProcess::exit_code() {
    int status = 0;
    if (!exit_code_ && waitpid(id_, &status, WNOHANG) == id_) exit_code_ = as_exit_code(status);
    return exit_code_;
}

void ChildProcess::terminate() {
    if (!exit_code_) kill(id_, SIGTERM);
}

}  // namespace astrosplat
