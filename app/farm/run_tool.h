// A tool of the system, such as sbatch, run to its end without a shell.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace astrosplat {

struct ToolResult {
    int code = 0;          // its exit code; 128 + signal where a signal ended it
    std::string out, err;  // all it has written
};

/// Runs words[0], found on the PATH, in `folder` (empty: where we are) and waits for its end. Empty where
/// there is no such program, or it cannot be started.
std::optional<ToolResult> run_tool(const std::vector<std::string>& words,
                                   const std::filesystem::path& folder = {});

/// What went wrong, as one line: the first one that the tool wrote, or its exit code.
std::string failure_of(const ToolResult& result);

}  // namespace astrosplat
