// Questions about unsaved changes, recoveries and conflicts, snapshots; the dialog that renders to files, and
// the queue.
#include "gui/parts.h"
#include "gui/test_window.h"
#include "gui/widgets.h"
#include "support/test.h"

namespace astrosplat {
namespace {

using Kind = Command::Kind;

class QuitTest : public ExampleWindow {};

TEST_F(QuitTest, AsksOnlyAboutUnsavedChanges) {
    window.tap('Q', true);
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::quit});
    make_edited(window);
    window.gui.ask_to_quit();
    window.frame(2);
    EXPECT_TRUE(window.take_commands().empty());
    window.click("unsaved/Cancel");
    EXPECT_TRUE(window.take_commands().empty());
    EXPECT_FALSE(window.has("unsaved/Cancel"));
    window.tap('Q', true);
    window.click("unsaved/Don't save");
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::quit});
}

TEST(QuitOfAnother, SavesFirstAndLeavesOnlyWhenThatWorked) {
    const TempFolder folder;
    const auto file = folder.file("a.toml", example_document().text_for(folder / "a.toml"));
    TestWindow window(Document::open(file));
    window.document.edit("Fps", [](Scene& scene) { scene.output.fps = 30; });
    window.tap('Q', true);
    window.click("unsaved/Save");
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::save}) << "the save failed: it stays";
    window.frame(5);
    EXPECT_TRUE(window.take_commands().empty());
    window.tap('Q', true);
    window.hover(window.at("unsaved/Save"));
    window.press();
    window.release();
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::save});
    window.document.save();
    window.frame();
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::quit});
}

TEST_F(QuitTest, AnUntitledSceneIsAskedForItsFile) {
    const TempFolder folder;
    make_edited(window);
    window.tap('Q', true);
    window.tap(key_code::enter);  // Save
    ASSERT_TRUE(window.has("file/path"));
    window.tap('A', true);
    window.type((folder.path() / "new.toml").string());
    window.click("file/Save");
    EXPECT_EQ(window.take_only(Kind::save_as).path, folder.path() / "new.toml");
}

TEST_F(QuitTest, ADroppedSceneAsksToo) {
    window.dropped = {{Kind::open, "/scenes/m51.toml", {}, 0}};
    window.frame();
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::open});
    make_edited(window);
    window.dropped = {{Kind::open, "/scenes/m51.toml", {}, 0}};
    window.frame(2);
    EXPECT_TRUE(window.take_commands().empty());
    window.click("unsaved/Don't save");
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::open});
}

TEST(Recovery, OffersTheAutosaveOnce) {
    TestWindow window(example_document());
    window.status.recoveries = {{"/state/whirlpool.toml", "whirlpool.toml", "2026-04-12 18:03:10 UTC"}};
    window.frame(2);
    window.click("recovery/Recover");
    EXPECT_EQ(window.take_only(Kind::recover).path, "/state/whirlpool.toml");
    window.frame(3);
    EXPECT_FALSE(window.has("recovery/Recover"));
}

TEST(ChangedOnDisk, ReloadsOrKeeps) {
    TestWindow window(example_document());
    window.status.changed_on_disk = true;
    window.frame(2);
    window.click("notice/Reload");
    window.click("notice/Keep");
    EXPECT_EQ(kinds(window.take_commands()), (std::vector<Kind>{Kind::reload, Kind::keep}));
    window.status.changed_on_disk = false;
    window.frame(2);
    EXPECT_FALSE(window.has("notice/Keep"));
}

/// A scene with an unsaved edit, whose file another program has written since.
class SaveConflict : public testing::Test {
  protected:
    TempFolder folder;
    fs::path file = folder.file("a.toml", example_document().text_for(folder / "a.toml"));
    TestWindow window{Document::open(file)};

    SaveConflict() {
        window.document.edit("Fps", [](Scene& scene) { scene.output.fps = 30; });
        write("# of another\n");
    }
    void write(const std::string& comment) {
        folder.file("a.toml", comment + example_document().text_for(file));
    }
    std::vector<Kind> commands_after_frames() {
        window.frame(2);
        return kinds(window.take_commands());
    }
    void save() { window.tap('S', true); }
};

