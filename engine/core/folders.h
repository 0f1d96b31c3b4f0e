// Folders: of a person's own files of the program, as the XDG base directory specification has it; of the
// files that come with the program (demo scenes, looks, pictures); and temporary ones.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

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

/// Makes a folder where the system keeps temporary files; it stays. Throws OutputError when there can be
/// none.
std::filesystem::path make_temporary_folder();

/// Such a folder, removed with all that is in it.
class TemporaryFolder {
  public:
    /// Throws OutputError when there can be none.
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace astrosplat
