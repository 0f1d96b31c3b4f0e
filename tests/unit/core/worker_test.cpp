// One thread beside the test's: all work done, in order, and none after the end.
#include "core/worker.h"

#include <gtest/gtest.h>

#include <atomic>
#include <deque>
#include <vector>

namespace astrosplat {
namespace {

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

TEST(Worker, WaitsOnlySoLong) {
    Numbers numbers;
    EXPECT_FALSE(numbers.worker.wait_for(std::chrono::milliseconds(1), [] { return false; }));
    EXPECT_TRUE(numbers.worker.wait_for(std::chrono::milliseconds(1), [] { return true; }));
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
    EXPECT_TRUE(worker.wait_for(std::chrono::minutes(1), [&] { return asked >= 3; }));
}

}  // namespace
}  // namespace astrosplat
