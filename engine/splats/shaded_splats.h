// A layer's splats after the look: what is drawn, still in layer space. In ascending order of id.
#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/buffer.h"

namespace astrosplat {

struct ShadedSplats {
    Buffer<glm::vec3> position;  // scene units, layer space
    Buffer<glm::vec3> color;     // linear light, straight, >= 0; all below 0: it absorbs, see RenderLayer
    Buffer<float> alpha;         // 0..1
    Buffer<float> radius;        // scene units, where the falloff reaches zero
    Buffer<std::uint64_t> id;
    /// Empty: all are balls. Else of each splat: what the ball becomes, around its centre, layer space.
    Buffer<glm::mat3> stretch;
    bool encoded = false;  // colours are display values (sRGB), composited as such: of isolated layers only

    std::int64_t size() const { return static_cast<std::int64_t>(position.size()); }
};

/// Calls visit(array) for all but stretch, which look/view_dependent.h adds.
template <class Visit>
void for_each_array(ShadedSplats& splats, const Visit& visit) {
    visit(splats.position);
    visit(splats.color);
    visit(splats.alpha);
    visit(splats.radius);
    visit(splats.id);
}

}  // namespace astrosplat
