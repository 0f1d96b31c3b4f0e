// Jobs that write files while the window stays usable: renderings and prepared pictures, one after the
// other, by the program itself as a child process. A copy of the scene as it stands is rendered with
// --batch: so a frame of the viewer is a frame of the farm, and a cancelled or crashed job harms nothing. A
// rendering on the machines of a farm is handed to Slurm (--submit slurm) and asked for (status --json)
// until all frames are there; it goes on when the window is closed. In: a request and the document as it
// stood then. Out: each job's progress and its result.
#pragma once

#include "edit/command_lines.h"
#include "edit/document.h"
#include "edit/settings.h"
#include "edit/status.h"
#include "farm/child_process.h"
#include "farm/submission.h"
#include "sets/kept.h"

namespace astrosplat {

/// The state of the frames that a farm was given.
struct FarmReport {
    bool complete = false;  // every frame is there
    bool active = false;    // a task waits or runs, or that is not known
    std::int64_t frames = 0, done = 0;
    std::vector<std::int64_t> done_frames;   // their numbers, ascending; of pairs those of the first eye
    std::vector<std::int64_t> jobs;          // in Slurm's queue, of submissions that are not over
    std::string output;                      // the pattern of their files, with an absolute folder
    std::vector<SubmittedFrames> submitted;  // of this pattern, whatever their options
    std::string text;                        // "12 of 240 done, in the queue: 3 running, 21 pending"
};

/// Of what `status --json` has written; nothing where that is no report.
std::optional<FarmReport> read_farm_report(const std::string& output);

/// Jobs of "30 frames in 3 tasks submitted as job 2, which waits for the sets of job 1": 2, 1. None where
/// nothing was submitted.
std::vector<std::int64_t> submitted_jobs(const std::string& output);

struct FarmCommands {
    std::vector<std::string> submit, status;  // [0] is the program; submit is empty: that was done before
    std::string pattern;                      // of the frames' files
};

class FarmJob {
  public:
    /// Begins to submit, or to watch what was submitted. Throws OutputError where the program cannot be
    /// started.
    explicit FarmJob(FarmCommands commands);

    /// Takes what came, and asks anew where it is time. Cheap; call every frame. `now` in seconds.
    void poll(double now);
    /// Takes the tasks out of the queue; finished frames stay.
    void cancel();

    using State = QueuedJob::State;  // running, done, failed or cancelled
    State state() const { return state_; }
    const std::string& text() const { return text_; }  // one line
    float progress() const;                            // 0..1, of frames
    const FarmCommands& commands() const { return commands_; }
    /// At the last look a task waited or ran.
    bool is_active() const { return report_.active; }
    /// Of frames that are there.
    const std::vector<fs::path>& files() const { return files_; }

  private:
    enum class Task { submit, watch, cancel };

    void begin(Task task, double now);
    void end(int code, double now);
    void take_report(const FarmReport& report);
    std::vector<std::string> cancel_command() const;
    void fail(std::string why);

    FarmCommands commands_;
    State state_ = State::running;
    Task task_ = Task::submit;
    std::optional<ChildProcess> process_;  // none: waits for the time to ask again
    std::string output_, text_ = "Submitting";
    std::vector<std::int64_t> jobs_;  // its own in Slurm's queue; none: others had taken all frames
    FarmReport report_;
    std::vector<fs::path> files_;
    double began_s_ = 0.0, next_s_ = 0.0;
    int idle_reports_ = 0;  // that found frames missing and nothing in the queue
    bool cancelled_ = false;
};

struct ProcessStep {
    std::string name;                    // "Rendering", "Writing the movie"
    std::vector<std::string> arguments;  // [0] is the program
};

/// The work of one job.
struct JobPlan {
    std::vector<ProcessStep> steps;  // one after the other
    std::int64_t frames = 0;         // that are saved; 0: none
    fs::path movie;                  // that is made of them; empty: none
    bool may_replace = true;         // a movie that is there
    bool keeps_lines = false;        // all that is said, for whoever reads it at the end
    fs::path folder;                 // its own, removed at the end; empty: it needs none
    std::string scene_text;          // which is written there as scene.toml
};

/// How much of all frames is done, 0..1, by a line of --progress plain such as
/// "astrosplat: frame 12 (3/10) 37% eta 00:04:10"; nothing for other lines.
std::optional<float> share_of_line(const std::string& line);

/// A job of this machine at work.
class RenderJob {
  public:
    /// Throws OutputError.
    explicit RenderJob(JobPlan plan);
    ~RenderJob();  // cancels and waits
    void cancel();

