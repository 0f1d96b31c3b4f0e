// What Gaussians have beyond other splats: colours that depend on where they are seen from, and shapes. In: a
// set of Gaussians and what the look made of it. Out: colours for the look, and its splats with shapes.
#pragma once

#include <glm/vec3.hpp>

#include "core/buffer.h"
#include "core/progress.h"
#include "splats/shaded_splats.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// Where a layer is seen from, in its own space.
struct SeenFrom {
    glm::dvec3 eye{0.0};
    glm::dvec3 along{0.0};  // parallel rays: their direction, length 1; else 0
    bool operator==(const SeenFrom&) const = default;
};

/// Linear colours of a set with harmonics. Throws Cancelled.
Buffer<glm::vec3> seen_colors(const SplatSet& set, const SeenFrom& from, const Progress& progress = {});

/// Gives the splats that a look left of a set of Gaussians their shapes.
void add_shapes(const SplatSet& set, ShadedSplats& shaded);

/// Linear colours as a display shows them, beyond 0..1 too (sRGB), for layers that are composited so.
void encode_colors(ShadedSplats& shaded);

}  // namespace astrosplat
