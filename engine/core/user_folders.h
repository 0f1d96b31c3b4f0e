// Where a person's own files of the program lie, as the XDG base directory specification has it.
#pragma once

#include <filesystem>

namespace astrosplat {

/// $XDG_STATE_HOME/astrosplat, else ~/.local/state/astrosplat; empty without a home.
std::filesystem::path state_folder();
/// $XDG_CONFIG_HOME/astrosplat, else ~/.config/astrosplat; empty without a home.
std::filesystem::path config_folder();
/// $XDG_DATA_HOME/astrosplat, else ~/.local/share/astrosplat; empty without a home.
std::filesystem::path data_folder();
/// $XDG_CACHE_HOME/astrosplat, else ~/.cache/astrosplat; empty without a home.
std::filesystem::path cache_folder();

/// Creates it where it is missing. Throws OutputError.
void make_folder(const std::filesystem::path& folder);

}  // namespace astrosplat
