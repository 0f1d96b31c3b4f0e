// Destructors take back; keep() is the last thing that a submission calls.
#include "submit/drafts.h"

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <system_error>

#include "core/error.h"
#include "core/log.h"
#include "core/text.h"
#include "farm/run_tool.h"
#include "interrupt.h"
#include "places.h"

namespace astrosplat {
namespace fs = std::filesystem;

DraftFolder::DraftFolder(const fs::path& parent) {
    prove_writable(parent);
    std::error_code error;
    do folder_ = next_name(parent);  // somebody else may take it
    while (!fs::create_directory(folder_, error) && !error);
    if (error) throw OutputError(folder_.string() + ": cannot create this folder: " + error.message());
}

DraftFolder::~DraftFolder() {
    if (kept_) return;
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    fs::remove(folder_.parent_path(), ignored);  // unless others lie in it
}

fs::path DraftFolder::next_name(const fs::path& parent) {
    for (int number = 1;; ++number) {
        std::error_code ignored;
        const fs::path folder = parent / fmt::format("{:04}", number);
        if (!fs::exists(fs::symlink_status(folder, ignored))) return folder;
    }
}

DraftJobs::~DraftJobs() {
    for (const std::int64_t job : jobs_) {
        const std::optional<ToolResult> result = run_tool({"scancel", std::to_string(job)});
        if (!result || result->code != 0)
            log_error(fmt::format("job {0} could not be taken back; end it with scancel {0}", job));
    }
}

std::int64_t DraftJobs::submit(const fs::path& folder, std::vector<std::string> words) {
    words.insert(words.begin(), {"sbatch", "--parsable"});
    const std::optional<ToolResult> result = run_tool(words, folder);
    if (!result) throw InputError("--submit slurm: sbatch is not on the PATH");
    if (result->code != 0) throw InputError("--submit slurm: sbatch: " + failure_of(*result));
    // "17", and ";CLUSTER" where there are several.
    const auto job = parse_int64(trim(std::string_view(result->out).substr(0, result->out.find(';'))));
    if (!job) throw InputError("--submit slurm: sbatch named no job, but said: " + failure_of(*result));
    jobs_.push_back(*job);
    if (interrupted()) throw Cancelled();
    return *job;
}

}  // namespace astrosplat
