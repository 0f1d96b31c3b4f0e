// --submit slurm on a real Slurm: tasks that are killed half-way, submitted again, give the frames of one run
// here.
#include <signal.h>

#include <chrono>
#include <thread>

#include "cli/scene_fixture.h"
#include "slurm/cluster.h"

namespace astrosplat::test {
namespace {

using Words = std::vector<std::string>;

/// Command line of a process, its words separated by NUL; empty when there is none.
std::string command_line(const fs::path& process) { return text_of(process / "cmdline"); }

class Slurm : public SceneTest {
  protected:
    static void SetUpTestSuite() { cluster = std::make_unique<Cluster>(); }
    static void TearDownTestSuite() { cluster.reset(); }

    void SetUp() override {
        if (!cluster->problem().empty()) GTEST_SKIP() << cluster->problem();
    }

    /// In a folder with a name for which shells and Slurm have meanings.
    void move_to(const std::string& name) {
        place = folder / name;
        fs::create_directories(place);
        write_text(place / "picture.ppm", small_picture());
        fs::copy(folder / "stars.pda", place / "stars.pda");
        write_text(place / "scene.toml", R"(astrosplat = 1
[output]
resolution = [320, 240]
samples = 6
frames = "1-40"
path = "frames/shot.####.exr"
[camera]
position = [0.0, 0.0, 9.0]
shutter = 180.0
[[layer]]
name = "gas"
[layer.source]
meshes = [ { mesh = "plane", texture = "picture.ppm" } ]
voxel_size = 0.05
[[layer]]
name = "stars"
[layer.source]
kind = "splats"
file = "stars.pda"
[animation]
"camera.position" = { keys = [[1, [0.0, 0.0, 9.0]], [40, [2.0, 1.0, 8.0]]] }
)");
    }
    RunResult here(Words words) const {
        RunOptions options;
        options.folder = place;
        options.environment = {cluster->environment()};
        return run(std::move(words), options);
    }
    RunResult submit(Words more = {}) const {
        more.insert(more.begin(), {"--submit", "slurm", "scene.toml", "--threads", "1", "--chunk", "10"});
        return here(more);
    }
    std::size_t frames_there() const {
        std::size_t count = 0;
        std::error_code none_yet;
        for (const auto& entry : fs::directory_iterator(place / "frames", none_yet))
            count += entry.path().filename().string().starts_with("shot.");
        return count;
    }
    /// SIGKILL to the program that renders these frames, as when a machine runs out of memory.
    bool kill_program_with(const std::string& frames) const {
        for (const auto& process : fs::directory_iterator("/proc")) {
            const std::string words = command_line(process.path());
            if (words.find((place / "scene.toml").string()) == std::string::npos ||
                words.find('\0' + frames + '\0') == std::string::npos)
                continue;
            return kill(std::stoi(process.path().filename().string()), SIGKILL) == 0;
        }
        return false;
    }
    fs::path frame(int number) const { return place / fmt::format("frames/shot.{:04}.exr", number); }
    /// Throws once nothing waits or runs any more.
    void wait_a_little() const {
        if (cluster->tool({"squeue", "--noheader"}).out.empty())
            throw std::runtime_error("the tasks are over: " + log("0001/1.log") + log("0001/2_1.log"));
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    std::string log(const std::string& name) const { return text_of(place / "frames/slurm" / name); }

    static inline std::unique_ptr<Cluster> cluster;
    fs::path place;
};

TEST_F(Slurm, TasksKilledHalfWayAndSubmittedAgainGiveTheSameFrames) {
    move_to("a  'b' \"c\" $(touch d) `e`\nü");
    ASSERT_EQ(here({"--batch", "scene.toml", "-q", "-o", "local/shot.####.exr", "--no-cache"}).code, 0);

    const RunResult first = expect_success(submit());
    EXPECT_NE(first.out.find("40 frames in 4 tasks submitted as job 2, "), std::string::npos) << first.out;
    // Each when it has written a frame: not before it began, nor after its end.
    while (!fs::exists(frame(11)) || !kill_program_with("--frames=11-20")) wait_a_little();
    while (!fs::exists(frame(1))) wait_a_little();
    cluster->tool({"scancel", "--signal=KILL", "--full", "2_0"});
    cluster->tool({"scancel", "2_2"});
    ASSERT_TRUE(cluster->wait_until_idle());

    const std::size_t done = frames_there();
    EXPECT_GE(done, 2u);
    EXPECT_LT(done, 40u);
    const RunResult status = here({"status", "scene.toml"});
    EXPECT_EQ(status.code, 3);
    EXPECT_NE(status.out.find(fmt::format("\ndone {} of 40: ", done)), std::string::npos) << status.out;
    EXPECT_NE(status.out.find(fmt::format("\nmissing {}: ", 40 - done)), std::string::npos)
        << status.out << "killed programs leave no half frame";
    EXPECT_NE(status.out.find("\nqueue job 2, 4 tasks: "), std::string::npos) << status.out;
    EXPECT_NE(log("0001/1.log").find("layer gas: "), std::string::npos) << "the sets' job";

    const RunResult second = expect_success(submit());
    EXPECT_EQ(second.out.find(fmt::format("{} frames in ", 40 - done)), 0u) << second.out;
    const RunResult third = expect_success(submit());
    EXPECT_NE(third.out.find("in the queue already"), std::string::npos) << third.out;
    ASSERT_TRUE(cluster->wait_until_idle());
    EXPECT_EQ(here({"status", "scene.toml"}).code, 0) << here({"status", "scene.toml"}).out;
    EXPECT_EQ(submit().out, "no frame is missing: nothing to submit\n");
    for (int frame = 1; frame <= 40; ++frame) {
        const std::string name = fmt::format("shot.{:04}.exr", frame);
        const std::string local = text_of(place / "local" / name);
        EXPECT_FALSE(local.empty());
        EXPECT_TRUE(text_of(place / "frames" / name) == local)
            << name << " differs from that of the local run";
    }
}

TEST_F(Slurm, TasksDoNotRunWithoutTheirSets) {
    move_to("100% a\\b %j");
    write_text(place / "file", "");
    expect_success(submit({"--cache", "file"}));
    ASSERT_TRUE(cluster->wait_until_idle());
    EXPECT_EQ(frames_there(), 0u);
    const RunResult status = here({"status", "scene.toml"});
    EXPECT_NE(status.out.find(", the sets: FAILED\n"), std::string::npos) << status.out;
    EXPECT_NE(status.out.find("4 tasks: 4 CANCELLED\n"), std::string::npos) << status.out;
    std::string logs;
    for (const auto& entry : fs::directory_iterator(place / "frames/slurm/0001"))
        if (entry.path().extension() == ".log") logs += text_of(entry.path());
    EXPECT_NE(logs.find("file: cannot create this folder"), std::string::npos) << logs;
}

TEST_F(Slurm, WhatItRefusesLeavesNothing) {
    move_to("plain");
    expect_one_line(submit({"--partition", "elsewhere", "-q"}), 2, "sbatch: error: ");
    EXPECT_FALSE(fs::exists(place / "frames/slurm"));
    EXPECT_EQ(cluster->tool({"squeue", "--noheader"}).out, "");
}

}  // namespace
}  // namespace astrosplat::test
