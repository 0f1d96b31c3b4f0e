// The pool of threads, single workers, and memory that the C library keeps.
#include <deque>

#include "core/memory.h"
#include "core/worker.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// The pool: every index once, fixed chunks, exceptions, nesting, several callers.

class Parallel : public testing::TestWithParam<int> {
  protected:
    void SetUp() override { set_thread_count(GetParam()); }
    void TearDown() override { set_thread_count(0); }
};

TEST_P(Parallel, EveryIndexExactlyOnce) {
    std::vector<int> visits(10007, 0);
    parallel_for(10007, [&](std::int64_t i, int) { ++visits[std::size_t(i)]; });
    EXPECT_EQ(visits, std::vector<int>(10007, 1));
}

TEST_P(Parallel, ChunksDependOnCountAndChunkAlone) {
    std::mutex mutex;
    std::set<std::pair<std::int64_t, std::int64_t>> chunks;
    parallel_chunks(25, 10, [&](std::int64_t begin, std::int64_t end, int) {
        const std::lock_guard lock(mutex);
        chunks.insert({begin, end});
    });
    const std::set<std::pair<std::int64_t, std::int64_t>> expected{{0, 10}, {10, 20}, {20, 25}};
    EXPECT_EQ(chunks, expected);
}

TEST_P(Parallel, WorkerNumbersAreBelowTheThreadCountAndNeverShared) {
    const auto threads = std::size_t(thread_count());
    std::vector<std::atomic<int>> inside(threads);
    std::atomic<bool> wrong{false};
    parallel_for(5000, [&](std::int64_t, int worker) {
        if (worker < 0 || worker >= thread_count() || inside[std::size_t(worker)]++ != 0) wrong = true;
        --inside[std::size_t(worker)];
    });
    EXPECT_FALSE(wrong);
}

TEST_P(Parallel, FirstExceptionComesBackAndThePoolLivesOn) {
    EXPECT_THROW(parallel_for(1000,
                              [](std::int64_t i, int) {
                                  if (i == 500) throw std::runtime_error("x");
                              }),
                 std::runtime_error);
    std::atomic<int> count{0};
    parallel_for(100, [&](std::int64_t, int) { ++count; });
    EXPECT_EQ(count, 100);
}

TEST_P(Parallel, NestedLoopRunsInItsCaller) {
    std::atomic<int> wrong{0}, count{0};
    parallel_for(20, [&](std::int64_t, int outer) {
        const std::thread::id thread = std::this_thread::get_id();
        parallel_for(10, [&](std::int64_t, int inner) {
            if (std::this_thread::get_id() != thread || inner != outer) ++wrong;
            ++count;
        });
    });
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(count, 200);
}

TEST_P(Parallel, SeveralThreadsMayCallAtOnce) {
    std::vector<std::int64_t> sums(4, 0);
    std::vector<std::thread> callers;
    for (std::size_t c = 0; c < sums.size(); ++c)
        callers.emplace_back([&sums, c] {
            for (int round = 0; round < 50; ++round) {
                std::vector<std::int64_t> values(1000, 0);
                parallel_for(1000, [&](std::int64_t i, int) { values[std::size_t(i)] = i; });
                sums[c] += std::accumulate(values.begin(), values.end(), std::int64_t{0});
            }
        });
    for (std::thread& caller : callers) caller.join();
    for (const std::int64_t sum : sums) EXPECT_EQ(sum, 50 * 499500);
}

// Its loops and those within them, in whatever thread they run; not another caller's, and not later.
TEST_P(Parallel, StopsWhereItsCallerIsAskedTo) {
    std::atomic<int> begun{0}, within{0};
    const auto stop_at_once = [&](bool nested) {
        std::atomic<bool> cancelled{false};
        begun = 0;
        const StoppableLoops stops({{}, &cancelled});
        parallel_for(1000, [&](std::int64_t, int) {
            ++begun;
            cancelled = true;
            if (nested) parallel_for(1000, [&](std::int64_t, int) { ++within; });
        });
    };
    for (const bool nested : {false, true}) {
        EXPECT_THROW(stop_at_once(nested), Cancelled);
        EXPECT_LE(begun, thread_count());
        EXPECT_EQ(within, 0);
    }
    std::atomic<int> count{0};
    parallel_for(100, [&](std::int64_t, int) { ++count; });
    EXPECT_EQ(count, 100) << "it is over";
}

TEST_P(Parallel, NothingToDo) {
    parallel_chunks(0, 10, [](std::int64_t, std::int64_t, int) { FAIL(); });
    parallel_chunks(-5, 10, [](std::int64_t, std::int64_t, int) { FAIL(); });
}

