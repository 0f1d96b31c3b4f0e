// Where a layer is in the world, and the way back: world = rotation * (scale * p) + translate, as
// LayerTransform says it in degrees.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "scene/scene.h"

namespace astrosplat {

struct LayerPlacement {
    glm::dmat3 rotation{1.0};  // world from layer
    double scale = 1.0;
    glm::dvec3 translate{0.0};  // scene units
};

LayerPlacement placement_of(const LayerTransform& transform);
glm::dvec3 to_world(const LayerPlacement& placement, const glm::dvec3& in_layer);
glm::dvec3 to_layer(const LayerPlacement& placement, const glm::dvec3& in_world);

/// Degrees about x, then y, then z of a rotation: those nearest to `near`, which say it as well.
glm::dvec3 degrees_of(const glm::dmat3& rotation, const glm::dvec3& near);

/// By the right-hand rule; `axis` of length 1.
glm::dmat3 rotation_about(const glm::dvec3& axis, double radians);

}  // namespace astrosplat
