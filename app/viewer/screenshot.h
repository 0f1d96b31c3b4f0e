// One frame of what the window would show, without a display: the viewport alone, or with the panels. Where
// no OpenGL context can be had, one line that names --batch.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "viewer/run_viewer.h"

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
/// Throws InputError, OutputError.
int run_screenshot(const ScreenshotOptions& options);

}  // namespace astrosplat
