// Changes of files in use, and which files a scene uses.
#include "edit/disk_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "scene/layer_setup.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;

class WatchedFilesTest : public testing::Test {
  protected:
    TempFolder folder;
    fs::path a = folder.file("a ü.png", "a"), b = folder.file("b.png", "b");
    WatchedFiles watched;

    WatchedFilesTest() { watched.watch({a, b, folder / "missing.png", a}); }
    /// As if written this many seconds from now, whatever the file system's clock can tell apart.
    void date(const fs::path& file, int seconds) {
        fs::last_write_time(file, fs::last_write_time(file) + std::chrono::seconds(seconds));
    }
};

TEST_F(WatchedFilesTest, AChangeIsToldOnceItRests) {
    EXPECT_EQ(watched.changed(), Paths{});
    date(a, 5);
    EXPECT_EQ(watched.changed(), Paths{}) << "it may still be written";
    date(a, 5);
    EXPECT_EQ(watched.changed(), Paths{});
    EXPECT_EQ(watched.changed(), Paths{a});
    EXPECT_EQ(watched.changed(), Paths{});
    folder.file("b.png", "longer");
    watched.changed();
    EXPECT_EQ(watched.changed(), Paths{b});
}

TEST_F(WatchedFilesTest, AFileThatIsGoneIsWaitedFor) {
    const std::string name = "a ü.png";
    fs::remove(a);
    EXPECT_EQ(watched.changed(), Paths{});
    EXPECT_EQ(watched.changed(), Paths{});
    folder.file(name, "another");
    watched.changed();
    EXPECT_EQ(watched.changed(), Paths{a});
}

TEST_F(WatchedFilesTest, AMissingFileAppears) {
    const fs::path file = folder.file("missing.png", "here");
    watched.changed();
    EXPECT_EQ(watched.changed(), Paths{file});
}

TEST_F(WatchedFilesTest, WatchingAgainForgetsNothing) {
    date(a, 5);
    date(b, 5);
    watched.watch({a});
    watched.changed();
    EXPECT_EQ(watched.changed(), Paths{a});
    watched.watch({a, b});
    watched.changed();
    EXPECT_EQ(watched.changed(), Paths{}) << "b was changed while nobody watched it";
}

TEST_F(WatchedFilesTest, FilesOfAScene) {
    Scene scene;
    SourceParams source;
    source.meshes = {{"plane", {a}, 0.15}, {folder / "m.obj", {}, 0.15}};
    source.kind = SourceKind::stars;
    EXPECT_EQ(named_files(source), Paths{});
    source.stars.catalogue = folder / "m.obj";
    EXPECT_EQ(named_files(source), Paths{folder / "m.obj"});
    source.kind = SourceKind::mesh;
    EXPECT_EQ(named_files(source), (Paths{a, folder / "m.obj"}));
    folder.file("m.obj", "mtllib m.mtl\nv 0 0 0\n");
    folder.file("m.mtl", "newmtl one\nmap_Kd b.png\n");
    Paths all = all_files(source);
    std::sort(all.begin(), all.end());
    EXPECT_EQ(all, (Paths{a, b, folder / "m.mtl", folder / "m.obj"}));
    source.kind = SourceKind::splats;
    source.file = folder / "stars.pda";
    EXPECT_EQ(all_files(source), Paths{folder / "stars.pda"});

    scene.layers.resize(2);
    scene.layers[1].look.thickness.map = a;
    scene.environment.cube = {b};
    EXPECT_EQ(picture_files(scene), (Paths{b, a}));
}

}  // namespace
}  // namespace astrosplat