TEST_F(SaveConflict, IsAskedAbout) {
    EXPECT_FALSE(window.gui.busy());
    save();
    EXPECT_TRUE(commands_after_frames().empty());
    EXPECT_TRUE(window.gui.busy());
    window.click("conflict/Cancel");
    EXPECT_TRUE(commands_after_frames().empty());
    EXPECT_FALSE(window.has("conflict/Cancel"));
    EXPECT_FALSE(window.gui.busy());
    save();
    window.click("conflict/Overwrite");
    EXPECT_EQ(commands_after_frames(), std::vector<Kind>{Kind::save});
    window.document.save();
    window.document.edit("Fps", [](Scene& scene) { scene.output.fps = 31; });
    save();
    EXPECT_EQ(commands_after_frames(), std::vector<Kind>{Kind::save}) << "no one else wrote since";
}

TEST_F(SaveConflict, GoesElsewhereByDefault) {
    save();
    window.tap(key_code::enter);
    ASSERT_TRUE(window.has("file/path"));
    window.tap('A', true);
    window.type((folder / "b.toml").string());
    window.click("file/Save");
    EXPECT_EQ(window.take_only(Kind::save_as).path, folder / "b.toml");
}

TEST_F(SaveConflict, IsDecidedByKeepUntilTheNextChange) {
    window.document.ignore_change_on_disk();
    save();
    EXPECT_EQ(commands_after_frames(), std::vector<Kind>{Kind::save});
    write("# again, of another\n");
    save();
    EXPECT_TRUE(commands_after_frames().empty());
    EXPECT_TRUE(window.has("conflict/Overwrite"));
}

TEST_F(SaveConflict, HoldsUpLeaving) {
    window.tap('Q', true);
    window.click("unsaved/Save");
    window.frame(5);
    EXPECT_TRUE(window.take_commands().empty());
    window.hover(window.at("conflict/Overwrite"));
    window.press();
    window.release();
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::save});
    window.document.save();
    EXPECT_EQ(commands_after_frames(), std::vector<Kind>{Kind::quit});
}

TEST_F(SaveConflict, CancelledStays) {
    window.tap('Q', true);
    window.click("unsaved/Save");
    window.click("conflict/Cancel");
    EXPECT_TRUE(commands_after_frames().empty());
    window.document.save();
    EXPECT_TRUE(commands_after_frames().empty()) << "leaving was given up with the question";
}

TEST(FirstStart, TheHintIsDismissed) {
    TestWindow window(example_document());
    window.view.hint_open = true;
    window.frame(2);
    window.click("close hint");
    EXPECT_FALSE(window.view.hint_open);
}

class SnapshotsTest : public ExampleWindow {};

TEST_F(SnapshotsTest, BecomeBAndAreTaken) {
    window.view.snapshots_open = true;
    window.status.snapshots = {{"One", nullptr, 1.78f, 100, 0.5}, {"Two", nullptr, 1.78f, 100, 0}};
    window.frame(2);
    window.click("snapshot 1");
    window.click("take snapshot");
    const Commands commands = window.take_commands();
    ASSERT_EQ(kinds(commands), (std::vector<Kind>{Kind::compare_snapshot, Kind::take_snapshot}));
    EXPECT_EQ(commands[0].index, 1U);
    window.click(window.at("snapshot 0"), 1);
    window.click("snapshot/Restore");
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::restore_snapshot});
}

TEST_F(SnapshotsTest, StandUpright) {
    Picture8 thumbnail(8, 4);
    for (int x = 0; x < 8; ++x) thumbnail.at(x, 0) = thumbnail.at(x, 1) = {255, 0, 0, 255};
    window.view.snapshots_open = true;
    window.status.snapshots = {{"One", &thumbnail, 2.0f, 100, 0.5}};
    window.frame(2);
    const glm::vec2 card = window.at("snapshot 0");
    const Picture8 picture = window.picture();
    const auto red = [&](float below) { return picture.at(int(card.x), int(card.y + below)).r; };
    EXPECT_EQ(red(-42.0f), 255) << "its first row is at the top";
    EXPECT_EQ(red(6.0f), 0);
}

