// Other programs and files that the viewer uses where they are there.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace astrosplat {

/// A program of this name on the PATH.
std::optional<std::filesystem::path> find_program(const std::string& name);

/// The demo scene: in the assets installed beside the program, else in the source tree it was built from;
/// empty where neither is there.
std::filesystem::path demo_scene_file();

}  // namespace astrosplat
