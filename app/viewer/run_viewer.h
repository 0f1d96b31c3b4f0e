// The viewer in a window, or a picture of it without a display. In: what the command line asks for. Out: the
// exit code. Where no OpenGL context can be had, one line that names --batch.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>

#include "viewer/viewer_options.h"

namespace astrosplat {

struct ScreenshotOptions {
    ViewerOptions scene;
    std::filesystem::path output;      // .png, or .exr without `ui`
    std::optional<std::string> size;   // "960x540" px: of the frame, with `ui` of the window
    std::optional<std::string> frame;  // default: the first
    bool ui = false;                   // with the panels
    bool settled = false;              // the final frame
    bool opengl = false;               // the preview drawn by OpenGL where the processor would be faster
};

/// Once `interrupted`, throws Cancelled; an autosave with what was not saved stays.
int run_viewer(const ViewerOptions& options, const std::atomic<bool>& interrupted);
/// One frame of what the window would show: the viewport alone, or with the panels. Throws InputError,
/// OutputError.
int run_screenshot(const ScreenshotOptions& options);

}  // namespace astrosplat