INSTANTIATE_TEST_SUITE_P(Threads, Parallel, testing::Values(1, 2, 7));

TEST(Threads, AtLeastOneAndAsSet) {
    EXPECT_GE(available_threads(), 1);
    set_thread_count(3);
    EXPECT_EQ(thread_count(), 3);
    set_thread_count(0);
    EXPECT_EQ(thread_count(), available_threads());
}

// A thread alongside the test's: all work done, in order, and none after the end.

/// Work by number: the order in which it was done.
struct Numbers {
    std::deque<int> waiting;
    std::vector<int> done;
    Worker worker{[this] { return next(); }};

    Worker::Task next() {
        if (waiting.empty()) return {};
        const int number = waiting.front();
        waiting.pop_front();
        return [this, number] {
            const auto held = worker.lock();
            EXPECT_TRUE(worker.working());
            done.push_back(number);
        };
    }
    void give(int number) {
        {
            const auto held = worker.lock();
            waiting.push_back(number);
        }
        worker.wake();
    }
};

TEST(Worker, DoesAllThatIsWaitingInItsOrder) {
    Numbers numbers;
    std::vector<int> given;
    for (int i = 0; i < 1000; ++i) {
        numbers.give(i);
        given.push_back(i);
    }
    numbers.worker.wait([&] { return numbers.waiting.empty() && !numbers.worker.working(); });
    EXPECT_EQ(numbers.done, given);
}

TEST(Worker, EndsAfterTheTaskAtHand) {
    std::atomic<int> begun{0}, ended{0};
    std::atomic<bool> go_on{false};
    {
        Worker worker([&]() -> Worker::Task {
            return [&] {
                ++begun;
                while (!go_on) std::this_thread::yield();
                ++ended;
            };
        });
        while (begun == 0) std::this_thread::yield();
        go_on = true;
    }
    EXPECT_GE(ended, 1);
    EXPECT_EQ(begun, ended);
}

TEST(Worker, LooksForWorkBySoMuchTimeAlthoughNothingWakesIt) {
    std::atomic<int> asked{0};
    Worker worker(
        [&]() -> Worker::Task {
            ++asked;
            return {};
        },
        std::chrono::milliseconds(1));
    for (int ms = 0; ms < 60'000 && asked < 3; ++ms)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_GE(asked, 3);
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool has_own_heap = true;
#else
constexpr bool has_own_heap = false;
#endif

/// A few blocks that stay, of another thread, hold the pages of many that went.
TEST(FreedMemory, GoesBackToTheSystem) {
    if (has_own_heap || !std::ifstream("/proc/self/smaps_rollup"))
        GTEST_SKIP() << "the C library's heap is not in use, or cannot be measured";
    constexpr std::size_t block = 16 << 10, count = 4000;
    std::vector<std::unique_ptr<char[]>> kept;
    std::thread([&] {
        std::vector<std::unique_ptr<char[]>> blocks;
        for (std::size_t i = 0; i < count; ++i) blocks.push_back(std::make_unique<char[]>(block));
        for (std::size_t i = 0; i < count; i += 100) kept.push_back(std::move(blocks[i]));
    }).join();
    const std::int64_t before = resident_memory_bytes();
    return_freed_memory();
    EXPECT_LT(resident_memory_bytes(), before - std::int64_t(block * count / 2));
}

/// Resident memory before and after many blocks of another thread, once a large one was freed.
std::int64_t growth_by_freed_blocks() {
    constexpr std::size_t large = 30 << 20, block = 16 << 10, count = 3000;
    const std::int64_t before = resident_memory_bytes();
    std::thread([&] {
        std::make_unique<char[]>(large);
        std::vector<std::unique_ptr<char[]>> blocks;
        for (std::size_t i = 0; i < count; ++i) blocks.push_back(std::make_unique<char[]>(block));
        blocks.clear();
        return_freed_memory();
    }).join();
    return resident_memory_bytes() - before;
}

// The ends of other threads' heaps cannot be asked for.
TEST(FreedMemory, IsNotKeptAtTheEndsOfHeaps) {
    if (has_own_heap || !std::ifstream("/proc/self/smaps_rollup"))
        GTEST_SKIP() << "the C library's heap is not in use, or cannot be measured";
    keep_little_freed_memory();
    EXPECT_LT(growth_by_freed_blocks(), 10'000'000);
}

}  // namespace
}  // namespace astrosplat
