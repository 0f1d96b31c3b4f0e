// Values go into the scripts as words in quotes, never through #SBATCH lines, which Slurm parses its own way.
#include "submit/slurm_script.h"

#include <fmt/format.h>

#include <algorithm>

#include "edit/batch_command.h"

namespace astrosplat {
namespace {

constexpr std::int64_t mebibyte = 1 << 20;

// What an estimate may be short of, and Slurm ends a task that takes more than it asked for.
constexpr double memory_margin = 1.5;

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

std::int64_t mebibytes(std::int64_t bytes) {
    const auto needed = static_cast<std::int64_t>(static_cast<double>(bytes) * memory_margin);
    return (needed / mebibyte / 64 + 1) * 64;
}

std::string head(const SlurmJob& job, const std::string& suffix, const std::string& log) {
    std::string text = "#!/bin/bash\n";
    const auto add = [&](const std::string& line) { text += "#SBATCH --" + line + "\n"; };
    add("job-name=" + job.name + suffix);
    add("nodes=1");
    add("ntasks=1");
    add(fmt::format("cpus-per-task={}", job.threads));
    add(fmt::format("mem={}M", mebibytes(job.bytes)));
    if (job.partition) add("partition=" + *job.partition);
    add("requeue");           // of a node that fails: what is there is kept
    add("open-mode=append");  // and so is what it said
    add("output=" + (is_odd_log_folder(job.log_folder) ? "/dev/null" : log));
    return text;
}

/// From here on the script's output goes to the log, where Slurm cannot be told its name.
std::string own_log(const SlurmJob& job, const std::string& name) {
    if (!is_odd_log_folder(job.log_folder)) return "";
    return fmt::format("exec >> {}/{} 2>&1\n", bash_word(job.log_folder.string()), name);
}

std::string command(const SlurmJob& job, const std::string& more) {
    std::string text = fmt::format("cd -- {} || exit 4\nexec", bash_word(job.working_folder.string()));
    for (const std::string& word : job.program) text += " " + bash_word(word);
    return text + more + "\n";
}

}  // namespace

std::string bash_word(const std::string& text) {
    if (std::ranges::none_of(text, is_control)) return shell_word(text);
    std::string quoted = "$'";
    for (const char c : text) {
        if (is_control(c))
            quoted += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
        else if (c == '\'' || c == '\\')
            quoted += std::string("\\") + c;
        else
            quoted += c;
    }
    return quoted + "'";
}

bool is_odd_log_folder(const std::filesystem::path& folder) {
    return folder.string().find_first_of("%\\") != std::string::npos;
}

std::string sets_script(const SlurmJob& job, const std::optional<std::string>& frames) {
    const std::string more = frames ? " --frames=" + bash_word(*frames) : "";
    return head(job, "-sets", "%j.log") + own_log(job, "\"$SLURM_JOB_ID.log\"") +
           command(job, more + " --sets-only");
}

std::string frames_script(const SlurmJob& job, const std::vector<std::string>& chunks) {
    std::string text = head(job, "", "%A_%a.log");
    text += fmt::format("#SBATCH --array=0-{}\n", chunks.size() - 1);
    text += "#SBATCH --kill-on-invalid-dep=yes\n";
    text += own_log(job, "\"${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID.log\"");
    text += fmt::format("frames=(\n{}\n)\n", fmt::join(chunks, "\n"));
    return text + command(job, " --frames=\"${frames[SLURM_ARRAY_TASK_ID]}\" --resume");
}

}  // namespace astrosplat
