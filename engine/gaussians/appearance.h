// How a splat looks on a frame, blend and exposure applied, as a Gaussian. In: a shaded layer, a camera and
// an exposure. Out: what each of its splats shows, hides and shines, for what is written for other programs.
#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "camera/camera.h"
#include "gaussians/gaussians.h"
#include "render/frame.h"

namespace astrosplat {

/// Values hold at the centre; elsewhere on the frame they fall as e^(-d^2 / 2), d in standard deviations.
/// Above 1 where a dot has a flat middle, whose integral the Gaussian has.
struct SplatAppearance {
    glm::dvec3 place{0.0};  // scene units, world space
    double sigma = 0.0;     // standard deviation of the ball, scene units
    double shows = 0.0;     // its own opacity
    double hides = 0.0;     // of what lies behind it, by its layer's blend
    glm::dvec3 light{0.0};  // linear, exposed
};

class LayerAppearance {
  public:
    /// `gain` multiplies light. The layer and the camera must outlive this. Stars have no size in the scene:
    /// none may be given.
    LayerAppearance(const RenderLayer& layer, const Camera& camera, double gain);

    /// Of the layer's splat i; dust that absorbs by channels is counted.
    SplatAppearance of(std::size_t i, BakeCounts& counts) const;
    /// World axes that the ball of standard deviation 1 becomes, as columns: a turn where splats are balls.
    glm::dmat3 axes_of(std::size_t i) const;

  private:
    struct Blended {
        float hides = 1.0f;
        glm::vec3 light{0.0f};
    };
    Blended blended(const glm::vec3& color, float s, const glm::dvec3& place, BakeCounts& counts) const;
    float hybrid(const glm::dvec3& place) const;

    const RenderLayer& layer_;
    const Camera& camera_;
    float gain_;
    GaussianProfile profile_;
    glm::dvec3 axis_;
};

}  // namespace astrosplat
