// Work in a thread beside the window. In: requests, made again and again. Out: the result of the last one
// (LatestWork), or results that are kept until they are looked at (ReadAhead).
#pragma once

#include <atomic>
#include <exception>
#include <map>

#include "core/error.h"
#include "core/parallel.h"
#include "core/worker.h"

namespace astrosplat {

/// What `work` finds, or its error; null once it was cancelled.
template <class Found, class Work>
std::shared_ptr<Found> found_or_error(const Work& work, const std::atomic<bool>& cancelled) {
    auto found = std::make_shared<Found>();
    try {
        const Progress progress{{}, &cancelled};
        const StoppableLoops stops(progress);
        *found = work(progress);
    } catch (const Cancelled&) {
        return nullptr;
    } catch (const std::exception& error) {
        found->error = error.what();
    }
    return found;
}

/// The last thing asked for, each in place of the one before. `Found` has a member `error`, which says in one
/// line why there is nothing else in it.
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
        auto found = found_or_error<Found>([&](const Progress& p) { return work_(request, p); }, cancelled);
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

/// Things that are read and kept in memory, so that they are there when they are looked at. Keys are ordered;
/// a Value has a member bytes(), the memory that it takes, and `error` as above.
template <class Key, class Value>
class ReadAhead {
  public:
    using Read = std::function<Value(const Key&, const Progress&)>;

    /// `read` may throw as the work above. About `most_bytes` are kept, of what was wanted last.
    ReadAhead(Read read, std::size_t most_bytes) : read_(std::move(read)), most_bytes_(most_bytes) {}
    ~ReadAhead() { want({}); }

    /// These are read, the first one first, unless they are there; what is being read and is not among them
    /// is let go in the middle. Returns at once.
    void want(std::vector<Key> keys) {
        {
            const auto held = worker_.lock();
            ++calls_;
            wanted_ = std::move(keys);
            for (const Key& key : wanted_)
                if (const auto kept = kept_.find(key); kept != kept_.end()) kept->second.wanted = calls_;
            if (reading_ && !is_wanted(*reading_)) *cancelled_ = true;
            forget_some();
        }
        worker_.wake();
    }

    /// Null while it is not read, or was forgotten.
    std::shared_ptr<const Value> found(const Key& key) const {
        const auto held = worker_.lock();
        const auto kept = kept_.find(key);
        return kept == kept_.end() ? nullptr : kept->second.value;
    }

    /// Something wanted is not read yet.
    bool working() const {
        const auto held = worker_.lock();
        return next() != wanted_.end();
    }

  private:
    struct Kept {
        std::shared_ptr<const Value> value;
        std::uint64_t wanted = 0;  // when it last was, counted in calls of want()
    };

    bool is_wanted(const Key& key) const { return std::ranges::find(wanted_, key) != wanted_.end(); }
    typename std::vector<Key>::const_iterator next() const {
        return std::ranges::find_if(wanted_, [&](const Key& key) { return !kept_.count(key); });
    }

    Worker::Task next_task() {
        const auto key = next();
        if (key == wanted_.end()) return {};
        reading_ = *key;
        cancelled_ = std::make_shared<std::atomic<bool>>(false);
        return [this, wanted = *key, cancelled = cancelled_] { run(wanted, *cancelled); };
    }

    void run(const Key& key, const std::atomic<bool>& cancelled) {
        std::shared_ptr<const Value> value =
            found_or_error<Value>([&](const Progress& p) { return read_(key, p); }, cancelled);
        const auto held = worker_.lock();
        reading_.reset();
        if (value) kept_[key] = {std::move(value), calls_};
        forget_some();
    }

    /// Those that were not wanted for longest, until the rest fits; never those wanted now.
    void forget_some() {
        std::size_t bytes = 0;
        for (const auto& [key, kept] : kept_) bytes += kept.value->bytes();
        while (bytes > most_bytes_) {
            const auto oldest =
                std::ranges::min_element(kept_, {}, [](const auto& entry) { return entry.second.wanted; });
            if (is_wanted(oldest->first)) return;
            bytes -= oldest->second.value->bytes();
            kept_.erase(oldest);
        }
    }

    Read read_;
    std::size_t most_bytes_;
    std::vector<Key> wanted_;  // of the last call
    std::uint64_t calls_ = 0;
    std::map<Key, Kept> kept_;  // those that are read
    std::optional<Key> reading_;
    std::shared_ptr<std::atomic<bool>> cancelled_ = std::make_shared<std::atomic<bool>>(false);
    Worker worker_{[this] { return next_task(); }};
};

}  // namespace astrosplat
