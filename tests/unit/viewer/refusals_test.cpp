// What cannot be done says why: failed pictures and layers in the message line, refused jobs by an error, and
// nothing of them stays on the disk.
#include <gtest/gtest.h>

#include <filesystem>

#include "core/error.h"
#include "support/temp_folder.h"
#include "support/variable.h"
#include "viewer/render_queue.h"
#include "viewer/session_parts.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

TEST(Refusals, AFailedPictureAndLayerAreSaidOnce) {
    Status status;
    std::set<std::string> said;
    status.layers.resize(2);
    say_new_errors(status, said);
    EXPECT_TRUE(status.log.empty());
    status.view_frame.state = ViewFrameState::failed;
    status.view_frame.error = "s.toml: camera.fov: expected an angle, found 0";
    say_new_errors(status, said);
    ASSERT_EQ(status.log.size(), 1u);
    EXPECT_TRUE(status.message.error);
    EXPECT_EQ(status.message.text, status.view_frame.error);
    status.layers[1].error = "a.png: expected a picture, found none";
    say_new_errors(status, said);
    say_new_errors(status, said);
    ASSERT_EQ(status.log.size(), 2u);
    EXPECT_EQ(status.message.text, status.layers[1].error);
    status.view_frame.state = ViewFrameState::preview;
    say_new_errors(status, said);
    status.view_frame.state = ViewFrameState::failed;
    say_new_errors(status, said);
    EXPECT_EQ(status.log.size(), 3u) << "it has failed again";
}

TEST(Refusals, MessagesGoAndErrorsStay) {
    Status status;
    MessageAge age;
    const auto seen_at = [&](double now) {
        forget_old_message(status, age, now);
        return status.message.text;
    };
    EXPECT_EQ(seen_at(0.0), "");
    say(status, "Saved a.toml");
    EXPECT_EQ(seen_at(100.0), "Saved a.toml");
    EXPECT_EQ(seen_at(111.0), "Saved a.toml");
    say(status, "Saved a.toml");
    EXPECT_EQ(seen_at(113.0), "Saved a.toml") << "it was said again";
    EXPECT_EQ(seen_at(124.0), "Saved a.toml");
    EXPECT_EQ(seen_at(126.0), "");
    EXPECT_EQ(status.log.size(), 2u) << "the log keeps them";
    say(status, "a.toml: expected a number, found none", true);
    seen_at(130.0);
    EXPECT_EQ(seen_at(1e6), "a.toml: expected a number, found none");
}

TEST(Refusals, AJobThatIsRefusedLeavesNoFolder) {
    const TempFolder folder;
    const fs::path temporary = folder / "temporary";
    fs::create_directory(temporary);
    const fs::path preset = folder.file("look.toml", "astrosplat = 1\n[look]\ndensity = 0.5\n");
    const std::string scene =
        "astrosplat = 1\n[[layer]]\nname = \"a\"\npreset = \"look.toml\"\n"
        "[layer.source]\nmeshes = [ { mesh = \"plane\", texture = \"a.png\" } ]\n";
    const Document document = Document::open(folder.file("scene.toml", scene));
    fs::remove(preset);  // without it the scene cannot be written
    const Variable place("TMPDIR", temporary.c_str());
    RenderQueue jobs(SetCache{}, "astrosplat");
    EXPECT_THROW(jobs.add(make_render_task(document, RenderKind::range, 1.0), document), InputError);
    EXPECT_TRUE(jobs.jobs().empty());
    EXPECT_TRUE(fs::is_empty(temporary));
}

TEST(Refusals, AJobThatWaitsLeavesNothingBehind) {
    const TempFolder folder;
    const fs::path temporary = folder / "tmp";
    fs::create_directories(temporary);
    const Variable place("TMPDIR", temporary.c_str());
    const Document document =
        Document::open(folder.file("scene.toml",
                                   "astrosplat = 1\n[[layer]]\nname = \"a\"\n[layer.source]\n"
                                   "meshes = [ { mesh = \"plane\", texture = \"a.png\" } ]\n"));
    RenderQueue jobs(SetCache{}, "astrosplat");
    jobs.add(make_render_task(document, RenderKind::range, 1.0), document);
    EXPECT_FALSE(fs::is_empty(temporary)) << "the scene as it is now";
    jobs.cancel(1);
    EXPECT_TRUE(fs::is_empty(temporary));
    EXPECT_EQ(jobs.jobs()[0].state, QueuedJob::State::cancelled);
    jobs.remove(1);
    EXPECT_TRUE(jobs.jobs().empty());
    {
        RenderQueue dropped(SetCache{}, "astrosplat");
        dropped.add(make_render_task(document, RenderKind::range, 1.0), document);
    }
    EXPECT_TRUE(fs::is_empty(temporary));
}

}  // namespace
}  // namespace astrosplat
