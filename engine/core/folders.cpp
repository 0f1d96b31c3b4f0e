// Folders by environment variables, assets by name, temporary folders. A relative folder in a variable does
// not count, as the XDG specification says.
#include "core/folders.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <set>
#include <string>
#include <system_error>

#include "core/error.h"
#include "core/file.h"

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

fs::path assets_folder(const std::string& name) {
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
    for (const fs::path& assets :
         {program.parent_path().parent_path() / "share/astrosplat/assets", fs::path(ASTROSPLAT_ASSETS)})
        if (fs::is_directory(assets / name, ignored)) return assets / name;
    return {};
}

fs::path own_assets_folder(const std::string& name) {
    const fs::path folder = data_folder();
    return folder.empty() ? folder : folder / name;
}

fs::path find_by_name(const std::string& folder, const fs::path& wanted) {
    std::error_code ignored;
    if (wanted.filename().empty() || wanted.has_extension() || fs::exists(wanted, ignored)) return wanted;
    const fs::path file = wanted.filename().string() + ".toml";
    for (const fs::path& place : {wanted.parent_path(), own_assets_folder(folder), assets_folder(folder)})
        if (fs::is_regular_file(place / file, ignored)) return place / file;
    return wanted;
}

std::vector<std::string> names_in(const std::string& folder) {
    std::set<std::string> names;
    for (const fs::path& place : {own_assets_folder(folder), assets_folder(folder)})
        for (const fs::path& entry : entries_of(place))
            if (entry.extension() == ".toml") names.insert(entry.stem().string());
    return {names.begin(), names.end()};
}

std::filesystem::path make_temporary_folder() {
    std::error_code error;
    const std::filesystem::path place = std::filesystem::temp_directory_path(error);
    if (error) throw OutputError(fmt::format("no folder for temporary files: {}", error.message()));
    std::string pattern = (place / "astrosplat-XXXXXX").string();
    if (!mkdtemp(pattern.data()))
        throw OutputError(
            fmt::format("{}: no folder can be made there: {}", place.string(), std::strerror(errno)));
    return pattern;
}

TemporaryFolder::TemporaryFolder() : path_(make_temporary_folder()) {}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace astrosplat
