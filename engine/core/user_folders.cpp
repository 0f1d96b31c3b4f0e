// A relative folder in a variable does not count, says the specification.
#include "core/user_folders.h"

#include <cstdlib>

#include "core/error.h"

namespace astrosplat {
namespace fs = std::filesystem;
namespace {

fs::path folder_in(const char* variable, const char* below_home) {
    const char* base = std::getenv(variable);
    if (base && fs::path(base).is_absolute()) return fs::path(base) / "astrosplat";
    const char* home = std::getenv("HOME");
    if (!home || !fs::path(home).is_absolute()) return {};
    return fs::path(home) / below_home / "astrosplat";
}

}  // namespace

fs::path state_folder() { return folder_in("XDG_STATE_HOME", ".local/state"); }
fs::path config_folder() { return folder_in("XDG_CONFIG_HOME", ".config"); }
fs::path data_folder() { return folder_in("XDG_DATA_HOME", ".local/share"); }
fs::path cache_folder() { return folder_in("XDG_CACHE_HOME", ".cache"); }

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw OutputError(folder.string() + ": cannot create this folder: " + error.message());
}

}  // namespace astrosplat
