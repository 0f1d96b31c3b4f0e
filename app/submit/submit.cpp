// A plan of the frames, chunks of those to be rendered, two scripts, two calls of sbatch.
#include "submit/submit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <set>

#include "batch_plan.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/text.h"
#include "estimate.h"
#include "farm/submission.h"
#include "interrupt.h"
#include "scene/frames.h"
#include "submit/drafts.h"
#include "submit/slurm_script.h"

namespace astrosplat {
namespace fs = std::filesystem;
namespace {

using Frames = std::vector<std::int64_t>;

constexpr std::int64_t default_chunk = 10;
constexpr const char *sets_name = "sets.sh", *frames_name = "frames.sh";

void check_options(const SubmitOptions& options, const BatchOptions& batch) {
    if (options.system != "slurm") bad_input("--submit", "", "slurm", "'" + options.system + "'");
    if (batch.stats)
        bad_input("--stats", "", "no --submit beside it, whose tasks would all write it", "both");
    if (batch.sets_only)
        bad_input("--sets-only", "", "no --submit beside it, whose first job does that", "both");
    if (batch.cache.folder.empty())
        bad_input("--submit", "", "a cache, in which the tasks find their sets", "none");
    const auto is_plain = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) ||
               std::string_view("_-.,").find(c) != std::string_view::npos;
    };
    if (options.partition &&
        (options.partition->empty() || !std::ranges::all_of(*options.partition, is_plain)))
        bad_input("--partition", "", "names of partitions, such as short,long",
                  "'" + *options.partition + "'");
}

std::size_t parse_chunk(const SubmitOptions& options) {
    const auto chunk = options.chunk ? parse_int64(*options.chunk) : default_chunk;
    if (!chunk || *chunk < 1 || *chunk > 1'000'000)
        bad_input("--chunk", "", "a number of frames from 1", "'" + *options.chunk + "'");
    return static_cast<std::size_t>(*chunk);
}

/// Each once, whichever of its eyes are missing.
Frames frames_to_render(const BatchPlan& plan) {
    std::set<std::int64_t> frames;
    for (const FramePlan& frame : plan.frames)
        if (frame.render) frames.insert(frame.frame);
    return {frames.begin(), frames.end()};
}

std::vector<std::string> chunks_of(const Frames& frames, std::size_t size) {
    std::vector<std::string> chunks;
    for (std::size_t begin = 0; begin < frames.size(); begin += size)
        chunks.push_back(frames_text(
            {frames.begin() + static_cast<std::ptrdiff_t>(begin),
             frames.begin() + static_cast<std::ptrdiff_t>(std::min(begin + size, frames.size()))}));
    return chunks;
}

/// What decides the frames but for their numbers, as words of --batch. With = so that a value may begin with
/// -.
std::vector<std::string> frame_options(const BatchPlan& plan, const BatchOptions& batch) {
    std::vector<std::string> words = {fs::absolute(batch.scene).string()};
    if (batch.output) words.push_back("--output=" + plan.scene.output.path);
    if (batch.resolution) words.push_back("--resolution=" + *batch.resolution);
    if (batch.layers) words.push_back("--layers=" + *batch.layers);
    if (batch.region) words.push_back("--region=" + *batch.region);
    if (batch.memory_gib) words.push_back("--memory=" + *batch.memory_gib);
    for (const std::string& assignment : batch.assignments) words.push_back("--set=" + assignment);
    return words;
}

/// As Slurm and its tools show it without a quote.
std::string job_name(const fs::path& scene) {
    std::string name = "astrosplat-" + scene.stem().string();
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
    return name;
}

