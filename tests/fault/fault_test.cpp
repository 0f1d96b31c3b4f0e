// The program whose calls fail, and whose folders, pictures and disk go away.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <memory>
#include <mutex>
#include <thread>

#include "fault_run.h"

namespace astrosplat::test {
namespace {

// Every call of a batch run that can fail does so once: here a fixed choice of about 100 of them, and at
// night of more than a thousand.

namespace fs = std::filesystem;

struct Point {
    Fault fault;
    FaultScene scene;
};

/// What the points of a choice are numbered with becomes what is as good as chance, and the same on every
/// run.
std::uint64_t hashed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

struct KindOfFault {
    std::string kind;
    std::vector<int> errors;
    int points, nightly_points;
};
const std::vector<KindOfFault> kinds = {
    {"write", {EIO, ENOSPC, take_half}, 24, 300},
    {"open", {EIO, EMFILE, EACCES}, 16, 500},
    {"rename", {EIO, ENOSPC}, 12, 40},
    {"sync", {EIO}, 10, 20},
    {"map", {ENOMEM}, 4, 10},
    {"allocate", {ENOMEM}, 24, 400},
    {"thread", {EAGAIN}, 9, 20},
};

const FaultScene exr{"frames/shot.###.exr", 1}, png{"frames/shot.###.png", 1}, tif{"frames/shot.###.tif", 1};
const std::vector<FaultScene> scenes = {exr, png, tif};

class FaultTest : public FolderTest {
  protected:
    void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
        GTEST_SKIP() << "a sanitizer takes the memory's functions itself";
#endif
        for (const FaultScene& scene : scenes) {
            FaultRun run(folder / "whole", scene);
            const RunResult result = expect_success(run.batch({}, Fault{"write", 0, EIO, false}));
            ASSERT_EQ(result.err, "");
            whole_[scene.output] = run.tree();
            counts_[scene.output] = run.counts();
            ASSERT_EQ(counts_[scene.output].size(), kinds.size());
            for (const KindOfFault& kind : kinds) EXPECT_GT(counts_[scene.output][kind.kind], 0) << kind.kind;
        }
    }

    /// Spread evenly over the calls of each kind, the place within its part by hash.
    std::vector<Point> points(bool nightly) {
        std::vector<Point> points;
        for (const KindOfFault& kind : kinds)
            for (const FaultScene& scene : scenes) {
                const std::int64_t calls = counts_[scene.output][kind.kind];
                const std::int64_t wanted =
                    (nightly ? kind.nightly_points : kind.points) / std::ssize(scenes);
                const std::int64_t count = std::min(wanted, calls);
                for (std::int64_t i = 0; i < count; ++i) {
                    const std::int64_t begin = i * calls / count, end = (i + 1) * calls / count;
                    const std::uint64_t h = hashed(points.size());
                    const auto at =
                        begin + static_cast<std::int64_t>(h % static_cast<std::uint64_t>(end - begin));
                    Point point{{kind.kind, at + 1, kind.errors[h / 7 % kind.errors.size()], false}, scene};
                    point.fault.onward =
                        kind.kind == "write" && point.fault.error == ENOSPC && h / 64 % 2 == 0;
                    if (h / 256 % 4 == 0 || kind.kind == "thread") point.scene.threads = 3;
                    points.push_back(point);
                }
            }
        return points;
    }

    std::vector<Point> kills(int count) {
        std::vector<Point> points;
        for (int i = 0; i < count; ++i) {
            const FaultScene& scene = scenes[static_cast<std::size_t>(i) % scenes.size()];
            const std::int64_t calls = counts_[scene.output]["write"];
            const auto place =
                static_cast<std::int64_t>(hashed(1000 + i) % static_cast<std::uint64_t>(calls));
            points.push_back({{"write", place + 1, end_process, false}, scene});
        }
        return points;
    }

