// Another program at work beside the window: started without a shell, its output read as it comes, never
// waited for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace astrosplat {

/// A program of this name is on the PATH.
bool has_program(const std::string& name);

/// A line of this program's own messages without "astrosplat: "; other lines as they are.
std::string without_prefix(const std::string& line);

class ChildProcess {
  public:
    /// Starts arguments[0] (found on the PATH) with stdout and stderr read by output().
    /// Throws OutputError where it cannot be started.
    explicit ChildProcess(const std::vector<std::string>& arguments);
    ~ChildProcess();  // ends it (SIGTERM) and waits
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// What it has written since the last call.
    std::string output();
    /// Its exit code once it has ended: 128 + signal where a signal ended it. Empty while it runs.
    std::optional<int> exit_code();
    void terminate();

  private:
    pid_t id_ = -1;
    int pipe_ = -1;
    std::optional<int> exit_code_;
};

}  // namespace astrosplat
