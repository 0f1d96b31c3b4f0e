// new: writes a first scene around a picture. Prints results to stdout, everything else to stderr, and
// returns the exit code.
#pragma once

#include <filesystem>
#include <string>

#include "exit_code.h"

namespace astrosplat {

struct NewOptions {
    std::filesystem::path image, scene;
    std::string shape = "plane";
    bool overwrite = false;
};
int run_new(const NewOptions& options);

}  // namespace astrosplat
