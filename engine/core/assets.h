// What comes with the program: demo scenes, looks, pictures.
#pragma once

#include <filesystem>
#include <string>

namespace astrosplat {

/// Folder `name` ("looks", "scenes") of the assets installed beside the program, else of the source tree that
/// it was built from; empty where neither is there.
std::filesystem::path assets_folder(const std::string& name);

}  // namespace astrosplat
