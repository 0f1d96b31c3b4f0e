// A relative folder in a variable does not count, says the specification.
#include "edit/user_folders.h"

#include <cstdlib>

#include "core/error.h"

namespace astrosplat {
namespace fs = std::filesystem;
namespace {

fs::path folder_in(const char* variable, const char* below_home) {
    const char* base = std::getenv(variable);
    if (base && fs::path(base).is_absolute()) return fs::path(base) / "astrosplat";
    const char* home = std::getenv("HOME");
    if (!home || !*home) return {};
    return fs::path(home) / below_home / "astrosplat";
}

}  // namespace

fs::path state_folder() { return folder_in("XDG_STATE_HOME", ".local/state"); }
void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw OutputError(folder.string() + ": cannot create this folder: " + error.message());
}

fs::path config_folder() { return folder_in("XDG_CONFIG_HOME", ".config"); }

}  // namespace astrosplat
