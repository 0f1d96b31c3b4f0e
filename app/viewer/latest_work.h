// The last thing asked for, worked out in a thread beside the window. In: requests, each in place of the one
// before. Out: what was found for the last of them.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <utility>

#include "core/error.h"
#include "core/progress.h"
#include "core/worker.h"

namespace astrosplat {

/// `Found` has a member `error`, which says in one line why there is nothing else in it.
template <class Request, class Found>
class LatestWork {
  public:
    using Work = std::function<Found(const Request&, const Progress&)>;

    /// `work` may throw: Cancelled once it was asked to stop, anything else becomes the error.
    explicit LatestWork(Work work) : work_(std::move(work)) {}
    ~LatestWork() { cancel(); }

    /// Begins, unless this was the last request. Returns at once.
    void want(const Request& request) {
        {
            const auto held = worker_.lock();
            if (asked_ && request == request_) return;
            *cancelled_ = true;
            request_ = request;
            found_.reset();
            asked_ = pending_ = true;
        }
        worker_.wake();
    }

    /// Cancels what is under way; what is found stays. Returns at once.
    void cancel() {
        const auto held = worker_.lock();
        if (found_) return;
        *cancelled_ = true;
        asked_ = pending_ = false;
    }

    /// The same, and lets go of the last request and what was found for it, which may hold whole sets.
    void forget() {
        cancel();
        Request request;
        std::shared_ptr<const Found> found;  // let go after the lock
        const auto held = worker_.lock();
        asked_ = pending_ = false;
        std::swap(request, request_);
        found.swap(found_);
    }
    /// The last request satisfies this; false where there is none.
    template <class Condition>
    bool asked(const Condition& condition) const {
        const auto held = worker_.lock();
        return asked_ && condition(request_);
    }

    bool working() const {
        const auto held = worker_.lock();
        return asked_ && !found_;
    }

    /// Null while there is nothing, or where this was not the last request.
    std::shared_ptr<const Found> found(const Request& request) const {
        const auto held = worker_.lock();
        return asked_ && request == request_ ? found_ : nullptr;
    }

  private:
    Worker::Task next_task() {
        if (!std::exchange(pending_, false)) return {};
        cancelled_ = std::make_shared<std::atomic<bool>>(false);
        return [this, request = request_, cancelled = cancelled_] { run(request, *cancelled); };
    }

    void run(const Request& request, const std::atomic<bool>& cancelled) {
        auto found = std::make_shared<Found>();
        try {
            *found = work_(request, Progress{{}, &cancelled});
        } catch (const Cancelled&) {
            return;
        } catch (const std::exception& error) {
            found->error = error.what();
        }
        const auto held = worker_.lock();
        if (!cancelled) found_ = std::move(found);
    }

    Work work_;
    Request request_;
    bool asked_ = false, pending_ = false;
    std::shared_ptr<std::atomic<bool>> cancelled_ = std::make_shared<std::atomic<bool>>(false);
    std::shared_ptr<const Found> found_;
    Worker worker_{[this] { return next_task(); }};
};

}  // namespace astrosplat
