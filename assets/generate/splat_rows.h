// Splats written straight to a PLY file, for stars that no picture holds.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace astrosplat::assets {

struct SplatRow {
    glm::vec3 place;  // scene units
    glm::vec3 color;  // linear, straight
    float alpha;      // 0..1
    float radius;     // scene units
};

/// Binary little-endian PLY: x y z red green blue alpha radius, all float. The comment says what it is.
void save_ply(const std::vector<SplatRow>& rows, const std::filesystem::path& file, const std::string& what);

}  // namespace astrosplat::assets
