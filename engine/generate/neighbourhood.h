// How much room there is near meshes, which tells how many positions a lattice keeps. In: meshes and a box.
// Out: volumes, measured with a coarse lattice.
#pragma once

#include <span>

#include "core/bounds.h"
#include "source/textured_mesh.h"

namespace astrosplat {

/// Of the box, cubic scene units.
struct Neighbourhood {
    double volume = 0.0;  // within the distance of a surface
    double lit = 0.0;     // that part of it whose closest point has an alpha above 0
};

/// Measures it, within about 1 %: thin meshes, rims and overlaps make it differ from twice the area times the
/// distance. Zeros where the box has no extent along an axis, or is too large for what is in it.
Neighbourhood measure_neighbourhood(std::span<const TexturedMesh> meshes, const Bounds& box,
                                    double max_distance);

}  // namespace astrosplat
