#include "core/temporary_folder.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include "core/error.h"

namespace astrosplat {

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
