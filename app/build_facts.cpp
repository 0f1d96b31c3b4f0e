#include "build_facts.h"

#include <fmt/format.h>

#include "core/vector_target.h"

namespace astrosplat {
namespace {

#if defined(__clang__)
constexpr const char* compiler = "Clang " __clang_version__;
#else
constexpr const char* compiler = "GCC " __VERSION__;
#endif

}  // namespace

std::string version_text() {
    return fmt::format(
        "astrosplat {}\n"
        "commit {}\n"
        "built with {}, {}\n"
        "libraries {}\n"
        "instructions {}\n",
        ASTROSPLAT_VERSION, built_commit, compiler, ASTROSPLAT_BUILD_KIND, ASTROSPLAT_LIBRARIES,
        vector_target());
}

}  // namespace astrosplat
