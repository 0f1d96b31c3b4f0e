// Snapshots in the folder beside their scene: what is written is read again, and nothing is lost where one of
// them is broken.
#include "edit/snapshots.h"

#include <gtest/gtest.h>

#include "scenes.h"
#include "support/run_program.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

struct SnapshotFiles : testing::Test {
    test::SceneFolder f;
    Document document = Document::open(f.file);
    fs::path folder = snapshot_folder(f.file);
    const SnapshotFacts facts{"Wärmer \"rot\"", 12.5, 3100000, 1.75};
    std::vector<std::string> problems;

    fs::path write(const SnapshotFacts& about) const {
        return write_snapshot(folder, about, document.scene(), "png");
    }
};

TEST_F(SnapshotFiles, WhatIsWrittenIsReadAgain) {
    document.set(test::opacity, 0.25, 1.0);
    const fs::path file = write(facts);
    EXPECT_EQ(file, folder / "0001.toml");
    const std::vector<KeptSnapshot> kept = read_snapshots(folder, problems);
    ASSERT_EQ(kept.size(), 1u);
    EXPECT_TRUE(problems.empty());
    EXPECT_EQ(kept[0].file, file);
    EXPECT_EQ(kept[0].facts, facts);
    EXPECT_EQ(with_look_of(load_scene(f.file), kept[0].scene), document.scene());
    EXPECT_EQ(test::text_of(snapshot_picture(file)), "png");
}

TEST_F(SnapshotFiles, ASnapshotIsASceneThatNamesTheSameFiles) {
    const Scene kept = load_scene(write(facts));
    Scene expected = document.scene();
    expected.file = kept.file;
    EXPECT_EQ(kept, expected);
}

TEST_F(SnapshotFiles, ANewOneComesAfterTheLastAndOverwritesNone) {
    write(facts);
    const fs::path second = write({"zwei"});
    write({"drei"});
    remove_snapshot(second);
    EXPECT_FALSE(fs::exists(snapshot_picture(second)));
    EXPECT_EQ(write({"vier"}), folder / "0004.toml");
    std::vector<std::string> names;
    for (const KeptSnapshot& kept : read_snapshots(folder, problems)) names.push_back(kept.facts.name);
    EXPECT_EQ(names, (std::vector<std::string>{facts.name, "drei", "vier"}));
}

TEST_F(SnapshotFiles, AnotherNameChangesNothingElse) {
    const fs::path file = write(facts);
    const Scene before = load_scene(file);
    rename_snapshot(file, "Kälter\nblau");
    const std::vector<KeptSnapshot> kept = read_snapshots(folder, problems);
    ASSERT_EQ(kept.size(), 1u);
    SnapshotFacts renamed = facts;
    renamed.name = "Kälter\nblau";
    EXPECT_EQ(kept[0].facts, renamed);
    EXPECT_EQ(kept[0].scene, before);
}

TEST_F(SnapshotFiles, ABrokenOneIsToldAndTheOthersAreThere) {
    write(facts);
    test::write_text(folder / "0002.toml", "astrosplat = 1\n");
    test::write_text(folder / "0003.toml", "# astrosplat snapshot {\"name\": \n");
    std::string text = test::text_of(folder / "0001.toml");
    text.insert(text.find("opacity"), "opacty = 1\n");
    test::write_text(folder / "0004.toml", text);
    test::write_text(folder / "notes.txt", "mine");
    EXPECT_EQ(read_snapshots(folder, problems).size(), 1u);
    ASSERT_EQ(problems.size(), 3u);
    EXPECT_EQ(problems[0], (folder / "0002.toml").string() + ":1: expected a snapshot, found another file");
    EXPECT_EQ(problems[1], (folder / "0003.toml").string() + ":1: expected a snapshot, found another file");
    EXPECT_NE(problems[2].find("opacty"), std::string::npos) << problems[2];
    EXPECT_TRUE(fs::exists(folder / "0003.toml")) << "nothing is thrown away";
}

TEST_F(SnapshotFiles, WhereNoFolderCanBeNothingIsWritten) {
    test::write_text(folder, "a file in its place");
    EXPECT_THROW(write(facts), OutputError);
    EXPECT_TRUE(read_snapshots(folder, problems).empty());
}

TEST_F(SnapshotFiles, AMissingOneIsAnError) {
    const fs::path file = write(facts);
    fs::remove(file);
    EXPECT_THROW(rename_snapshot(file, "x"), InputError);
    EXPECT_NO_THROW(remove_snapshot(file)) << "it is gone, as was wished";
}

}  // namespace
}  // namespace astrosplat
