// The effect of lod.noise on splats close by, for a preview that does not divide them: light is where the
// children would have it, but for what is finer than the splat. In: a place in a layer. Out: a factor of its
// light.
#pragma once

#include <glm/vec3.hpp>

#include "render/project.h"

namespace astrosplat {

/// A splat, or a dot in place of many.
struct CloudPlace {
    glm::vec3 centre{0.0f}, spread{0.0f};  // and standard deviations of its light along the axes; layer space
    glm::vec3 in_camera{0.0f};             // the centre
    float radius = 0.0f;                   // of the splat, or of those that the dot stands for; layer space
    float alpha = 0.0f;
    glm::vec3 color{0.0f};
};

/// > 0; 1 where the splats would not become children, or the layer has no such noise.
float cloud_light(const LayerProjection& layer, const CloudPlace& place);

}  // namespace astrosplat
