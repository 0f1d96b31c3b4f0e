// Paths and files of the standard library by the short name that all of the program uses.
#pragma once

#include <filesystem>

namespace astrosplat {

namespace fs = std::filesystem;

}  // namespace astrosplat
