// The dialog that renders to files, and the queue.
#include "gui/parts.h"

#include "gui/test_window.h"
#include "gui/widgets.h"
#include "support/test.h"

namespace astrosplat {
namespace {

using Kind = Command::Kind;

struct RenderWindow : TestWindow {
    RenderWindow() : TestWindow(example_document()) { choose("Render/Frames..."); }
    void type_into(const std::string& field, const std::string& text) {
        double_click(at(field));
        tap('A', true);
        type(text);
        frame();
    }
};

class RenderDialogTest : public testing::Test {
  protected:
    RenderWindow window;
};

TEST_F(RenderDialogTest, BeginsWithWhatTheSceneSays) {
    const OutputParams& output = window.document.scene().output;
    EXPECT_EQ(window.view.render.frames, output.frames);
    EXPECT_EQ(window.view.render.width, output.width);
    EXPECT_EQ(window.view.render.existing, ExistingFrames::resume);
    EXPECT_TRUE(window.view.render.folder.is_absolute());
    window.tap(key_code::enter);
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::render});
    EXPECT_FALSE(window.view.render_open);
}

TEST_F(RenderDialogTest, EveryRowCounts) {
    const RenderTask before = window.view.render;
    window.type_into("render/frames", "3-9");
    window.click("render/Half");
    window.type_into("render/name", "a.####.tif");
    window.type_into("render/folder", "/films/one");
    window.click("render/Render again");
    const RenderTask& task = window.view.render;
    EXPECT_EQ(task.frames, "3-9");
    EXPECT_EQ(task.width, before.width / 2);
    EXPECT_EQ(task.height, before.height / 2);
    EXPECT_EQ(render_target(task), "/films/one/a.####.tif");
    EXPECT_EQ(task.existing, ExistingFrames::replace);
    window.click("render/Movie");
    EXPECT_EQ(task.kind, RenderKind::movie);
    EXPECT_EQ(task.name.substr(task.name.size() - 4), ".mp4");
    EXPECT_EQ(task.width, before.width / 2) << "a kind keeps the size";
    window.click("render/Frame");
    EXPECT_EQ(task.frames, "1");
}

TEST_F(RenderDialogTest, WhatCannotBeRenderedIsNot) {
    window.type_into("render/name", "a.####.doc");
    window.click("render/Render");
    EXPECT_TRUE(window.take_commands().empty());
    EXPECT_TRUE(window.view.render_open);
    window.tap(key_code::escape);
    window.tap(key_code::escape);
    EXPECT_FALSE(window.view.render_open);
    EXPECT_TRUE(window.take_commands().empty());
}

TEST_F(RenderDialogTest, AFarmIsOfferedWhereThereIsOne) {
    EXPECT_FALSE(window.has("render/Slurm"));
    window.status.has_slurm = true;
    window.frame(2);
    ASSERT_TRUE(window.has("render/This machine"));
    EXPECT_FALSE(window.has("render/partition"));
    window.click("render/Slurm");
    EXPECT_FALSE(window.has("render/Render again")) << "finished frames always stay there";
    window.type_into("render/chunk", "25");
    window.type_into("render/partition", "long");
    window.keep_screen("slurm");
    const RenderTask& task = window.view.render;
    EXPECT_TRUE(renders_by_slurm(task));
    EXPECT_EQ(task.chunk, 25);
    EXPECT_EQ(task.partition, "long");
    window.click("render/Movie");
    EXPECT_FALSE(window.has("render/Slurm"));
    EXPECT_FALSE(renders_by_slurm(task));
    window.click("render/Frames");
    EXPECT_TRUE(renders_by_slurm(task)) << "a kind keeps the machine";
    window.type_into("render/chunk", "0");
    window.click("render/Submit");
    EXPECT_TRUE(window.view.render_open) << "a task without frames";
    window.type_into("render/chunk", "5");
    window.click("render/Submit");
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::render});
}

TEST_F(RenderDialogTest, TheCommandIsCopied) {
    window.status.render_command = "astrosplat --batch a.toml";
    window.frame();
    window.click("render/Copy");
    EXPECT_EQ(window.take_only(Kind::copy_text).text, "astrosplat --batch a.toml");
}

struct QueueWindow : TestWindow {
    QueueWindow() : TestWindow(example_document()) {
        status.jobs = {running_job_of("frame 3 (3/240)", 0.01f), running_job_of("", 0.0f)};
        status.jobs[0].files = {"/a/1.png", "/a/2.png", "/a/3.png"};
        status.jobs[1].number = 2;
        status.jobs[1].state = QueuedJob::State::done;
        status.jobs[1].target = "/films/two/a.####.png";
        view.queue_open = true;
        frame(3);
    }
};

TEST(Queue, JobsEndOrLeaveTheList) {
    QueueWindow window;
    window.click("queue/end 1");
    EXPECT_EQ(window.take_only(Kind::cancel_job).index, 1u);
    window.click("queue/end 2");
    EXPECT_EQ(window.take_only(Kind::remove_job).index, 2u);
}

TEST(Queue, AFarmsJobIsCancelledAndLeavesTheStatusBarAlone) {
    QueueWindow window;
    window.status.jobs = {running_job_of("3 of 12 done, in the queue: 2 running", 0.25f)};
    window.status.jobs[0].state = QueuedJob::State::submitted;
    window.frame(2);
    window.keep_screen("farm_queue");
    EXPECT_EQ(running_job(window.status), nullptr);
    EXPECT_FALSE(window.has("cancel job"));
    window.click("queue/end 1");
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::cancel_job});
}

TEST(Queue, FramesOfTheChosenJobAreFlippedThrough) {
    QueueWindow window;
    EXPECT_FALSE(window.has("queue/frame")) << "the last job has none";
    window.click("queue/job 1");
    EXPECT_EQ(window.view.queue_job, 1u);
    ASSERT_TRUE(window.has("queue/frame"));
    window.click("queue/play");
    EXPECT_TRUE(window.view.queue_playing);
    window.frame(14);
    EXPECT_GE(window.view.queue_frame, 0);
    window.click("queue/frame");  // its middle
    EXPECT_EQ(window.view.queue_frame, 1);
    EXPECT_FALSE(window.view.queue_playing);
    // The frame that is shown while it plays, too.
    window.document.edit("Rate", [](Scene& scene) { scene.output.fps = 1.2 / ImGui::GetTime(); });
    window.view.queue_playing = true;
    window.frame();
    ASSERT_EQ(window.view.queue_frame, 1);
    window.click("queue/frame");
    EXPECT_EQ(window.view.queue_frame, 1);
    EXPECT_FALSE(window.view.queue_playing);
}

TEST(Queue, OpensTheFolderOfTheChosenJob) {
    QueueWindow window;
    window.click("queue/Open folder");
    EXPECT_EQ(window.take_only(Kind::open_folder).path, "/films/two");
}

TEST(Queue, TheStatusBarLeadsThere) {
    TestWindow window(example_document());
    window.status.jobs = {running_job_of("frame 3 (3/240)", 0.01f)};
    window.frame();
    window.click("job");
    EXPECT_TRUE(window.view.queue_open);
}

TEST(Queue, TimesAreReadable) {
    EXPECT_EQ(duration_text(0.2), "0:01");
    EXPECT_EQ(duration_text(125.0), "2:05");
    EXPECT_EQ(duration_text(3725.0), "1:02:05");
}

}  // namespace
}  // namespace astrosplat
