// new: writes a first scene around a picture, of bodies in depth or of columns on a shape. Prints results to
// stdout, everything else to stderr, and returns the exit code.
#pragma once

#include <filesystem>
#include <string>

#include "exit_code.h"

namespace astrosplat {

struct NewOptions {
    std::filesystem::path image;
    std::filesystem::path scene;  // empty: the picture's name with .toml, in the working folder
    std::string as;               // an object of the sky, or plane; empty: chosen by looking at the picture
    std::string shape;            // of a scene of columns; empty: a scene of bodies
    bool film = false;
    bool overwrite = false;
};
int run_new(NewOptions options);

}  // namespace astrosplat
