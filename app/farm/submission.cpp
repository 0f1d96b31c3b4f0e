// Records are JSON; what squeue says is one task a line.
#include "farm/submission.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/text.h"
#include "farm/child_process.h"
#include "frame/output_pattern.h"
#include "scene/frames.h"

namespace astrosplat {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Submission, name, output, options, sets_job, frames_job, chunks)

namespace {

using Json = nlohmann::json;

constexpr const char* record_name = "submission.json";

/// File names may hold any bytes, JSON only UTF-8: what is written, and what is read back.
std::string as_utf8(const std::string& text) {
    return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

std::vector<std::string> as_utf8(std::vector<std::string> texts) {
    for (std::string& text : texts) text = as_utf8(text);
    return texts;
}

Submission read_submission(const fs::path& folder) {
    Submission submission = Json::parse(read_file(folder / record_name));
    submission.folder = folder;
    return submission;
}

/// "17 N/A PENDING astrosplat-m51-sets" or "18 3 RUNNING astrosplat-m51". Job numbers begin again when a
/// cluster is set up anew, so the name must be right, too.
void add_line(const std::string& line, const std::vector<Submission>& submissions, QueueState& queue) {
    std::istringstream in(line);
    std::string job, task, state, name;
    in >> job >> task >> state >> name;
    const std::optional<std::int64_t> number = parse_int64(job), index = parse_int64(task);
    for (std::size_t i = 0; number && i < submissions.size(); ++i) {
        if (submissions[i].sets_job == number && submissions[i].name + "-sets" == name)
            queue.submissions[i].sets = state;
        if (submissions[i].frames_job == number && index && submissions[i].name == name)
            queue.submissions[i].tasks[*index] = state;
    }
}

}  // namespace

fs::path submissions_folder(const std::string& output) {
    return output_pattern({}, comparable_output(output)).common_folder() / "slurm";
}

std::string comparable_output(const std::string& output) {
    return fs::absolute(output).lexically_normal().string();
}

bool have_same_options(const Submission& a, const Submission& b) {
    return as_utf8(a.options) == as_utf8(b.options);
}

void write_submission(const Submission& submission) {
    write_file_atomically(submission.folder / record_name,
                          Json(submission).dump(2, ' ', false, Json::error_handler_t::replace) + "\n",
                          Existing::keep);
}

std::vector<Submission> submissions_of(const std::string& output) {
    const fs::path folder = submissions_folder(output);
    const std::string wanted = as_utf8(comparable_output(output));
    std::set<fs::path> folders;
    std::error_code error;
    for (const fs::path& entry : entries_of(folder))
        if (fs::exists(entry / record_name, error)) folders.insert(entry);
    std::vector<Submission> submissions;
    for (const fs::path& one : folders) {
        try {
            Submission submission = read_submission(one);
            if (submission.output == wanted) submissions.push_back(std::move(submission));
        } catch (const std::exception&) {
            log_warning((one / record_name).string() + ": is no record of a submission, and passed over");
        }
    }
    return submissions;
}

std::vector<SubmittedFrames> submitted_frames(const std::vector<Submission>& submissions) {
    std::vector<std::pair<const Submission*, std::set<std::int64_t>>> groups;
    for (const Submission& one : submissions) {
        std::set<std::int64_t> frames;
        try {
            for (const std::string& chunk : one.chunks)
                for (const std::int64_t frame : parse_frames(chunk, record_name)) frames.insert(frame);
        } catch (const InputError&) {
            continue;
        }
        if (one.options.empty() || frames.empty()) continue;
        auto same = std::ranges::find_if(
            groups, [&](const auto& group) { return have_same_options(*group.first, one); });
        if (same == groups.end()) same = groups.insert(groups.end(), {&one, {}});
        same->second.merge(frames);
    }
    std::vector<SubmittedFrames> submitted;
    for (const auto& [first, frames] : groups)
        submitted.push_back({first->options, frames_text({frames.begin(), frames.end()})});
    return submitted;
}

bool is_active(const std::string& state) {
    static const std::set<std::string> ended = {"BOOT_FAIL", "CANCELLED", "COMPLETED",    "COMPLETING",
                                                "DEADLINE",  "FAILED",    "NODE_FAIL",    "OUT_OF_MEMORY",
                                                "PREEMPTED", "REVOKED",   "SPECIAL_EXIT", "TIMEOUT"};
    return !state.empty() && !ended.count(state);
}

std::map<std::string, std::int64_t> SubmissionState::counts() const {
    std::map<std::string, std::int64_t> counts;
    for (const auto& [index, state] : tasks) ++counts[state];
    return counts;
}

bool SubmissionState::is_active() const {
    return std::ranges::any_of(tasks, [](const auto& task) { return astrosplat::is_active(task.second); });
}

QueueState ask_queue(const std::vector<Submission>& submissions) {
    QueueState queue;
    queue.submissions.resize(submissions.size());
    if (submissions.empty()) return queue;
    std::vector<std::int64_t> jobs;
    for (const Submission& one : submissions)
        for (const std::int64_t job : {one.sets_job, one.frames_job}) jobs.push_back(job);
    const auto result = run_tool({"squeue", "--noheader", "--array", "--states=all", "--format=%F %K %T %j",
                                  fmt::format("--jobs={}", fmt::join(jobs, ","))});
    if (!result) return {std::move(queue.submissions), "squeue is not on the PATH"};
    std::istringstream lines(result->out);
    for (std::string line; std::getline(lines, line);) add_line(line, submissions, queue);
    // That the jobs are forgotten is no problem: nothing of them waits or runs.
    if (result->code != 0 && result->err.find("Invalid job id") == std::string::npos)
        queue.problem = "squeue: " + failure_of(*result);
    return queue;
}

std::vector<std::int64_t> frames_on_their_way(const Submission& submission, const SubmissionState& state) {
    std::vector<std::int64_t> frames;
    for (const auto& [index, name] : state.tasks) {
        if (!is_active(name) || index < 0 || index >= std::ssize(submission.chunks)) continue;
        const auto more = parse_frames(submission.chunks[static_cast<std::size_t>(index)],
                                       (submission.folder / record_name).string());
        frames.insert(frames.end(), more.begin(), more.end());
    }
    std::ranges::sort(frames);
    return frames;
}

}  // namespace astrosplat
