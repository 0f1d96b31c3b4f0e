// --resume: frames of this hash stay, missing and damaged ones come, others stop the run before its first
// frame.
#include <sys/stat.h>

#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

class Resume : public SceneTest {
  protected:
    /// Changes whenever the file is replaced.
    ino_t identity(int frame) const {
        struct stat status = {};
        EXPECT_EQ(stat(frame_path(frame).c_str(), &status), 0);
        return status.st_ino;
    }
    fs::path frame_path(int frame) const { return folder / fmt::format("frames/shot.{:04}.exr", frame); }
    /// Hard links keep the old files alive, so that their numbers are not given out again.
    void keep_old_files() {
        fs::create_directories(folder / "old");
        for (const std::string& name : names_in("frames"))
            fs::create_hard_link(folder / "frames" / name, folder / "old" / name);
    }
};

TEST_F(Resume, KeepsWhatIsThereAndRendersWhatIsMissing) {
    ASSERT_EQ(batch({"-f", "1,3"}).code, 0);
    keep_old_files();
    const ino_t one = identity(1), three = identity(3);
    const RunResult result = batch({"--resume"});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(identity(1), one);
    EXPECT_EQ(identity(3), three);
    EXPECT_TRUE(fs::exists(frame_path(2)));
    EXPECT_EQ(batch({"--resume"}).code, 0) << "nothing to do is a success";
}

TEST_F(Resume, RendersDamagedFramesAgain) {
    ASSERT_EQ(batch({"--set", "output.compression=none"}).code, 0);
    const std::string whole = text_of(frame_path(2));
    write_text(frame_path(2), whole.substr(0, whole.size() / 2));
    write_text(frame_path(3), "");
    const RunResult result = batch({"--resume", "--set", "output.compression=none"});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.err.find("shot.0002.exr: damaged"), std::string::npos) << result.err;
    EXPECT_EQ(text_of(frame_path(2)), whole);
    EXPECT_GT(text_of(frame_path(3)).size(), 100u);
}

TEST_F(Resume, StopsBeforeTheFirstFrameAtFramesOfOtherSettings) {
    ASSERT_EQ(batch({"-f", "2"}).code, 0);
    const std::string before = text_of(frame_path(2));
    expect_one_line(batch({"--resume", "--set", "layer.stars.render.opacity=0.5"}), 2, "shot.0002.exr");
    EXPECT_EQ(names_in("frames").size(), 1u);
    EXPECT_EQ(text_of(frame_path(2)), before);
}

TEST_F(Resume, WithOverwriteReplacesExactlyTheOthers) {
    write_scene(
        "\"layer.stars.render.opacity\" = { keys = [[1, 1.0], [3, 1.0]], interpolation = \"step\" }\n");
    ASSERT_EQ(batch().code, 0);
    keep_old_files();
    const ino_t one = identity(1), two = identity(2), three = identity(3);
    write_scene(
        "\"layer.stars.render.opacity\" = { keys = [[1, 1.0], [3, 0.25]], interpolation = \"step\" }\n");
    EXPECT_EQ(batch({"--resume"}).code, 2);
    EXPECT_EQ(batch({"--resume", "--overwrite"}).code, 0);
    EXPECT_EQ(identity(1), one) << "a key at frame 3 does not redo frame 1";
    EXPECT_EQ(identity(2), two);
    EXPECT_NE(identity(3), three);
}

TEST_F(Resume, WhatDoesNotReachThePixelsDoesNotCount) {
    ASSERT_EQ(batch().code, 0);
    keep_old_files();
    const ino_t one = identity(1);
    const RunResult result =
        batch({"--resume", "--set", "output.fps=30", "--set", "provenance.title=Whirlpool", "-t", "1",
               "--set", "output.compression=piz", "-f", "1-4"});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(identity(1), one);
}

TEST_F(Resume, NoticesChangedInputs) {
    ASSERT_EQ(batch({"-f", "1"}).code, 0);
    write_text(folder / "stars.pda", cube_of_splats(299));
    EXPECT_EQ(batch({"-f", "1", "--resume"}).code, 2);
    write_text(folder / "stars.pda", cube_of_splats(300));
    EXPECT_EQ(batch({"-f", "1", "--resume"}).code, 0);
}

TEST_F(Resume, ForeignPicturesAreNeverReplacedUnasked) {
    ASSERT_EQ(batch({"-f", "1", "-o", "f.####.png", "--region", "0,0,32,24"}).code, 0);
    EXPECT_EQ(batch({"-f", "1", "-o", "f.####.png", "--resume"}).code, 2)
        << "another region is another frame";
}

}  // namespace
}  // namespace astrosplat::test
