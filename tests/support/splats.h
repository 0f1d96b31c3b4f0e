// Sets and splats for tests, splat by splat.
#pragma once

#include <glm/vec3.hpp>

#include "splats/splat_set.h"

namespace astrosplat {

/// One more splat, on its surface; its id is its number.
inline void add_splat(SplatSet& set, const glm::vec3& position, const glm::vec3& color, float alpha) {
    set.id.push_back(std::uint64_t(set.size()));
    set.position.push_back(position);
    set.color.push_back(color);
    set.alpha.push_back(alpha);
    set.distance.push_back(0.0f);
}

}  // namespace astrosplat
