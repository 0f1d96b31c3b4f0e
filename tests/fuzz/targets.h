// The readers that take files from strangers, each behind one function from bytes to "fine" or InputError.
// Shared by the libFuzzer programs (fuzz_reader.cpp) and by the replay test that runs in every build.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace astrosplat::fuzz {

struct Target {
    std::string name;                // also the file ending
    std::vector<std::string> seeds;  // small valid files
    /// Reads the bytes as a file, checks what came out and returns how much that is: splats, triangles,
    /// stars. Throws InputError for bad input; anything else is a bug.
    std::size_t (*read)(std::string_view bytes);
};

/// pda, ply, splats, obj, toml, fits, stars, cameras, gaussian_ply, gltf.
const std::vector<Target>& targets();
const Target& target(const std::string& name);

/// Throws std::logic_error, an error no reader may end with.
void demand(bool truth, const char* what);

}  // namespace astrosplat::fuzz
