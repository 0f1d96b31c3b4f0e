// A thread alongside the caller's. In: a function that names the next piece of work. Out: the work done, one
// piece after the other, in that thread. What the pieces read and write is the owner's,
// under the worker's lock.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "core/standard.h"

namespace astrosplat {

class Worker {
  public:
    /// Done without the lock. Must not throw.
    using Task = std::function<void()>;
    /// Called with the lock: the next task, or an empty one where there is nothing to do.
    using NextTask = std::function<Task()>;

    /// `at_least_every` above 0: `next_task` is called that often although nothing woke the thread. Both must
    /// outlive the worker, which therefore is its owner's last member.
    explicit Worker(NextTask next_task, std::chrono::milliseconds at_least_every = {});
    /// Waits for the task at hand; none begins after it.
    ~Worker();
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// Guards all that `next_task` reads.
    std::unique_lock<std::mutex> lock() const { return std::unique_lock(mutex_); }
    /// There may be something to do. Call it without the lock.
    void wake() { wake_.notify_one(); }
    /// A task is being done. Call it with the lock.
    bool working() const { return working_; }
    /// Waits until `condition`, which is asked with the lock whenever the thread has come to rest.
    template <class Condition>
    void wait(Condition condition) {
        std::unique_lock held(mutex_);
        rest_.wait(held, condition);
    }

  private:
    void run();

    NextTask next_task_;
    std::chrono::milliseconds at_least_every_;
    mutable std::mutex mutex_;  // for the owner's state and the two below
    std::condition_variable wake_, rest_;
    bool working_ = false, ending_ = false;
    std::thread thread_;
};

}  // namespace astrosplat
