// A question to a disk, asked beside the window, which a disk far away must not stop. In: a function that
// asks. Out: its answer, when that is known. One thread a question, which owns all that it touches: nothing
// waits for it, also when the program ends.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace astrosplat {

/// In which most disks answer: a window that waits so long does not flash, and nobody notices.
constexpr std::chrono::milliseconds disk_moment(200);

template <class Answer>
class DiskQuestion {
  public:
    /// The rest of an answer that nobody waits for any more may be left out.
    using Ask = std::function<Answer(const std::atomic<bool>& forgotten)>;

    DiskQuestion() = default;
    ~DiskQuestion() { forget(); }
    DiskQuestion(const DiskQuestion&) = delete;
    DiskQuestion& operator=(const DiskQuestion&) = delete;

    /// Earlier questions are dropped.
    void begin(Ask ask) {
        forget();
        job_ = std::make_shared<Job>();
        std::thread([job = job_, ask = std::move(ask)] {
            Answer answer = ask(job->forgotten);
            const std::lock_guard held(job->mutex);
            job->answer = std::move(answer);
            job->ready.notify_all();
        }).detach();
    }
    /// The answer is not known yet, or was not taken.
    bool is_open() const { return job_ != nullptr; }
    /// The answer, once; waits for it up to this long.
    std::optional<Answer> take(std::chrono::milliseconds at_most = {}) {
        if (!job_) return std::nullopt;
        std::unique_lock held(job_->mutex);
        if (!job_->ready.wait_for(held, at_most, [&] { return job_->answer.has_value(); }))
            return std::nullopt;
        std::optional<Answer> answer = std::move(job_->answer);
        held.unlock();
        job_.reset();
        return answer;
    }
    void forget() {
        if (job_) job_->forgotten = true;
        job_.reset();
    }

  private:
    struct Job {
        std::mutex mutex;
        std::condition_variable ready;
        std::atomic<bool> forgotten{false};
        std::optional<Answer> answer;
    };
    std::shared_ptr<Job> job_;  // null: nothing is asked for
};

}  // namespace astrosplat
