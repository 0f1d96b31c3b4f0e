// In which pixels the light of stars was measured: those of a picture that they were found in. Plain values.
#pragma once

#include <glm/vec3.hpp>

namespace astrosplat {

/// Without either side the light of a star is that over all pixels of any frame, as seen from the layer's
/// origin. Else it is that over the pixels of a picture, of which a frame's own may be more or fewer: they
/// are squares of these sides at the star, as they are for the splats that the same picture was made into.
struct StarPixels {
    glm::dvec3 from{0.0};    // layer space: where rays meet
    double side_at_1 = 0.0;  // scene units, at a distance of 1 from there
    double side = 0.0;       // scene units, at any distance: rays are parallel
    bool are_known() const { return side_at_1 > 0.0 || side > 0.0; }
    bool operator==(const StarPixels&) const = default;
};

}  // namespace astrosplat
