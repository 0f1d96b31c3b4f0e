// The options of a session at its start, in a window or without one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "edit/settings.h"
#include "scene/load.h"
#include "sets/kept.h"

namespace astrosplat {

struct ViewerOptions {
    std::filesystem::path input;          // scene, picture, mesh or splat file; empty: the demo
    std::vector<Assignment> assignments;  // --set
    SetCache cache;
    std::string program;                              // this very program's file, which does the jobs
    bool threads_given = false, cache_given = false;  // by the command line, which wins over the settings
    MachineLimits limits = {};                        // of jobs; run_viewer() takes them from the settings
};

}  // namespace astrosplat
