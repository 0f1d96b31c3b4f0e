// The demo assets, one function each. In: the assets folder. Out: files under textures/ and meshes/ in it.
#pragma once

#include <filesystem>

namespace astrosplat::assets {

void make_whirlpool(
    const std::filesystem::path& folder);  // galaxy: stars, dust, nebulae, thickness, disk mesh
void make_spiral(
    const std::filesystem::path& folder);  // the galaxy on one flat picture, as a telescope saw it
void make_deep_field(const std::filesystem::path& folder);  // surrounding sky of faint galaxies
void make_butterfly(const std::filesystem::path& folder);   // bipolar nebula: two sheets, torus, star cluster

}  // namespace astrosplat::assets
