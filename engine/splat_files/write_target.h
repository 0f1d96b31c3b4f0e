// Where a splat file goes. In: a path, and whether a file of that name may be replaced.
#pragma once

#include <filesystem>
#include <utility>

#include "core/atomic_file.h"

namespace astrosplat {

struct WriteTarget {
    /// A path alone is a file that may be replaced.
    WriteTarget(std::filesystem::path path, Existing when_there = Existing::replace)
        : file(std::move(path)), existing(when_there) {}

    std::filesystem::path file;
    Existing existing;  // keep: AlreadyExists is thrown, also where it came while we wrote
};

}  // namespace astrosplat