    void expect_no_complaints(const std::vector<Point>& points) {
        std::atomic<std::size_t> next{0};
        std::mutex mutex;
        std::string complaints;
        const auto work = [&] {
            for (std::size_t i; (i = next++) < points.size();) {
                const Point& point = points[i];
                const std::string about =
                    complaints_about(point.fault, point.scene, whole_.at(point.scene.output),
                                     folder / fmt::format("point{}", i));
                const std::lock_guard lock(mutex);
                if (!about.empty()) complaints += fmt::format("point{} ", i) + about;
            }
        };
        std::vector<std::thread> threads;
        for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
            threads.emplace_back(work);
        for (std::thread& thread : threads) thread.join();
        EXPECT_EQ(complaints, "");
    }

    std::map<std::string, Tree> whole_;  // by pattern of output
    std::map<std::string, std::map<std::string, std::int64_t>> counts_;
};

TEST_F(FaultTest, AnyCallMayFail) { expect_no_complaints(points(false)); }
TEST_F(FaultTest, AnyCallMayFailNightly) {
    const std::vector<Point> all = points(true);
    EXPECT_GE(all.size(), 1000u);
    expect_no_complaints(all);
}

// A flush that fails may have lost the file, though it looks right now. Folders and the cache may fail.
TEST_F(FaultTest, FramesAndFiguresThatCannotBeFlushedAreFailures) {
    std::map<int, int> codes;
    const std::int64_t calls = counts_[exr.output]["sync"];
    for (std::int64_t at = 1; at <= calls; ++at)
        ++codes[FaultRun(folder / "run", exr).batch({}, Fault{"sync", at, EIO, false}).code];
    EXPECT_EQ(codes[3], 2) << "each of two frames";
    EXPECT_EQ(codes[4], 1) << "the figures";
    EXPECT_EQ(codes[0], calls - 3);
}

TEST_F(FaultTest, KilledWithinAWrite) { expect_no_complaints(kills(20)); }
TEST_F(FaultTest, KilledWithinAWriteNightly) { expect_no_complaints(kills(50)); }

// A bad weekend on a farm: a full disk, a folder and a picture that go away, two programs on one
// sequence, Ctrl-C. Afterwards every frame that exists is right, and --resume finishes.

class Disaster : public FolderTest {
  protected:
    static inline const FaultScene scene{"frames/shot.###.exr", 2};
    static inline const std::vector<std::string> frames = {"-f",      "1-12",       "--resolution",
                                                           "320x240", "--progress", "plain"};
    static inline const std::vector<std::string> missing = {"-f",         "1-12",  "--resolution", "320x240",
                                                            "--progress", "plain", "--resume"};

    Tree undisturbed() const {
        const FaultRun run(folder / "whole", scene);
        expect_success(run.batch(frames));
        return run.tree();
    }
    /// Starts a run and returns once its first frame is there.
    static std::unique_ptr<RunningProgram> started(const FaultRun& run,
                                                   const std::vector<std::string>& more = frames) {
        auto program = std::make_unique<RunningProgram>(run.words(more), run.options());
        program->wait_until_said("saved ");
        return program;
    }
    static std::size_t frame_count(const Tree& tree) {
        return static_cast<std::size_t>(
            std::ranges::count_if(tree, [](const auto& file) { return file.first.starts_with("frames/"); }));
    }
    /// --resume gives all frames of the undisturbed run.
    static void expect_resumed(FaultRun& run, const Tree& whole) {
        expect_success(run.batch(missing));
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
    const RunResult without = run.batch(missing);
    EXPECT_EQ(without.code, 2);
    EXPECT_NE(without.err.find("picture.ppm"), std::string::npos) << without.err;
    fs::rename(folder / "picture.ppm", picture);
    fs::remove(run.work() / "frames/shot.007.exr");
    expect_resumed(run, whole);
}

TEST_F(Disaster, TwoProgramsRenderOneSequence) {
    const Tree whole = undisturbed();
    FaultRun run(folder / "two", scene);
    const RunningProgram first(run.words(missing), run.options()), second(run.words(missing), run.options());
    for (const RunningProgram* program : {&first, &second}) expect_success(program->wait());
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
