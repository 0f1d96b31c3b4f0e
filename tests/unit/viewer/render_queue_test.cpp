// Jobs of the window: how far one is by the lines that it says, and what one that is refused or waits leaves
// on the disk.
#include "viewer/render_queue.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/error.h"
#include "support/temp_folder.h"
#include "support/variable.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

TEST(RenderingLine, SaysTheShareOfAllFrames) {
    EXPECT_EQ(share_of_line("astrosplat: preparing 50% eta 00:00:02"), 0.5f);
    EXPECT_EQ(share_of_line("astrosplat: frame 12 (3/10) 50% eta 00:04:10"), 0.25f);
    EXPECT_EQ(share_of_line("astrosplat: frame 12 (10/10) 100% eta 00:00:00"), 1.0f);
    for (const char* other : {"", "saved a.0001.exr", "37% of nothing", "about x% more", "37%"})
        EXPECT_FALSE(share_of_line(other)) << other;
}

TEST(RenderQueue, AJobThatIsRefusedLeavesNoFolder) {
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

TEST(RenderQueue, AJobThatWaitsLeavesNothingBehind) {
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