    using State = QueuedJob::State;  // running, done, failed or cancelled
    /// Running until the last process has ended.
    State state() const { return process_ ? State::running : end_; }
    /// Takes what the process has said since the last call. Cheap; call every frame.
    void poll();
    std::string text() const;                     // "frame 12 (3/10)", or why it failed
    float progress() const { return progress_; }  // 0..1
    /// Frames it has saved, in the order in which they came.
    const std::vector<fs::path>& files() const { return saved_; }
    /// All it has said, where the plan wants that.
    const std::vector<std::string>& lines() const { return lines_; }
    /// The movie was there already, made of these very frames.
    bool kept() const { return kept_; }

  private:
    void begin_step();
    void take_line(const std::string& line);
    void read_output();
    void finish_step(bool good);

    JobPlan plan_;
    State end_ = State::running;  // cancelled as soon as that was asked for
    std::size_t step_ = 0;
    std::optional<ChildProcess> process_;
    std::string partial_, last_line_;
    std::string why_;  // the first error of the step; of a frame: it ends the job
    float progress_ = 0.0f;
    std::vector<fs::path> saved_;
    std::vector<std::string> lines_;
    bool kept_ = false;
};

class RenderQueue {
  public:
    /// `program`: this very program's file, which does the jobs, each within these limits.
    RenderQueue(SetCache cache, std::string program, MachineLimits limits = {})
        : cache_(std::move(cache)), program_(std::move(program)), limits_(limits) {}
    ~RenderQueue();  // jobs that wait are dropped

    /// Renders the scene as it stands, once all before it is done; a farm's job is submitted at once, with a
    /// copy of the scene beside its frames. Throws InputError where the task cannot be rendered, OutputError.
    void add(const RenderTask& task, const Document& document);
    /// What add() does on this machine; its folder is made. Throws as add() does.
    JobPlan plan_of(const RenderTask& task, const Document& document) const;
    /// Writes a layer's prepared picture, as the command `prepare` does. Throws InputError.
    void add_preparation(const SourceParams& source, const fs::path& folder);

    /// Earlier submissions of the document's frames to a farm come into the list, once poll() has heard of
    /// it. In place of another document's.
    void list_earlier(const Document& document);

    /// A job that waits never begins; one that runs, here or on a farm, ends, and its finished files stay.
    void cancel(std::uint64_t number);
    void cancel_running();
    /// A job that failed waits again, before those that its end holds up; its finished frames stay.
    void retry(std::uint64_t number);
    /// Takes a job that has ended, or waits, off the list; those that it held up go on.
    void remove(std::uint64_t number);
    bool running() const;

    /// Takes what the running job has said and begins the next; news where one has ended. `now` in seconds.
    std::optional<Message> poll(double now);
    /// Oldest first.
    std::vector<QueuedJob> jobs() const { return {jobs_.begin(), jobs_.end()}; }

  private:
    struct Job : QueuedJob {
        JobPlan plan;
        std::unique_ptr<RenderJob> run;  // while this machine does it
        std::unique_ptr<FarmJob> farm;   // null: a farm does not
        bool is_news = true;             // what becomes of it
    };
    /// The question about earlier jobs.
    struct Lookup {
        std::vector<std::string> command;
        std::string title;
        std::optional<ChildProcess> process;  // once it is asked
        std::string answer;
    };

    Job& push(std::string title, fs::path target);
    void begin_next(double now);
    std::optional<Message> take_end(Job& job, QueuedJob::State end);
    void release(std::uint64_t number);
    void add_to_farm(const RenderTask& task, const Document& document);
    Job& add_farm_job(FarmCommands commands, const std::string& title, fs::path target);
    void take_earlier();
    void add_earlier(const SubmittedFrames& submitted, const std::string& output);
    std::optional<Message> poll_farm(Job& job, double now);

    SetCache cache_;
    std::string program_;
    MachineLimits limits_;
    std::optional<Lookup> lookup_;
    std::vector<Job> jobs_;
    std::uint64_t last_number_ = 0;
    double began_ = 0.0;  // seconds
};

/// Of what --dry-run has printed: "About 00:01:36 and 744 MB in all; 12 of 240 frames are there already", of
/// a movie "About 00:01:36, with 744 MB of frames until the movie is written". Empty where nothing of it can
/// be read.
std::string estimate_text(const std::vector<std::string>& lines, bool movie = false);

/// Time and bytes that a rendering will take: the program's own --dry-run of the scene as it stands.
class RenderEstimate {
  public:
    /// Begins once a task and a document have stood for a moment, in place of what was asked before; call it
    /// every frame. `now` in seconds. Throws OutputError, InputError.
    void want(const RenderQueue& jobs, const RenderTask& task, const Document& document, double now);
    bool working() const { return waits_ || run_; }
    /// One line, also of why it cannot be rendered; empty: nothing is known.
    const std::string& text() const { return text_; }

  private:
    std::optional<std::pair<std::uint64_t, RenderTask>> asked_;  // revision of the document
    bool waits_ = false, movie_ = false;
    double since_ = 0.0;  // s
    std::unique_ptr<RenderJob> run_;
    std::string text_;
};

}  // namespace astrosplat
