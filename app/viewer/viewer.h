// The viewer's two ways in: a window, or one picture of what the window would show. In: what the command line
// asks for. Out: the exit code. Where no OpenGL context can be had, one line that names --batch.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "generate/set_cache.h"
#include "scene/load.h"

namespace astrosplat {

struct ViewerOptions {
    std::filesystem::path input;          // scene, picture, mesh or splat file; empty: the demo
    std::vector<Assignment> assignments;  // --set
    SetCache cache;
};
/// Once `interrupted`, throws Cancelled; an autosave with what was not saved stays.
int run_viewer(const ViewerOptions& options, const std::atomic<bool>& interrupted);

struct ScreenshotOptions {
    ViewerOptions scene;
    std::filesystem::path output;      // .png, or .exr without `ui`
    std::optional<std::string> size;   // "960x540" px: of the picture, with `ui` of the window
    std::optional<std::string> frame;  // default: the first
    bool ui = false;                   // with the panels
    bool settled = false;              // the final picture
    bool opengl = false;               // the preview drawn by OpenGL where the processor would be faster
};
/// Throws InputError, OutputError.
int run_screenshot(const ScreenshotOptions& options);

}  // namespace astrosplat
