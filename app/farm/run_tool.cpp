// Both outputs are read as they come: a tool that has filled one pipe would wait for us for ever.
#include "farm/run_tool.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>

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

std::optional<ToolResult> run_tool(const std::vector<std::string>& words,
                                   const std::filesystem::path& folder) {
    Pipe out, err;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, out.ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err.ends[1], STDERR_FILENO);
    if (!folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    pid_t id = -1;
    const int error = posix_spawnp(&id, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) return std::nullopt;
    for (Pipe* pipe : {&out, &err}) Pipe::close_end(pipe->ends[1]);
    ToolResult result;
    read_both(out, err, result);
    int status = 0;
    while (waitpid(id, &status, 0) < 0 && errno == EINTR) {
    }
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return result;
}

std::string failure_of(const ToolResult& result) {
    const std::string_view text = trim(result.err.empty() ? result.out : result.err);
    if (text.empty()) return fmt::format("exit code {}", result.code);
    return std::string(trim(text.substr(0, text.find('\n'))));
}

}  // namespace astrosplat
