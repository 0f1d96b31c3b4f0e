// How long work reports how far it is and learns that it should stop, and the clock that its times are of.
#pragma once

#include <atomic>
#include <chrono>

#include "core/error.h"

namespace astrosplat {

/// Copied by value; an empty one does nothing.
struct Progress {
    std::function<void(double fraction)> report;   // fraction of the work done, 0..1; called from any thread
    const std::atomic<bool>* cancelled = nullptr;  // set by another thread or a signal handler

    void at(double fraction) const {
        if (report) report(fraction);
    }
    /// That of work which is the part from `begin` to `end` of this one.
    Progress part(double begin, double end) const {
        if (!report) return *this;
        return {[whole = report, begin, end](double fraction) { whole(begin + fraction * (end - begin)); },
                cancelled};
    }
    /// One that is asked to stop as this one is, and reports nothing: of work that is no share of this one's.
    Progress silent() const { return {{}, cancelled}; }
    bool stop() const { return cancelled && cancelled->load(std::memory_order_relaxed); }
    /// Throws Cancelled after a request to stop.
    void check() const {
        if (stop()) throw Cancelled();
    }
};

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Seconds from a start that does not change while the program runs.
inline double seconds_now() { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); }

}  // namespace astrosplat
