// Lines of the world that the window draws over a view: boxes of layers, a grid, axes. In: boxes. Out: lines
// and what they stand for.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "core/bounds.h"
#include "edit/view_state.h"
#include "scene/scene.h"

namespace astrosplat {

struct MarkLine {
    glm::dvec3 from, to;  // world space
};

/// The twelve edges of a box of layer space, placed as the layer is.
std::vector<MarkLine> box_edges(const Bounds& box, const LayerTransform& transform);

/// Lines around the scene's box at whole multiples of `spacing`, which is 1, 2 or 5 times a power of ten: in
/// the plane that the view faces, for others in the horizontal one. The plane goes through the origin, or
/// where the box does not reach it along the nearest side of the box.
struct Grid {
    double spacing = 1.0;  // scene units
    std::vector<MarkLine> lines;
};
Grid grid_around(const Bounds& box, ViewKind view);

/// From the origin along x, y and z, half as long as the box's longest side.
std::array<MarkLine, 3> axis_lines(const Bounds& box);

}  // namespace astrosplat
