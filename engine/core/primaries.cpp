// Chromaticities to XYZ, Bradford's adaptation between two whites, and back. In: chromaticities. Out: 3x3
// matrices.
#include "core/primaries.h"

#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

namespace astrosplat {
namespace {

// XYZ of a chromaticity at Y = 1.
glm::dvec3 xyz_of(const glm::dvec2& c) { return {c.x / c.y, 1.0, (1.0 - c.x - c.y) / c.y}; }

glm::dmat3 diagonal(const glm::dvec3& d) {
    return {glm::dvec3(d.x, 0, 0), glm::dvec3(0, d.y, 0), glm::dvec3(0, 0, d.z)};
}

// The primaries in XYZ, each as bright as lets their sum be the white.
glm::dmat3 to_xyz(const Chromaticities& set) {
    const glm::dmat3 directions(xyz_of(set.red), xyz_of(set.green), xyz_of(set.blue));
    return directions * diagonal(glm::inverse(directions) * xyz_of(set.white));
}

glm::dmat3 adaptation(const glm::dvec2& from_white, const glm::dvec2& to_white) {
    const glm::dmat3 cones({0.8951, -0.7502, 0.0389}, {0.2664, 1.7135, -0.0685},
                           {-0.1614, 0.0367, 1.0296});  // by columns
    const glm::dvec3 from = cones * xyz_of(from_white), to = cones * xyz_of(to_white);
    return glm::inverse(cones) * diagonal(to / from) * cones;
}

}  // namespace

glm::dmat3 primaries_matrix(const Chromaticities& from, const Chromaticities& to) {
    return glm::inverse(to_xyz(to)) * adaptation(from.white, to.white) * to_xyz(from);
}

}  // namespace astrosplat
