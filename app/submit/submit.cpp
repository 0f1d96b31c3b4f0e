// A plan of the frames, chunks of those to be rendered, two scripts, two calls of sbatch.
#include <fmt/format.h>

#include <cctype>
#include <iterator>
#include <set>
#include <system_error>

#include "batch_plan.h"
#include "command.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/text.h"
#include "edit/command_lines.h"
#include "edit/settings.h"
#include "estimate.h"
#include "exit.h"
#include "farm/child_process.h"
#include "farm/submission.h"
#include "scene/frames.h"

namespace astrosplat {
namespace {

using Frames = std::vector<std::int64_t>;

// The scripts: one generates and keeps the sets, one has tasks that render a chunk of frames each. Values go
// into them as words in quotes, never through #SBATCH lines, which Slurm parses its own way.

struct SlurmJob {
    std::string name;                  // letters, digits, - and _
    std::vector<std::string> program;  // and its arguments, but for the frames
    fs::path working_folder;           // where relative names in the arguments begin
    fs::path log_folder;               // sbatch is called there
    std::optional<std::string> partition;
    int threads = 1;         // of each task
    std::int64_t bytes = 0;  // of memory, of each task
};

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// One word for bash on one line, whatever bytes it holds but 0. (shell_word() of edit/ is for any POSIX
/// shell, where a new line can only stand for itself; sbatch refuses scripts with \r\n in them.)
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

/// The folder's name cannot be written into the name of a log, where % and \ have a meaning.
bool is_odd_log_folder(const fs::path& folder) {
    return folder.string().find_first_of("%\\") != std::string::npos;
}

constexpr std::int64_t mebibyte = 1 << 20;

// A margin over the estimate, since Slurm ends a task that takes more than it asked for.
constexpr double memory_margin = 1.5;

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

/// `frames` as --frames reads them.
std::string sets_script(const SlurmJob& job, const std::optional<std::string>& frames) {
    const std::string more = frames ? " --frames=" + bash_word(*frames) : "";
    return head(job, "-sets", "%j.log") + own_log(job, "\"$SLURM_JOB_ID.log\"") +
           command(job, more + " --sets-only");
}

/// One task for each of `chunks`, which are lists of frames.
std::string frames_script(const SlurmJob& job, const std::vector<std::string>& chunks) {
    std::string text = head(job, "", "%A_%a.log");
    text += fmt::format("#SBATCH --array=0-{}\n", chunks.size() - 1);
    text += "#SBATCH --kill-on-invalid-dep=yes\n";
    text += own_log(job, "\"${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID.log\"");
    text += fmt::format("frames=(\n{}\n)\n", fmt::join(chunks, "\n"));
    return text + command(job, " --frames=\"${frames[SLURM_ARRAY_TASK_ID]}\" --resume");
}

// Files and jobs of a submission before it is whole. Destructors take it back; keep() is the last thing that
// is called.

/// The first of 0001, 0002, ... that is free below `parent`.
fs::path next_folder(const fs::path& parent) {
    for (int number = 1;; ++number) {
        std::error_code ignored;
        const fs::path folder = parent / fmt::format("{:04}", number);
        if (!fs::exists(fs::symlink_status(folder, ignored))) return folder;
    }
}

/// A new folder, which goes with all that is in it unless it is kept.
class DraftFolder {
  public:
    /// Below `parent`, which is made where it is missing. Throws OutputError.
    explicit DraftFolder(const fs::path& parent) {
        prove_writable(parent);
        std::error_code error;
        do folder_ = next_folder(parent);  // somebody else may take it
        while (!fs::create_directory(folder_, error) && !error);
        if (error) throw OutputError(folder_.string() + ": cannot create this folder: " + error.message());
    }
    ~DraftFolder() {
        if (kept_) return;
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
        fs::remove(folder_.parent_path(), ignored);  // unless others lie in it
    }
    DraftFolder(const DraftFolder&) = delete;
    DraftFolder& operator=(const DraftFolder&) = delete;

    const fs::path& path() const { return folder_; }
    void keep() { kept_ = true; }

