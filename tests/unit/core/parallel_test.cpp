// The pool: every index once, fixed chunks, exceptions, nesting, several callers.
#include "core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace astrosplat {
namespace {

class Parallel : public testing::TestWithParam<int> {
  protected:
    void SetUp() override { set_thread_count(GetParam()); }
    void TearDown() override { set_thread_count(0); }
};

TEST_P(Parallel, EveryIndexExactlyOnce) {
    std::vector<int> visits(10007, 0);
    parallel_for(10007, [&](std::int64_t i, int) { ++visits[static_cast<std::size_t>(i)]; });
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
    std::vector<std::atomic<int>> inside(static_cast<std::size_t>(thread_count()));
    std::atomic<bool> wrong{false};
    parallel_for(5000, [&](std::int64_t, int worker) {
        if (worker < 0 || worker >= thread_count() || inside[static_cast<std::size_t>(worker)]++ != 0)
            wrong = true;
        --inside[static_cast<std::size_t>(worker)];
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
                parallel_for(1000, [&](std::int64_t i, int) { values[static_cast<std::size_t>(i)] = i; });
                sums[c] += std::accumulate(values.begin(), values.end(), std::int64_t{0});
            }
        });
    for (std::thread& caller : callers) caller.join();
    for (const std::int64_t sum : sums) EXPECT_EQ(sum, 50 * 499500);
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

}  // namespace
}  // namespace astrosplat
