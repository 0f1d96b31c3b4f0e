#include "viewer/programs.h"

#include <unistd.h>

#include <cstdlib>
#include <string_view>
#include <system_error>

#include "core/assets.h"

namespace astrosplat {

namespace fs = std::filesystem;

std::optional<fs::path> find_program(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::string_view rest = path ? path : "/usr/bin:/bin";
    while (!rest.empty()) {
        const std::size_t colon = rest.find(':');
        const fs::path candidate = fs::path(rest.substr(0, colon)) / name;
        std::error_code ignored;
        if (fs::is_regular_file(candidate, ignored) && access(candidate.c_str(), X_OK) == 0) return candidate;
        rest = colon == std::string_view::npos ? std::string_view{} : rest.substr(colon + 1);
    }
    return std::nullopt;
}

fs::path demo_scene_file() {
    const fs::path file = assets_folder("scenes") / "whirlpool.toml";
    std::error_code ignored;
    return fs::exists(file, ignored) ? file : fs::path();
}

}  // namespace astrosplat
