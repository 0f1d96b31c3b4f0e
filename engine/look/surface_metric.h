// How wide a footprint is in u and v about a place of a mesh, from a sample of the positions there. In:
// places with their u and v. Out: three numbers.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace astrosplat {

struct SurfaceSample {
    glm::dvec2 at{0.0};            // u and v
    glm::dvec3 place{0.0};         // scene units
    double light = 0.0, r2 = 0.0;  // how much of a splat is expected there, and its squared radius
};
using SurfaceSamples = std::vector<SurfaceSample>;

struct SurfaceMetric {
    double sigma_u = 0.0, sigma_v = 0.0;  // standard deviations of a footprint, in units of u and v
    double area = 0.0;                    // square scene units under a unit square of u and v; 0: not known
};

/// Of the part of the surface about the sample that is nearest to `middle` in u and v. `falloff_variance`:
/// along an axis, square radii. Reorders the samples.
SurfaceMetric surface_metric(SurfaceSamples& samples, const glm::dvec2& middle, double falloff_variance);

}  // namespace astrosplat
