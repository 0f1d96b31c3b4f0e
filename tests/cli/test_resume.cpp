// --resume and status: which frames stay.
#include <sys/stat.h>

#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

// --resume: frames of this hash stay, missing and damaged ones come, others stop the run before its first
// frame.

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
    expect_success(batch({"-f", "1,3"}));
    keep_old_files();
    const ino_t one = identity(1), three = identity(3);
    expect_success(batch({"--resume"}));
    EXPECT_EQ(identity(1), one);
    EXPECT_EQ(identity(3), three);
    EXPECT_TRUE(fs::exists(frame_path(2)));
    EXPECT_EQ(batch({"--resume"}).code, 0) << "nothing to do is a success";
}

TEST_F(Resume, RendersDamagedFramesAgain) {
    expect_success(batch({"--set", "output.compression=none"}));
    const std::string whole = text_of(frame_path(2));
    write_text(frame_path(2), whole.substr(0, whole.size() / 2));
    write_text(frame_path(3), "");
    const RunResult result = expect_success(batch({"--resume", "--set", "output.compression=none"}));
    EXPECT_HAS(result.err, "shot.0002.exr: damaged");
    EXPECT_EQ(text_of(frame_path(2)), whole);
    EXPECT_GT(text_of(frame_path(3)).size(), 100u);
}

TEST_F(Resume, StopsBeforeTheFirstFrameAtFramesOfOtherSettings) {
    expect_success(batch({"-f", "2"}));
    const std::string before = text_of(frame_path(2));
    expect_one_line(batch({"--resume", "--set", "layer.stars.render.opacity=0.5"}), 2, "shot.0002.exr");
    EXPECT_EQ(names_in("frames").size(), 1u);
    EXPECT_EQ(text_of(frame_path(2)), before);
}

TEST_F(Resume, WithOverwriteReplacesExactlyTheOthers) {
    write_scene(
        "\"layer.stars.render.opacity\" = { keys = [[1, 1.0], [3, 1.0]], interpolation = \"step\" }\n");
    expect_success(batch());
    keep_old_files();
    const ino_t one = identity(1), two = identity(2), three = identity(3);
    write_scene(
        "\"layer.stars.render.opacity\" = { keys = [[1, 1.0], [3, 0.25]], interpolation = \"step\" }\n");
    EXPECT_EQ(batch({"--resume"}).code, 2);
    expect_success(batch({"--resume", "--overwrite"}));
    EXPECT_EQ(identity(1), one) << "a key at frame 3 does not redo frame 1";
    EXPECT_EQ(identity(2), two);
    EXPECT_NE(identity(3), three);
}

TEST_F(Resume, WhatDoesNotReachThePixelsDoesNotCount) {
    expect_success(batch());
    keep_old_files();
    const ino_t one = identity(1);
    expect_success(batch({"--resume", "--set", "output.fps=30", "--set", "provenance.title=Whirlpool", "-t",
                          "1", "--set", "output.compression=piz", "-f", "1-4"}));
    EXPECT_EQ(identity(1), one);
}

TEST_F(Resume, NoticesChangedInputs) {
    expect_success(batch({"-f", "1"}));
    write_text(folder / "stars.pda", cube_of_splats(299));
    EXPECT_EQ(batch({"-f", "1", "--resume"}).code, 2);
    write_text(folder / "stars.pda", cube_of_splats(300));
    expect_success(batch({"-f", "1", "--resume"}));
}

TEST_F(Resume, ForeignPicturesAreNeverReplacedUnasked) {
    expect_success(batch({"-f", "1", "-o", "f.####.png", "--region", "0,0,32,24"}));
    EXPECT_EQ(batch({"-f", "1", "-o", "f.####.png", "--resume"}).code, 2)
        << "another region is another frame";
}

// status: what --resume would keep, render and refuse, as counts and ranges, without touching anything.

class Status : public SceneTest {
  protected:
    RunResult status(Words more = {}) const { return run(joined({"status", "scene.toml"}, more)); }
    nlohmann::json eyes(Words more = {}) const {
        more.push_back("--json");
        return nlohmann::json::parse(status(more).out).at("eyes");
    }
    /// Without its first two lines, which name scene and files.
    static std::string lines(const RunResult& result) {
        std::size_t begin = 0;
        for (int i = 0; i < 2; ++i) begin = result.out.find('\n', begin) + 1;
        return result.out.substr(begin);
    }
    /// Names, sizes, times of change and contents of all below the folder.
    std::string everything() const {
        std::set<std::string> files;
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            std::string line = entry.path().string();
            line += fmt::format(" {}", entry.last_write_time().time_since_epoch().count());
            if (entry.is_regular_file()) line += text_of(entry.path());
            files.insert(line);
        }
        return fmt::format("{}", fmt::join(files, "\n"));
    }
    std::string frame(int number) const { return fmt::format("frames/shot.{:04}.exr", number); }
};

