// What comes with the program: demo scenes, looks, pictures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace astrosplat {

/// Folder `name` ("looks", "scenes") of the assets installed beside the program, else of the source tree that
/// it was built from; empty where neither is there.
std::filesystem::path assets_folder(const std::string& name);

/// $XDG_DATA_HOME/astrosplat/NAME, else ~/.local/share/astrosplat/NAME: a person's own; empty without a home.
std::filesystem::path own_assets_folder(const std::string& name);

/// The TOML file that a short name means: where there is no file `wanted` and it has no ending, NAME.toml
/// beside it, in the person's own folder, or among the assets, whichever is there first; else `wanted`.
std::filesystem::path find_by_name(const std::string& folder, const std::filesystem::path& wanted);

/// Short names that are known in `folder` besides those beside a scene, sorted.
std::vector<std::string> names_in(const std::string& folder);

}  // namespace astrosplat
