// The clock that times are of: how long something took, and when it is due. Out: seconds.
#pragma once

#include <chrono>

namespace astrosplat {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Seconds from a start that does not change while the program runs.
inline double seconds_now() { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); }

}  // namespace astrosplat
