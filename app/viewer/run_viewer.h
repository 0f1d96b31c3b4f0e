// The viewer in a window. In: what the command line asks for. Out: the exit code. Where no OpenGL context can
// be had, one line that names --batch.
#pragma once

#include <atomic>
#include <filesystem>
#include <vector>

#include "scene/load.h"
#include "sets/set_cache.h"

namespace astrosplat {

struct ViewerOptions {
    std::filesystem::path input;          // scene, picture, mesh or splat file; empty: the demo
    std::vector<Assignment> assignments;  // --set
    SetCache cache;
    bool threads_given = false, cache_given = false;  // by the command line, which wins over the settings
};
/// Once `interrupted`, throws Cancelled; an autosave with what was not saved stays.
int run_viewer(const ViewerOptions& options, const std::atomic<bool>& interrupted);

}  // namespace astrosplat
