// status: what --resume would keep, render and refuse, as counts and ranges, without touching anything.
#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

class Status : public SceneTest {
  protected:
    RunResult status(std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"status", "scene.toml"});
        return run(more);
    }
    nlohmann::json eyes(std::vector<std::string> more = {}) const {
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
    ASSERT_EQ(batch({"-q", "-f", "1-12"}).code, 0);
    for (const int missing : {2, 3, 4, 7, 9, 11}) fs::remove(folder / frame(missing));
    const std::string whole = text_of(folder / frame(6));
    write_text(folder / frame(6), whole.substr(0, whole.size() / 2));
    ASSERT_EQ(batch({"-q", "-f", "12", "--overwrite", "--set", "layer.dust.render.opacity=0.5"}).code, 0);
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
    ASSERT_EQ(batch({"-q", "-f", "1-12", "--resume", "--overwrite"}).code, 0);
    const RunResult all = status({"-f", "1-12"});
    EXPECT_EQ(all.code, 0);
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
    const std::vector<std::string> pair = {"-o", "%V/shot.##.exr", "--set", "camera.eye_separation=0.5"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), pair.begin(), pair.end());
        return more;
    };
    ASSERT_EQ(batch(with({"-q", "-f", "1-4"})).code, 0);
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
    const std::vector<std::string> smaller = {"--resolution", "50%",      "--layers",
                                              "dust",         "--region", "4,4,16,12"};
    std::vector<std::string> quiet = smaller;
    quiet.push_back("-q");
    ASSERT_EQ(batch(quiet).code, 0);
    EXPECT_EQ(status(smaller).code, 0);
    const RunResult other = status();
    EXPECT_EQ(other.code, 3);
    EXPECT_EQ(lines(other), "done 0 of 3\nforeign 3: 1-3\n");
    const nlohmann::json report = nlohmann::json::parse(status({"--json"}).out);
    EXPECT_EQ(report.at("complete"), false);
    EXPECT_EQ(report.at("output"), (folder / "frames/shot.####.exr").string());
    std::vector<std::string> as_json = smaller;
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
