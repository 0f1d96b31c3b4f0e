// Every call of a batch run that can fail does so once: here a fixed choice of about 100 of them, and at
// night of more than a thousand.
#include <fmt/format.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <mutex>
#include <thread>

#include "fault_run.h"

namespace astrosplat::test {
namespace {

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
            const RunResult result = run.batch({}, Fault{"write", 0, EIO, false});
            ASSERT_EQ(result.code, 0) << result.err;
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

}  // namespace
}  // namespace astrosplat::test
