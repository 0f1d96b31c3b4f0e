// How much of a star's light arrives at the camera of its picture, past the splats before it. In: stars, the
// splats of the layer they lie in, and the camera. Out: what passes; and stars that hardly any light of would
// pass, moved before what hides them.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "camera/camera.h"
#include "core/progress.h"
#include "splats/splat_set.h"

namespace astrosplat {

struct FrontView {
    Camera camera;              // in the layer's own space
    double height_px = 1080.0;  // of what it shows
    double filter_px = 0.5;     // standard deviation of the pixel filter
    double star_px = 1.0;       // the same of a star's image
};

/// At least so much of a star's light passes: one farther back moves along its ray to where it does.
inline constexpr double least_passing = 0.95;

/// Share of the light of each star that arrives, red, green and blue; `position` may change. The splats have
/// radii and alphas of their own and the default falloff: those of bodies. The same bits with any number of
/// threads. Throws Cancelled.
std::vector<glm::dvec3> passing_light(const FrontView& view, const SplatSet& splats,
                                      std::vector<glm::vec3>& position, const Progress& progress = {});

}  // namespace astrosplat
