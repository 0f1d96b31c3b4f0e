#include "core/assets.h"

#include <set>
#include <system_error>

#include "core/file.h"
#include "core/user_folders.h"

namespace astrosplat {
namespace fs = std::filesystem;

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

}  // namespace astrosplat
