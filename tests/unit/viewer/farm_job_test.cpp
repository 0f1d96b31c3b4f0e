// A farm's job in the window's queue: what is asked of the program, what it answers, and what becomes of it.
// The program is a stand-in here; tests/window has the real one.
#include "viewer/render_queue.h"

#include "support/run_program.h"
#include "support/test.h"

namespace astrosplat {
namespace {

using test::text_of;
std::string status_of(int done, const std::string& frames, bool complete, const std::string& queue,
                      const std::string& problem = "") {
    return R"({"scene": "a", "output": "b", "complete": )" + std::string(complete ? "true" : "false") +
           R"(, "eyes": [{"eye": "centre", "frames": 12, "done": {"count": )" + std::to_string(done) +
           R"(, "frames": ")" + frames + R"("}}], "queue": [)" + queue + R"(], "queue_problem": ")" +
           problem + R"(", "submitted": [{"options": ["/a.toml"], "frames": "1-12"}]})" + "\n";
}

const std::string at_work =
    R"({"sets_job": 7, "sets": "COMPLETED", "frames_job": 8, "active": true, "tasks": {"PENDING": 2, "RUNNING": 1}})";
const std::string waiting =
    R"({"sets_job": 7, "sets": "RUNNING", "frames_job": 8, "active": true, "tasks": {"PENDING": 3}})";
const std::string over =
    R"({"sets_job": 7, "sets": "", "frames_job": 8, "active": false, "tasks": {"FAILED": 3}})";

TEST(FarmReport, CountsFramesAndTasks) {
    const auto report = read_farm_report("astrosplat: warning: {\n" + status_of(5, "1-4,9", false, at_work));
    ASSERT_TRUE(report);
    EXPECT_EQ(report->done, 5);
    EXPECT_EQ(report->frames, 12);
    EXPECT_EQ(report->done_frames, (std::vector<std::int64_t>{1, 2, 3, 4, 9}));
    EXPECT_EQ(report->jobs, (std::vector<std::int64_t>{7, 8}));
    EXPECT_TRUE(report->active);
    EXPECT_FALSE(report->complete);
    EXPECT_EQ(report->output, "b");
    ASSERT_EQ(report->submitted.size(), 1u);
    EXPECT_EQ(report->submitted[0].options, std::vector<std::string>{"/a.toml"});
    EXPECT_EQ(report->submitted[0].frames, "1-12");
    EXPECT_EQ(report->text, "5 of 12 done, in the queue: 2 pending, 1 running");
}

TEST(FarmReport, SaysWhatTheFramesWaitFor) {
    EXPECT_EQ(read_farm_report(status_of(0, "", false, waiting))->text,
              "0 of 12 done, in the queue: the sets running, 3 pending");
    const auto ended = read_farm_report(status_of(0, "", false, over));
    EXPECT_EQ(ended->text, "0 of 12 done");
    EXPECT_FALSE(ended->active);
    EXPECT_TRUE(ended->jobs.empty());
    const auto unknown = read_farm_report(status_of(0, "", false, "", "squeue is not on the PATH"));
    EXPECT_EQ(unknown->text, "0 of 12 done, queue unknown: squeue is not on the PATH");
    EXPECT_TRUE(unknown->active) << "for all that is known";
}

TEST(FarmReport, WhatIsNoReportIsNone) {
    for (const std::string& text :
         {std::string(), std::string("astrosplat: a.toml: cannot be read"), std::string("{}"),
          std::string("{\"complete\": true}"), status_of(1, "x", false, "")})
        EXPECT_FALSE(read_farm_report(text)) << text;
}

TEST(FarmReport, JobsOfASubmission) {
    EXPECT_EQ(
        submitted_jobs("30 frames in 3 tasks submitted as job 218, which waits for the sets of job 217\n"
                       "scripts and logs in /a\n"),
        (std::vector<std::int64_t>{218, 217}));
    EXPECT_TRUE(submitted_jobs("no frame is missing: nothing to submit\n").empty());
    EXPECT_TRUE(submitted_jobs("submitted as job x, which waits for the sets of job 2").empty());
}

