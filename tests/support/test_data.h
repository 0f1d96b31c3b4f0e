// Where the real test data lies: $ASTROSPLAT_TEST_DATA, else ../shared/data beside the source tree. A test
// whose data is absent skips with a message; it never passes silently.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace astrosplat {

/// The file or folder `relative` below the test data, if it is there.
inline std::optional<fs::path> test_data(const std::string& relative) {
    namespace fs = std::filesystem;
    const char* variable = std::getenv("ASTROSPLAT_TEST_DATA");
    const fs::path root =
        variable ? fs::path(variable) : fs::path(ASTROSPLAT_SOURCE_DIR).parent_path() / "shared" / "data";
    const fs::path path = root / relative;
    if (!fs::exists(path)) return std::nullopt;
    return path;
}

}  // namespace astrosplat

/// In a test body: `name` is the path, or the test is skipped.
#define ASTROSPLAT_TEST_DATA_OR_SKIP(name, relative)                                                    \
    const std::optional<fs::path> name##_found = astrosplat::test_data(relative);                       \
    if (!name##_found) GTEST_SKIP() << "no test data '" << (relative) << "'; set ASTROSPLAT_TEST_DATA"; \
    const fs::path name = *name##_found
