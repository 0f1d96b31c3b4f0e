// The clock that the viewer's times are of: those of input, of drawing and of what is due.
#pragma once

#include <chrono>

namespace astrosplat {

/// Seconds from a start that does not change while the program runs.
inline double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace astrosplat
