// Other programs, started without a shell: tools of the system, such as sbatch, that run to their end, and
// programs that work alongside the window. In: words of a command. Out: exit code and output.
#pragma once

#include <sys/types.h>

#include "core/standard.h"

namespace astrosplat {

/// A program of this name is on the PATH.
bool has_program(const std::string& name);

/// This very program's file.
std::string own_program();
/// A line of this program's own messages without "astrosplat: "; other lines as they are.
std::string without_prefix(const std::string& line);

struct ToolResult {
    int code = 0;          // its exit code; 128 + signal where a signal ended it
    std::string out, err;  // all it has written
};

/// Runs words[0], found on the PATH, in `folder` (empty: where we are) and waits for its end. Empty where
/// there is no such program, or it cannot be started.
std::optional<ToolResult> run_tool(const std::vector<std::string>& words, const fs::path& folder = {});

/// The failure as one line: the first one that the tool wrote, or its exit code.
std::string failure_of(const ToolResult& result);

/// Another program at work, its output read as it comes, never waited for.
class ChildProcess {
  public:
    /// Starts words[0], found on the PATH, with stdout and stderr read by output(). Throws OutputError where
    /// it cannot be started.
    explicit ChildProcess(const std::vector<std::string>& words);
    ~ChildProcess();  // ends it (SIGTERM) and waits
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Its output since the last call.
    std::string output();
    /// Appends its output until `bytes` has this size. Once there is some, the rest is waited for, but no
    /// longer than that between two pieces. False: the output is at its end.
    bool read_up_to(std::size_t size, int most_ms, std::string& bytes);
    /// Its exit code once it has ended: 128 + signal where a signal ended it. Empty while it runs.
    std::optional<int> exit_code();
    void terminate();

  private:
    pid_t id_ = -1;
    int pipe_ = -1;
    std::optional<int> exit_code_;
};

}  // namespace astrosplat
