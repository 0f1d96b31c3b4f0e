// A path into keyframes. In: the place at every frame. Out: as few Bezier keyframes as follow it.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "camera/keyframe.h"

namespace astrosplat {

/// Scene units at a frame; smooth.
using PathInTime = std::function<glm::dvec3(double frame)>;

/// Keyframes at whole numbers of frames from `first` on, the last one at `last` (a whole number of frames
/// later, 1 at least). Between them the path is missed by less than `tolerance` scene units at every frame,
/// unless it takes a bend within a single one; at them, speed and direction are the path's.
std::vector<Keyframe<glm::dvec3>> fit_path(const PathInTime& path, double first, double last,
                                           double tolerance);

}  // namespace astrosplat
