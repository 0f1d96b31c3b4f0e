#include "core/worker.h"

namespace astrosplat {

Worker::Worker(NextTask next_task, std::chrono::milliseconds at_least_every)
    : next_task_(std::move(next_task)), at_least_every_(at_least_every), thread_([this] { run(); }) {}

Worker::~Worker() {
    {
        const std::lock_guard held(mutex_);
        ending_ = true;
    }
    wake_.notify_one();
    thread_.join();
}

void Worker::run() {
    std::unique_lock held(mutex_);
    while (!ending_) {
        if (Task task = next_task_()) {
            working_ = true;
            held.unlock();
            task();
            task = nullptr;  // what it holds may be large: let go without the lock
            held.lock();
            working_ = false;
            continue;
        }
        rest_.notify_all();
        if (at_least_every_.count() > 0)
            wake_.wait_for(held, at_least_every_);
        else
            wake_.wait(held);
    }
}

}  // namespace astrosplat
