// The viewer in a window, or an image of it without a display. In: what the command line asks for. Out: the
// exit code. Where no OpenGL context can be had, one line that names --batch.
#pragma once

#include <atomic>

#include "edit/settings.h"
#include "render/device.h"
#include "scene/load.h"
#include "sets/kept.h"

namespace astrosplat {

/// The options of a session at its start, in a window or without one.
struct ViewerOptions {
    fs::path input;                       // scene, picture, mesh or splat file; empty: the demo
    std::vector<Assignment> assignments;  // --set
    SetCache cache;
    DeviceChoice device = DeviceChoice::automatic;    // that draws frames
    std::string program;                              // this very program's file, which does the jobs
    bool threads_given = false, cache_given = false;  // by the command line, which wins over the settings
    MachineLimits limits = {};                        // of jobs; run_viewer() takes them from the settings
};

struct ScreenshotOptions {
    ViewerOptions scene;
    fs::path output;                   // .png, or .exr without `ui`
    std::optional<std::string> size;   // "960x540" px: of the frame, with `ui` of the window
    std::optional<std::string> frame;  // default: the first
    bool ui = false;                   // with the panels
    bool settled = false;              // the final frame
};

/// Once `interrupted`, throws Cancelled; an autosave with what was not saved stays.
int run_viewer(const ViewerOptions& options, const std::atomic<bool>& interrupted);
/// One frame of what the window would show: the viewport alone, or with the panels. Throws InputError,
/// OutputError.
int run_screenshot(const ScreenshotOptions& options);

}  // namespace astrosplat
