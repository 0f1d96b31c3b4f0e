#include "edit/placement.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/real.h"
#include "core/rotation.h"

namespace astrosplat {
namespace {

double nearest_turn(double degrees, double near) {
    return degrees + 360.0 * std::round((near - degrees) / 360.0);
}

glm::dvec3 nearest_turns(const glm::dvec3& degrees, const glm::dvec3& near) {
    return {nearest_turn(degrees.x, near.x), nearest_turn(degrees.y, near.y),
            nearest_turn(degrees.z, near.z)};
}

}  // namespace

LayerPlacement placement_of(const LayerTransform& transform) {
    return {rotation_from_degrees(transform.rotate), transform.scale, transform.translate};
}

glm::dvec3 to_world(const LayerPlacement& placement, const glm::dvec3& in_layer) {
    return placement.rotation * (placement.scale * in_layer) + placement.translate;
}

glm::dvec3 to_layer(const LayerPlacement& placement, const glm::dvec3& in_world) {
    return glm::transpose(placement.rotation) * (in_world - placement.translate) / placement.scale;
}

glm::dvec3 degrees_of(const glm::dmat3& r, const glm::dvec3& near) {
    const auto degrees = [](double y, double x) { return real::degrees(real::atan2(y, x)); };
    // r[column][row]; r = about z * about y * about x.
    const double cosine_y = std::hypot(r[0][0], r[0][1]);
    if (cosine_y < 1e-9) {  // x and z turn about the same line: x stays
        const double x = real::radians(near.x);
        const double turn = real::atan2(-r[1][0], r[1][1]);
        const glm::dvec3 found(near.x, degrees(-r[0][2], cosine_y),
                               real::degrees(turn + (r[0][2] < 0.0 ? x : -x)));
        return nearest_turns(found, near);
    }
    const glm::dvec3 one(degrees(r[1][2], r[2][2]), degrees(-r[0][2], cosine_y), degrees(r[0][1], r[0][0]));
    const glm::dvec3 a = nearest_turns(one, near);
    const glm::dvec3 b = nearest_turns({one.x + 180.0, 180.0 - one.y, one.z + 180.0}, near);
    return glm::length(a - near) <= glm::length(b - near) ? a : b;
}

glm::dmat3 rotation_about(const glm::dvec3& axis, double radians) {
    const double c = real::cos(radians), s = real::sin(radians);
    glm::dmat3 turned;
    for (int i = 0; i < 3; ++i) {
        glm::dvec3 unit(0.0);
        unit[i] = 1.0;
        turned[i] = unit * c + glm::cross(axis, unit) * s + axis * (glm::dot(axis, unit) * (1.0 - c));
    }
    return turned;
}

}  // namespace astrosplat
