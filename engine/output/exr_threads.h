// Threads that OpenEXR may pack and unpack pixels with.
#pragma once

#include <ImfThreading.h>

#include <exception>

#include "core/parallel.h"

namespace astrosplat {

/// As many as the program's own; none where there are none to be had, and it does without.
inline int exr_threads() {
    try {
        if (Imf::globalThreadCount() != thread_count()) Imf::setGlobalThreadCount(thread_count());
        return Imf::globalThreadCount();
    } catch (const std::exception&) {
        return 0;
    }
}

}  // namespace astrosplat
