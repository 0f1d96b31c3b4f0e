// How long work reports how far it is and learns that it should stop. Copied by value; an empty one does
// nothing.
#pragma once

#include <atomic>
#include <functional>

#include "core/error.h"

namespace astrosplat {

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
    bool stop() const { return cancelled && cancelled->load(std::memory_order_relaxed); }
    /// Throws Cancelled after a request to stop.
    void check() const {
        if (stop()) throw Cancelled();
    }
};

}  // namespace astrosplat
