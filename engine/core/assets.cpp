#include "core/assets.h"

#include <system_error>

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

}  // namespace astrosplat
