// camera: writes the scene's camera into a file for other programs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace astrosplat {

struct CameraOptions {
    std::filesystem::path scene, output;
    std::optional<std::string> frames;
    std::vector<std::string> assignments;
    bool overwrite = false;
};

/// Prints a line on stdout and returns the exit code. Throws InputError, OutputError.
int run_camera(const CameraOptions& options);

}  // namespace astrosplat