  private:
    fs::path folder_;
    bool kept_ = false;
};

/// Jobs in Slurm's queue, which are cancelled unless they are kept.
class DraftJobs {
  public:
    DraftJobs() = default;
    ~DraftJobs() {
        for (const std::int64_t job : jobs_) {
            const std::optional<ToolResult> result = run_tool({"scancel", std::to_string(job)});
            if (!result || result->code != 0)
                log_error(fmt::format("job {0} could not be taken back; end it with scancel {0}", job));
        }
    }
    DraftJobs(const DraftJobs&) = delete;
    DraftJobs& operator=(const DraftJobs&) = delete;

    /// Calls sbatch with these words in `folder`; the job's number. Throws InputError where sbatch is missing
    /// or refuses; Cancelled.
    std::int64_t submit(const fs::path& folder, std::vector<std::string> words) {
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
    void keep() { jobs_.clear(); }

  private:
    std::vector<std::int64_t> jobs_;
};

constexpr const char *sets_name = "sets.sh", *frames_name = "frames.sh";

void check_options(const SubmitOptions& options, const CommandOptions& batch) {
    if (options.system != "slurm") bad_input("--submit", "", "slurm", "'" + options.system + "'");
    if (batch.ffmetadata) bad_input("--ffmetadata", "", "no --submit with it", "both");
    if (batch.stats) bad_input("--stats", "", "no --submit with it, whose tasks would all write it", "both");
    if (batch.sets_only)
        bad_input("--sets-only", "", "no --submit with it, whose first job does that", "both");
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
    constexpr std::int64_t usual = 10, most = 1'000'000;  // frames of a task
    if (!options.chunk) return usual;
    return static_cast<std::size_t>(
        option_count("--chunk", *options.chunk, "a number of frames from 1", 1, most));
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

/// Throws InputError where Slurm says that it takes no array of so many tasks; it counts them from 0.
void check_array_size(std::size_t tasks, std::size_t frames, std::size_t chunk) {
    const std::optional<ToolResult> config = run_tool({"scontrol", "show", "config"});
    if (!config || config->code != 0) return;  // sbatch will say
    for (TextRows rows(config->out); rows.next();) {
        const auto words = rows.fields();
        const auto most =
            words.size() == 3 && words[0] == "MaxArraySize" ? parse_int64(words[2]) : std::nullopt;
        if (most && *most > 0 && tasks > std::size_t(*most))
            bad_input("--chunk", "",
                      fmt::format("{} or more, for Slurm's MaxArraySize is {} tasks",
                                  (frames + std::size_t(*most) - 1) / std::size_t(*most), *most),
                      fmt::format("{}, which makes {} tasks", chunk, tasks));
    }
}

/// The options that decide frames but for their numbers, as words of --batch. With = so that a value may
/// begin with a minus.
std::vector<std::string> frame_options(const BatchPlan& plan, const CommandOptions& batch) {
    std::vector<std::string> words = {fs::absolute(batch.input).string()};
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

/// Takes away what waits or runs already. Throws InputError where that would make other frames
/// of these names.
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

Scripts make_scripts(const BatchPlan& plan, const SubmitOptions& options, const CommandOptions& batch,
                     const Submission& submission) {
    SlurmJob job;
    job.name = submission.name;
    job.program = {own_program(), "--batch"};
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
    for (const std::string& word : limit_arguments({.device = batch.device})) job.program.push_back(word);
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

int run_submit(const SubmitOptions& options, const CommandOptions& given) {
    check_options(options, given);
    const std::size_t chunk = parse_chunk(options);
    CommandOptions batch = given;
    batch.resume = true;
    const BatchPlan plan = plan_batch(batch);
    Submission submission;
    submission.name = job_name(batch.input);
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
        submission.folder = next_folder(parent);
        const Scripts scripts = make_scripts(plan, options, batch, submission);
        fmt::print("{}\n{}", scripts.sets, scripts.frames);
        return exit_done;
    }
    check_array_size(submission.chunks.size(), frames.size(), chunk);
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
