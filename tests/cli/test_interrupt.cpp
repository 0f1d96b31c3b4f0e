// Ctrl-C and termination: the exit code says so, and every file that is there is whole.
#include <chrono>
#include <thread>

#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

class Interrupt : public SceneTest {
  protected:
    /// Starts a long job, sends the signal once the first frame is saved, and waits for the end.
    RunResult interrupted_run(int signal) {
        RunOptions options;
        options.folder = folder;
        const RunningProgram program({ASTROSPLAT_PROGRAM, "--batch", "scene.toml", "-f", "1-2000",
                                      "--resolution", "640x480", "--stats", "stats.json"},
                                     options);
        while (program.err_so_far().find("saved ") == std::string::npos) {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        program.signal(signal);
        return program.wait();
    }
    void expect_whole_frames_only() {
        const std::set<std::string> names = names_in("frames");
        EXPECT_GE(names.size(), 1u);
        for (const std::string& name : names) {
            EXPECT_EQ(name.substr(0, 5), "shot.") << "a temporary file stayed: " << name;
            EXPECT_EQ(run({"info", "frames/" + name}).code, 0) << name;
        }
        EXPECT_EQ(json("stats.json").at("frames").size(), names.size());
    }
};

TEST_F(Interrupt, SigintIsCode130) {
    const RunResult result = interrupted_run(SIGINT);
    EXPECT_EQ(result.code, 130) << result.err;
    expect_whole_frames_only();
}

TEST_F(Interrupt, SigtermIsCode143) {
    const RunResult result = interrupted_run(SIGTERM);
    EXPECT_EQ(result.code, 143) << result.err;
    expect_whole_frames_only();
}

TEST_F(Interrupt, ResumeCompletesAnInterruptedRun) {
    interrupted_run(SIGINT);
    const std::set<std::string> names = names_in("frames");
    const std::string frames = fmt::format("1-{}", names.size() + 2);
    const RunResult result =
        batch({"-f", frames, "--resolution", "640x480", "--resume", "--stats", "stats.json"});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(names_in("frames").size(), names.size() + 2);
    EXPECT_EQ(json("stats.json").at("frames").size(), 2u);
}

}  // namespace
}  // namespace astrosplat::test
