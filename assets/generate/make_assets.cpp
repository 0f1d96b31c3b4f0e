// astrosplat_make_assets FOLDER [whirlpool | spiral | deep_field | butterfly]: writes the demo textures and
// meshes into FOLDER/textures and FOLDER/meshes. Everything is computed from hashes; the same build writes
// the same bytes.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>

#include "assets.h"

int main(int argc, char** argv) {
    using namespace astrosplat::assets;
    if (argc < 2 || argc > 3) {
        fmt::print(stderr,
                   "usage: astrosplat_make_assets FOLDER [whirlpool | spiral | deep_field | butterfly]\n");
        return 2;
    }
    try {
        const std::filesystem::path folder = argv[1];
        const std::string only = argc == 3 ? argv[2] : "";
        std::filesystem::create_directories(folder / "textures");
        std::filesystem::create_directories(folder / "meshes");
        if (only.empty() || only == "whirlpool") make_whirlpool(folder);
        if (only.empty() || only == "spiral") make_spiral(folder);
        if (only.empty() || only == "deep_field") make_deep_field(folder);
        if (only.empty() || only == "butterfly") make_butterfly(folder);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    return 0;
}
