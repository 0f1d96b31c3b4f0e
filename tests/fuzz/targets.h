// The readers that take files from strangers, each behind one function from bytes to "fine" or InputError.
// Shared by the libFuzzer programs (fuzz_reader.cpp) and by the replay tests that run in every build. Each
// program has the targets of one library: of files (targets.cpp), or of texts of scenes (scene_targets.cpp).
#pragma once

#include <unistd.h>

#include <fstream>
#include <ostream>
#include <stdexcept>

#include "core/standard.h"

namespace astrosplat::fuzz {

struct Target {
    std::string name;
    std::vector<std::string> (*seeds)();  // small valid files
    /// Reads the bytes as a file, checks what came out and returns how much that is: splats, triangles,
    /// stars. Throws InputError for bad input; anything else is a bug.
    std::size_t (*read)(std::string_view bytes);
    bool refuses = true;  // whether there is anything that it does not take

    friend void PrintTo(const Target& given, std::ostream* out) { *out << given.name; }
};

/// Of the library that the program has.
const std::vector<Target>& targets();

/// Throws std::logic_error, an error no reader may end with.
inline void demand(bool truth, const char* what) {
    if (!truth) throw std::logic_error(std::string("reader's result lacks ") + what);
}

inline const Target& target(const std::string& name) {
    const auto found = std::ranges::find(targets(), name, &Target::name);
    demand(found != targets().end(), "a known target");
    return *found;
}

/// A file of this process that holds the bytes while the object lives; its name ends in `ending`.
struct TemporaryFile {
    fs::path path;
    TemporaryFile(std::string_view bytes, const std::string& ending)
        : path(fs::temp_directory_path() / ("astrosplat_fuzz_" + std::to_string(::getpid()) + ending)) {
        std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
    ~TemporaryFile() { fs::remove(path); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
};

}  // namespace astrosplat::fuzz
