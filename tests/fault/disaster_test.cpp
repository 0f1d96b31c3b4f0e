// A bad weekend on a farm: a full disk, a folder and a picture that go away, two programs on one
// sequence, Ctrl-C. Afterwards every frame that exists is right, and --resume finishes.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <memory>
#include <thread>

#include "fault_run.h"

namespace astrosplat::test {
namespace {

namespace fs = std::filesystem;

class Disaster : public FolderTest {
  protected:
    static inline const FaultScene scene{"frames/shot.###.exr", 2};
    static inline const std::vector<std::string> frames = {"-f",      "1-12",       "--resolution",
                                                           "320x240", "--progress", "plain"};

    Tree undisturbed() const {
        const FaultRun run(folder / "whole", scene);
        const RunResult result = run.batch(frames);
        EXPECT_EQ(result.code, 0) << result.err;
        return run.tree();
    }
    /// Starts a run and returns once its first frame is there.
    static std::unique_ptr<RunningProgram> started(const FaultRun& run,
                                                   const std::vector<std::string>& more = frames) {
        auto program = std::make_unique<RunningProgram>(run.words(more), run.options());
        while (program->running() && program->err_so_far().find("saved ") == std::string::npos)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return program;
    }
    static std::size_t frame_count(const Tree& tree) {
        return static_cast<std::size_t>(
            std::ranges::count_if(tree, [](const auto& file) { return file.first.starts_with("frames/"); }));
    }
    /// --resume gives all frames of the undisturbed run.
    static void expect_resumed(FaultRun& run, const Tree& whole) {
        std::vector<std::string> more = frames;
        more.emplace_back("--resume");
        const RunResult result = run.batch(more);
        EXPECT_EQ(result.code, 0) << result.err;
        run.check_files(whole, false);
        EXPECT_EQ(frame_count(run.tree()), frame_count(whole));
        EXPECT_EQ(run.complaints(), "");
    }
};

TEST_F(Disaster, TheDiskIsFull) {
    const FaultRun whole_run(folder / "whole", scene);
    ASSERT_EQ(whole_run.batch({}).code, 0);
    const Tree whole = whole_run.tree();
    FaultRun run(folder / "full", scene);
    fs::create_directories(run.work() / "frames");
    fs::create_directories(run.work() / "kept");
    // A file system with room for one frame and a half, in a mount namespace of its own.
    const std::size_t room = whole.at("frames/shot.001.exr").size() * 3 / 2 / 4096 * 4096 + 4096;
    const std::string mount = fmt::format("mount -t tmpfs -o size={} none frames", room);
    if (run_program({"/usr/bin/unshare", "-rm", "/bin/sh", "-c", mount}, run.options()).code != 0)
        GTEST_SKIP() << "nothing can be mounted here";
    std::vector<std::string> words = {"/usr/bin/unshare",
                                      "-rm",
                                      "/bin/sh",
                                      "-c",
                                      mount + " || exit 99; \"$@\"; code=$?; cp -a frames/. kept; exit $code",
                                      "sh"};
    for (const std::string& word : run.words({})) words.push_back(word);
    const RunResult result = run_program(words, run.options());
    EXPECT_EQ(result.code, 3) << result.err;
    EXPECT_NE(result.err.find("shot.002.exr: cannot be written: No space left on device"), std::string::npos)
        << result.err;
    const Tree kept = tree_of(run.work() / "kept");
    ASSERT_EQ(kept.size(), 1u) << "nothing but the frame that is done";
    EXPECT_EQ(kept.begin()->first, "shot.001.exr");
    EXPECT_EQ(kept.begin()->second, whole.at("frames/shot.001.exr"));
    fs::remove_all(run.work() / "kept");
    run.resume(whole, false);
    EXPECT_EQ(run.complaints(), "");
}

TEST_F(Disaster, TheFolderGoesAway) {
    const Tree whole = undisturbed();
    FaultRun run(folder / "gone", scene);
    const auto program = started(run);
    std::error_code busy;
    do fs::remove_all(run.work() / "frames", busy);
    while (busy);  // the next frame came into the folder as it was emptied
    const RunResult result = program->wait();
    EXPECT_EQ(result.code, 3) << result.err;
    EXPECT_NE(result.err.find(" failed: 1"), std::string::npos) << result.err;
    run.check_files(whole, false);
    expect_resumed(run, whole);
}

TEST_F(Disaster, ThePictureGoesAway) {
    const Tree whole = undisturbed();
    FaultRun run(folder / "gone", scene);
    const auto program = started(run);
    const fs::path picture = run.work() / "picture.ppm";
    fs::rename(picture, folder / "picture.ppm");
    const RunResult result = program->wait();
    EXPECT_EQ(result.code, 0) << "it was read before the first frame: " << result.err;
    EXPECT_EQ(frame_count(run.tree()), frame_count(whole));
    std::vector<std::string> more = frames;
    more.emplace_back("--resume");
    const RunResult without = run.batch(more);
    EXPECT_EQ(without.code, 2);
    EXPECT_NE(without.err.find("picture.ppm"), std::string::npos) << without.err;
    fs::rename(folder / "picture.ppm", picture);
    fs::remove(run.work() / "frames/shot.007.exr");
    expect_resumed(run, whole);
}

TEST_F(Disaster, TwoProgramsRenderOneSequence) {
    const Tree whole = undisturbed();
    FaultRun run(folder / "two", scene);
    std::vector<std::string> more = frames;
    more.emplace_back("--resume");
    const RunningProgram first(run.words(more), run.options()), second(run.words(more), run.options());
    const RunResult a = first.wait(), b = second.wait();
    EXPECT_EQ(a.code, 0) << a.err;
    EXPECT_EQ(b.code, 0) << b.err;
    run.check_files(whole, false);
    EXPECT_EQ(frame_count(run.tree()), frame_count(whole));
    expect_resumed(run, whole);
}

TEST_F(Disaster, InterruptsAreHeardSoon) {
    FaultRun run(folder / "stopped", scene);
    const auto program = started(run, {"-f", "1-2000", "--resolution", "1920x1440", "--progress", "plain"});
    program->signal(SIGINT);
    const auto asked = std::chrono::steady_clock::now();
    while (program->running() && std::chrono::steady_clock::now() - asked < std::chrono::seconds(20))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    // A second is promised, and a fraction of one usual; a machine under load gets more.
    EXPECT_LT(std::chrono::steady_clock::now() - asked, std::chrono::seconds(10));
    RecordProperty("milliseconds", static_cast<int>((std::chrono::steady_clock::now() - asked) /
                                                    std::chrono::milliseconds(1)));
    if (program->running()) program->signal(SIGKILL);
    EXPECT_EQ(program->wait().code, 130);
    for (const auto& [name, bytes] : tree_of(run.work() / "frames")) EXPECT_NE(name.front(), '.') << name;
}

}  // namespace
}  // namespace astrosplat::test
