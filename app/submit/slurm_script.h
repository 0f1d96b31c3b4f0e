// The two batch scripts of a submission to Slurm: one that generates and keeps the sets, one whose tasks
// render a chunk of frames each. In: the words of the command line. Out: text for bash, whatever bytes the
// words hold.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace astrosplat {

struct SlurmJob {
    std::string name;                      // letters, digits, - and _
    std::vector<std::string> program;      // and its arguments, but for the frames
    std::filesystem::path working_folder;  // where relative names in the arguments begin
    std::filesystem::path log_folder;      // sbatch is called there
    std::optional<std::string> partition;
    int threads = 1;         // of each task
    std::int64_t bytes = 0;  // of memory, of each task
};

/// `frames` as --frames reads them.
std::string sets_script(const SlurmJob& job, const std::optional<std::string>& frames);

/// One task for each of `chunks`, which are lists of frames.
std::string frames_script(const SlurmJob& job, const std::vector<std::string>& chunks);

/// One word for bash on one line, whatever bytes it holds but 0. (shell_word() of edit/ is for any POSIX
/// shell, where a new line can only stand for itself; sbatch refuses scripts with \r\n in them.)
std::string bash_word(const std::string& text);

/// The folder's name cannot be written into the name of a log, where % and \ have a meaning.
bool is_odd_log_folder(const std::filesystem::path& folder);

}  // namespace astrosplat