TEST_F(SnapshotsTest, AreRenamedInTheirCard) {
    window.view.snapshots_open = true;
    window.status.snapshots = {{"One", nullptr, 1.78f, 100, 0.5}, {"Two", nullptr, 1.78f, 100, 0}};
    window.frame(2);
    const auto begin_renaming = [&] {
        window.click(window.at("snapshot 1"), 1);
        window.click("snapshot/Rename");
    };
    begin_renaming();
    window.type("Kälter");
    window.tap(key_code::enter);
    const Command renamed = window.take_only(Kind::rename_snapshot);
    EXPECT_EQ(renamed.text, "Kälter");
    EXPECT_EQ(renamed.index, 1U);
    EXPECT_FALSE(window.has("snapshot name"));
    begin_renaming();
    window.type("x");
    window.tap(key_code::escape);
    EXPECT_FALSE(window.has("snapshot name"));
    EXPECT_TRUE(window.take_commands().empty()) << "Escape drops what was typed";
}

// The dialog that renders to files, and the queue.

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

TEST_F(RenderDialogTest, BeginsWithWhatWasLastRenderedOfTheScene) {
    window.type_into("render/frames", "3-9");
    keep_render(window.view.renders, window.document, window.view.render);
    window.tap(key_code::escape);
    window.tap(key_code::escape);
    window.choose("Render/Frames...");
    EXPECT_EQ(window.view.render.frames, "3-9");
    window.click("render/Movie");
    window.click("render/Frames");
    EXPECT_EQ(window.view.render.frames, "3-9");
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
    window.status.render_estimate = "About 00:01:36 and 744 MB in all; 12 of 240 frames are there already";
    window.frame();
    EXPECT_FALSE(window.has("render/Copy")) << "it is folded away";
    window.keep_screen("render_dialog");
    window.click("render/command");
    window.frame(2);
    window.keep_screen("render_command");
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

TEST(Queue, AJobThatFailedSaysWhyAndIsTriedAgain) {
    QueueWindow window;
    EXPECT_FALSE(window.has("queue/Try again"));
    window.status.jobs[0].state = QueuedJob::State::failed;
    window.status.jobs[0].text = "frame 3: /films/two/a.0003.png: cannot be written: No space left on device";
    window.status.jobs[1].state = QueuedJob::State::waiting;
    window.status.jobs[1].held_by = 1;
    window.click("queue/job 1");
    window.keep_screen("failed_job");
    window.click("queue/Try again");
    EXPECT_EQ(window.take_only(Kind::retry_job).index, 1u);
}

TEST(Queue, AMoviePlaysInTheView) {
    QueueWindow window;
    EXPECT_FALSE(window.has("queue/Play movie"));
    QueuedJob& job = window.status.jobs[1];
    job.is_movie = true;
    job.target = "/films/two/a.mp4";
    const auto play = [&] {
        window.view.queue_open = true;
        window.frame(3);
        window.click("queue/Play movie");
        EXPECT_EQ(window.view.movie, "/films/two/a.mp4");
        EXPECT_FALSE(window.view.queue_open);
        window.status.played_movie = "a.mp4";
        window.frame(3);
    };
    window.frame(3);
    window.keep_screen("movie_job");
    play();
    window.keep_screen("movie_plays");
    const FreeCamera before = window.view.free;
    window.drag(window.at("frame in view"), {80.0f, 0.0f});
    EXPECT_TRUE(window.view.movie.empty());
    EXPECT_EQ(window.view.free, before);
    play();
    window.tap(key_code::escape);
    EXPECT_TRUE(window.view.movie.empty());
}

TEST(Queue, ShowsTheChosenJobInItsFolder) {
    QueueWindow window;
    window.click("queue/Show in folder");
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
