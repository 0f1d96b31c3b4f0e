// A farm in the window's queue. Slurm's tools are stand-ins, which keep what they were called with; the
// program that is asked to submit and to tell how it goes is the real one.
#include <set>

#include "gui/key_codes.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

class WindowFarm : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        tool("sbatch", R"sh(here=${0%/*}; n=1; [ -e "$here/jobs" ] && n=$(( $(<"$here/jobs") + 1 ))
echo $n > "$here/jobs"; echo "$@" >> "$here/submitted"
while read -r line; do [[ $line == "#SBATCH --job-name="* ]] && name=${line#*=}; done < "${@: -1}"
task=N/A; [[ ${@: -1} == frames.sh ]] && task=0
echo "$n $task PENDING $name" >> "$here/queue"; echo $n
)sh");
        tool("squeue", "[ -e \"${0%/*}/queue\" ] && echo \"$(<\"${0%/*}/queue\")\"; exit 0\n");
        tool("scancel", "echo \"$@\" >> \"${0%/*}/cancelled\"; : > \"${0%/*}/queue\"\n");
        std::string text = text_of(scene_file);
        text.replace(text.find("1-24"), 4, "1-3");
        write_text(scene_file, text);
    }
    /// Where the program finds it.
    void tool(const std::string& name, const std::string& script) {
        fs::create_directories(folder / "no programs");
        write_text(folder / "no programs" / name, "#!/bin/bash\n" + script);
        fs::permissions(folder / "no programs" / name, fs::perms::owner_all);
    }
    std::string told(const std::string& file) const {
        const fs::path path = folder / "no programs" / file;
        return fs::exists(path) ? text_of(path) : "";
    }
    /// By the render dialog, with another exposure than the saved scene has.
    void submit() {
        start({scene_file.string()});
        settled_frame();
        same_widgets().status.has_slurm = true;
        same_widgets().frame();
        choose("Render/Frames...");
        same_widgets().frame(2);
        for (const char* button : {"render/Slurm", "render/Submit"}) {
            const glm::vec2 at = same_widgets().at(button);
            same_widgets().click(at);
            same_widgets().frame(2);
            person->click(at);
        }
        same_widgets().take_commands();
        ASSERT_TRUE(comes_true([&] { return told("jobs") == "2\n"; })) << program->err_so_far();
    }
    /// Renders what was submitted as a node of the farm would, and empties the queue.
    void work() {
        const fs::path script = folder / "frames/slurm/0001/frames.sh";
        ASSERT_TRUE(comes_true([&] { return fs::exists(script.parent_path() / "submission.json"); }));
        RunOptions node;
        node.environment = {"SLURM_ARRAY_TASK_ID=0"};
        const RunResult result = run_program({"/bin/bash", script.string()}, node);
        ASSERT_EQ(result.code, 0) << result.err;
        write_text(folder / "no programs/queue", "");
    }
    /// The queue's dialog with the job in this state.
    void open_queue(QueuedJob::State state, std::vector<fs::path> files) {
        QueuedJob job = running_job_of("", 0.0f);
        job.state = state;
        job.files = std::move(files);
        same_widgets().status.jobs = {job};
        same_widgets().frame();
        choose("Render/Queue...");
        same_widgets().frame(2);
    }
};

TEST_F(WindowFarm, FramesAreSubmittedAndComeBack) {
    submit();
    EXPECT_NE(told("submitted").find("--dependency=afterok:1 frames.sh\n"), std::string::npos);
    work();
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder / "frames"))
        names.insert(entry.path().filename().string());
    EXPECT_EQ(names, (std::set<std::string>{"shot.0001.png", "shot.0002.png", "shot.0003.png", "slurm"}));
    ASSERT_EQ(run({"--batch", scene_file.string(), "-q", "-f", "2", "-o", "here.png", "--no-cache"}).code, 0);
    EXPECT_EQ(text_of(folder / "frames/shot.0002.png"), text_of(folder / "here.png"));
    open_queue(QueuedJob::State::done, {"a", "b", "c"});
    click_when_shown("queue/play");  // there is none before frames are
}

TEST_F(WindowFarm, CancelTakesTheTasksOutOfTheQueue) {
    submit();
    open_queue(QueuedJob::State::submitted, {});
    click_when_shown("queue/end 1");
    EXPECT_TRUE(comes_true([&] { return told("cancelled") == "2 1\n"; })) << told("cancelled");
    EXPECT_TRUE(running());
}

/// Where it can be cancelled; and what has come back meanwhile is there to be looked at.
TEST_F(WindowFarm, WhatWasSubmittedIsListedByTheNextWindow) {
    submit();
    const fs::path record = folder / "frames/slurm/0001/submission.json";
    ASSERT_TRUE(comes_true([&] { return fs::exists(record); }));
    const auto again = [&] {
        person->press("ctrl+q");
        EXPECT_EQ(end().code, 0);
        start({scene_file.string()});
    };
    again();
    open_queue(QueuedJob::State::submitted, {});
    click_when_shown("queue/end 1");
    EXPECT_TRUE(comes_true([&] { return told("cancelled") == "1 2\n"; })) << told("cancelled");
    work();
    person->press("Escape");
    same_widgets().tap(key_code::escape);
    again();
    open_queue(QueuedJob::State::done, {"a", "b", "c"});
    click_when_shown("queue/play");
    EXPECT_EQ(told("jobs"), "2\n") << "nothing is submitted again";
}

TEST_F(WindowFarm, WhatWasSubmittedOutlivesTheWindow) {
    submit();
    ASSERT_TRUE(comes_true([&] { return fs::exists(folder / "frames/slurm/0001/submission.json"); }));
    person->press("ctrl+q");
    EXPECT_EQ(end().code, 0);
    EXPECT_EQ(told("cancelled"), "");
    work();
    EXPECT_TRUE(fs::exists(folder / "frames/shot.0003.png"));
}

}  // namespace
}  // namespace astrosplat::test