TEST_F(Status, NamesFramesDoneMissingDamagedAndForeign) {
    expect_success(batch({"-q", "-f", "1-12"}));
    for (const int missing : {2, 3, 4, 7, 9, 11}) fs::remove(folder / frame(missing));
    const std::string whole = text_of(folder / frame(6));
    write_text(folder / frame(6), whole.substr(0, whole.size() / 2));
    expect_success(batch({"-q", "-f", "12", "--overwrite", "--set", "layer.dust.render.opacity=0.5"}));
    const std::string before = everything();
    const RunResult result = status({"-f", "1-12"});
    EXPECT_EQ(result.code, 3);
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(result.out,
              fmt::format("scene scene.toml\nframes {}/frames/shot.####.exr\ndone 4 of 12: 1,5,8,10\n"
                          "missing 6: 2-4,7-11x2\ndamaged 1: 6\nforeign 1: 12\n",
                          folder.string()));
    EXPECT_EQ(everything(), before);
    // --resume does with the others as it says.
    expect_success(batch({"-q", "-f", "1-12", "--resume", "--overwrite"}));
    const RunResult all = expect_success(status({"-f", "1-12"}));
    EXPECT_EQ(lines(all), "done 12 of 12: 1-12\n");
}

TEST_F(Status, CreatesNoFolder) {
    const std::string before = everything();
    const RunResult result = status();
    EXPECT_EQ(result.code, 3);
    EXPECT_EQ(lines(result), "done 0 of 3\nmissing 3: 1-3\n");
    EXPECT_EQ(everything(), before);
}

TEST_F(Status, TellsEyesApart) {
    const Words pair = {"-o", "%V/shot.##.exr", "--set", "camera.eye_separation=0.5"};
    const auto with = [&](Words more) {
        more.insert(more.end(), pair.begin(), pair.end());
        return more;
    };
    expect_success(batch(with({"-q", "-f", "1-4"})));
    fs::remove(folder / "right/shot.02.exr");
    fs::remove(folder / "right/shot.03.exr");
    write_text(folder / "left/shot.04.exr", "");
    EXPECT_EQ(lines(status(with({"-f", "1-4"}))),
              "left done 3 of 4: 1-3\nleft damaged 1: 4\nright done 2 of 4: 1,4\nright missing 2: 2-3\n");
    const nlohmann::json eyes = this->eyes(with({"-f", "1-4"}));
    ASSERT_EQ(eyes.size(), 2u);
    EXPECT_EQ(eyes[0].at("eye"), "left");
    EXPECT_EQ(eyes[0].at("damaged"), (nlohmann::json{{"count", 1}, {"frames", "4"}}));
    EXPECT_EQ(eyes[1].at("missing"), (nlohmann::json{{"count", 2}, {"frames", "2-3"}}));
    EXPECT_EQ(eyes[1].at("foreign"), (nlohmann::json{{"count", 0}, {"frames", ""}}));
}

TEST_F(Status, TakesWhatBatchWasGiven) {
    const Words smaller = {"--resolution", "50%", "--layers", "dust", "--region", "4,4,16,12"};
    Words quiet = smaller;
    quiet.push_back("-q");
    expect_success(batch(quiet));
    expect_success(status(smaller));
    const RunResult other = status();
    EXPECT_EQ(other.code, 3);
    EXPECT_EQ(lines(other), "done 0 of 3\nforeign 3: 1-3\n");
    const nlohmann::json report = nlohmann::json::parse(status({"--json"}).out);
    EXPECT_EQ(report.at("complete"), false);
    EXPECT_EQ(report.at("output"), (folder / "frames/shot.####.exr").string());
    Words as_json = smaller;
    as_json.push_back("--json");
    EXPECT_EQ(nlohmann::json::parse(status(as_json).out).at("complete"), true);
}

TEST_F(Status, WhatIsNoFrameIsForeign) {
    write_text(folder / "strange.####.ppm", "");
    fs::create_directories(folder / "frames/shot.0001.exr");
    fs::create_symlink("nowhere", folder / frame(2));
    EXPECT_EQ(lines(status()), "done 0 of 3\nmissing 1: 3\ndamaged 1: 2\nforeign 1: 1\n");
}

TEST_F(Status, BadInputIsOneLine) {
    expect_one_line(run({"status"}), 2, "SCENE");
    expect_one_line(run({"status", "other.toml"}), 2, "other.toml");
    expect_one_line(status({"--layers", "gas"}), 2, "gas");
    fs::remove(folder / "stars.pda");
    expect_one_line(status(), 2, "stars.pda");
}

}  // namespace
}  // namespace astrosplat::test