/// Takes away what waits or runs already. Throws InputError where that would make other frames of these
/// names.
void leave_out_queued(const Submission& wanted, Frames& frames) {
    const std::vector<Submission> submissions = submissions_of(wanted.output);
    const QueueState queue = ask_queue(submissions);
    if (!queue.problem.empty()) log_warning(queue.problem + "; frames may be in the queue already");
    for (std::size_t i = 0; i < submissions.size(); ++i) {
        if (!queue.submissions[i].is_active()) continue;
        if (!have_same_options(submissions[i], wanted))
            throw InputError(
                fmt::format("{}: job {} still makes these frames with other options; wait for it, or "
                            "end it with scancel {}",
                            wanted.output, submissions[i].frames_job, submissions[i].frames_job));
        const Frames queued = frames_on_their_way(submissions[i], queue.submissions[i]);
        Frames rest;
        std::ranges::set_difference(frames, queued, std::back_inserter(rest));
        if (rest.size() < frames.size())
            fmt::print("{} in the queue already, as job {}\n",
                       counted(std::ssize(frames) - std::ssize(rest), "frame"), submissions[i].frames_job);
        frames = std::move(rest);
    }
}

struct Scripts {
    std::string sets, frames;
};

Scripts make_scripts(const BatchPlan& plan, const SubmitOptions& options, const BatchOptions& batch,
                     const Submission& submission) {
    SlurmJob job;
    job.name = submission.name;
    job.program = {fs::read_symlink("/proc/self/exe").string(), "--batch"};
    job.program.insert(job.program.end(), submission.options.begin(), submission.options.end());
    job.program.push_back(fmt::format("--threads={}", thread_count()));
    job.program.push_back("--cache=" + fs::absolute(plan.cache.folder).string());
    job.working_folder = fs::current_path();
    job.log_folder = submission.folder;
    job.partition = options.partition;
    job.threads = thread_count();
    job.bytes = estimate(plan).bytes;
    Scripts scripts;
    scripts.sets = sets_script(job, batch.frames);
    if (batch.overwrite) job.program.push_back("--overwrite");
    scripts.frames = frames_script(job, submission.chunks);
    return scripts;
}

void submit(Submission& submission, const Scripts& scripts, DraftFolder& folder) {
    write_file_atomically(folder.path() / sets_name, scripts.sets);
    write_file_atomically(folder.path() / frames_name, scripts.frames);
    DraftJobs jobs;
    submission.sets_job = jobs.submit(folder.path(), {sets_name});
    submission.frames_job = jobs.submit(
        folder.path(), {fmt::format("--dependency=afterok:{}", submission.sets_job), frames_name});
    write_submission(submission);
    jobs.keep();
    folder.keep();
}

}  // namespace

int run_submit(const SubmitOptions& options, const BatchOptions& given) {
    check_options(options, given);
    const std::size_t chunk = parse_chunk(options);
    BatchOptions batch = given;
    batch.resume = true;
    const BatchPlan plan = plan_batch(batch);
    Submission submission;
    submission.name = job_name(batch.scene);
    submission.output = comparable_output(plan.scene.output.path);
    submission.options = frame_options(plan, batch);
    Frames frames = frames_to_render(plan);
    if (!frames.empty()) leave_out_queued(submission, frames);
    if (frames.empty()) {
        fmt::print("no frame is missing{}: nothing to submit\n",
                   frames_to_render(plan).empty() ? "" : " that is not in the queue");
        return exit_done;
    }
    submission.chunks = chunks_of(frames, chunk);
    const fs::path parent = submissions_folder(submission.output);
    if (batch.dry_run) {
        submission.folder = DraftFolder::next_name(parent);
        const Scripts scripts = make_scripts(plan, options, batch, submission);
        fmt::print("{}\n{}", scripts.sets, scripts.frames);
        return exit_done;
    }
    defer_interrupts();
    DraftFolder folder(parent);
    submission.folder = folder.path();
    submit(submission, make_scripts(plan, options, batch, submission), folder);
    fmt::print("{} in {} submitted as job {}, which waits for the sets of job {}\nscripts and logs in {}\n",
               counted(std::ssize(frames), "frame"), counted(std::ssize(submission.chunks), "task"),
               submission.frames_job, submission.sets_job, printable(submission.folder.string()));
    return exit_done;
}

}  // namespace astrosplat