/// Polls until `done`, for ten seconds at most; so much of the asked one's own time goes by in a moment.
template <class Asked, class Done>
bool poll_until(Asked& asked, double& now, double step, const Done& done) {
    for (int i = 0; i < 2000 && !done(); ++i) {
        asked.poll(now += step);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return done();
}

class FarmJobTest : public testing::Test {
  protected:
    /// The program says `submitted`, then what lies in the file "status".
    FarmJob job(const std::string& submitted, int code = 0) {
        FarmCommands commands;
        commands.submit = {"/bin/sh", "-c", "echo '" + submitted + "'; exit " + std::to_string(code)};
        commands.status = {"/bin/cat", (folder_ / "status").string()};
        commands.pattern = "/frames/a.####.png";
        return FarmJob(commands);
    }
    void status(const std::string& text) { folder_.file("status", text); }
    template <class Done>
    bool comes(FarmJob& job, const Done& done) {
        return poll_until(job, now_, 1.0, done);
    }
    bool ends(FarmJob& job) {
        return comes(job, [&] { return job.state() != FarmJob::State::running; });
    }

    const std::string submitted_ =
        "9 frames in 3 tasks submitted as job 8, which waits for the sets of job 7";
    TempFolder folder_;
    double now_ = 0.0;
};

TEST_F(FarmJobTest, IsDoneWhenAllFramesAreThere) {
    status(status_of(3, "1-3", false, at_work));
    FarmJob farm = job(submitted_);
    ASSERT_TRUE(comes(farm, [&] { return farm.progress() > 0.0f; }));
    EXPECT_EQ(farm.progress(), 0.25f);
    EXPECT_EQ(farm.text(), "3 of 12 done, in the queue: 2 pending, 1 running");
    EXPECT_EQ(farm.files(),
              (std::vector<fs::path>{"/frames/a.0001.png", "/frames/a.0002.png", "/frames/a.0003.png"}));
    status("the disk is away");
    EXPECT_TRUE(comes(farm, [&] { return farm.text() == "the disk is away"; }));
    EXPECT_EQ(farm.state(), FarmJob::State::running);
    status(status_of(12, "1-12", true, over));
    ASSERT_TRUE(ends(farm));
    EXPECT_EQ(farm.state(), FarmJob::State::done);
    EXPECT_EQ(farm.files().size(), 12u);
}

TEST_F(FarmJobTest, FailsWhenTheQueueIsOverAndFramesAreMissing) {
    status(status_of(3, "1-3", false, over));
    FarmJob farm = job(submitted_);
    ASSERT_TRUE(ends(farm));
    EXPECT_EQ(farm.state(), FarmJob::State::failed);
    EXPECT_EQ(farm.text(), "9 of 12 frames are missing, and nothing is in the queue any more");
}

TEST_F(FarmJobTest, SaysWhyItWasNotSubmitted) {
    FarmJob farm = job("astrosplat: sbatch: error: invalid partition: x", 2);
    ASSERT_TRUE(ends(farm));
    EXPECT_EQ(farm.state(), FarmJob::State::failed);
    EXPECT_EQ(farm.text(), "sbatch: error: invalid partition: x");
}

/// The records beside the frames, read by a window that was not there when they were written.
class SubmittedFramesTest : public testing::Test {
  protected:
    void submitted(const std::string& number, std::vector<std::string> options,
                   std::vector<std::string> chunks) const {
        Submission one;
        one.folder = submissions_folder(pattern) / number;
        one.name = "astrosplat-m51";
        one.output = comparable_output(pattern);
        one.options = std::move(options);
        one.sets_job = 1;
        one.frames_job = 2;
        one.chunks = std::move(chunks);
        fs::create_directories(one.folder);
        write_submission(one);
    }
    std::vector<SubmittedFrames> found() const { return submitted_frames(submissions_of(pattern)); }

    const TempFolder folder;
    const std::string pattern = (folder / "frames/m51.####.exr").string();
};

TEST_F(SubmittedFramesTest, SubmissionsOfTheSameAreOne) {
    submitted("0001", {"/a.toml", "--output=" + pattern}, {"1-10", "11-20"});
    submitted("0002", {"/b.toml"}, {"3"});
    submitted("0003", {"/a.toml", "--output=" + pattern}, {"15-25"});
    ASSERT_EQ(found().size(), 2u);
    EXPECT_EQ(found()[0].options, (std::vector<std::string>{"/a.toml", "--output=" + pattern}));
    EXPECT_EQ(found()[0].frames, "1-25");
    EXPECT_EQ(found()[1].frames, "3");
}

TEST_F(SubmittedFramesTest, WhatCannotBeReadIsLeftOut) {
    EXPECT_TRUE(found().empty());
    submitted("0001", {"/a.toml"}, {"nonsense"});
    submitted("0002", {}, {"1"});
    EXPECT_TRUE(found().empty());
}

/// The program is asked, and what it tells is listed once, however often a scene is opened.
TEST(EarlierFarmJobs, AreThoseThatStatusTells) {
    const TempFolder folder;
    std::string answer = status_of(0, "", false, "");
    answer.insert(answer.rfind("]}"), R"(, {"options": ["/a.toml", "--resolution=8x8"], "frames": "1-3"})");
    const fs::path program =
        folder.file("program", "#!/bin/sh\necho \"$@\" >> '" + (folder / "asked").string() + "'\ncat '" +
                                   folder.file("answer", answer).string() + "'\n");
    fs::permissions(program, fs::perms::owner_all);
    const Document document = Document::open(
        folder.file("m51.toml",
                    "astrosplat = 1\n[output]\nframes = \"5-9\"\npath = \"m51.####.exr\"\n"
                    "[[layer]]\nname = \"a\"\n[layer.source]\nmeshes = [ { mesh = \"plane\" } ]\n"));
    RenderQueue queue(SetCache(), program.string());
    double now = 0.0;
    const auto wait_for = [&](std::ptrdiff_t asked) {
        EXPECT_TRUE(poll_until(queue, now, 0.001,
                               [&] { return std::ranges::count(text_of(folder / "asked"), '\n') >= asked; }));
        int more = 20;
        poll_until(queue, now, 0.001, [&] { return --more < 0; });
    };
    queue.list_earlier(document);
    wait_for(3);  // the question, and one about each of two jobs
    queue.list_earlier(document);
    wait_for(4);
    ASSERT_EQ(queue.jobs().size(), 2u);
    EXPECT_EQ(queue.jobs()[0].title, "m51.toml: Frames 1-12, Slurm");
    EXPECT_EQ(queue.jobs()[1].title, "m51.toml: Frames 1-3, Slurm");
    EXPECT_EQ(queue.jobs()[1].state, QueuedJob::State::submitted);
    EXPECT_EQ(text_of(folder / "asked").find("status " + document.file().string() + " --json --frames=5 "),
              0u)
        << text_of(folder / "asked");
}

TEST(RenderQueue, JobsTakeNoMoreOfTheMachineThanTheWindow) {
    const TempFolder folder;
    const fs::path program =
        folder.file("program", "#!/bin/sh\necho \"$@ \" >> '" + (folder / "asked").string() + "'\n");
    fs::permissions(program, fs::perms::owner_all);
    const Document document = Document::open(folder.file("m51.toml", "astrosplat = 1\n"));
    RenderQueue queue(SetCache(), program.string(), {.threads = 4, .memory_gib = 8});
    RenderTask task = make_render_task(document, RenderKind::frame, 1.0);
    task.name = "one.exr";
    queue.add(task, document);
    SourceParams source;
    source.meshes = {{"plane", {folder / "m51.png"}}};
    queue.add_preparation(source, folder / "prepared");
    const auto ended = [&] {
        return std::ranges::none_of(queue.jobs(), [](const QueuedJob& job) {
            return job.state == QueuedJob::State::waiting || job.state == QueuedJob::State::running;
        });
    };
    double now = 0.0;
    EXPECT_TRUE(poll_until(queue, now, 0.001, ended));
    const std::string asked = text_of(folder / "asked"), render = asked.substr(0, asked.find('\n')),
                      prepare = asked.substr(render.size() + 1);
    EXPECT_HAS(render, " --threads=4 --memory=8 ") << asked;
    EXPECT_HAS(prepare, " --threads=4 ") << asked;
    EXPECT_EQ(prepare.find("--memory"), std::string::npos) << asked;
}

}  // namespace
}  // namespace astrosplat
