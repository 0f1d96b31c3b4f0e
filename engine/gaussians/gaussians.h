// A scene's splats as the Gaussians that other programs draw (3D Gaussian Splatting). In: shaded layers, a
// camera and an exposure. Out: Gaussians in world space, which are laid over each other.
#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "camera/camera.h"
#include "core/buffer.h"
#include "render/frame.h"
#include "splats/harmonics.h"

namespace astrosplat {

/// Some Gaussians whose harmonics are of one set.
struct HarmonicsSource {
    std::size_t begin = 0, end = 0;
    bool display = false;  // they give display values (sRGB); else linear light
    glm::dmat3 turn{1.0};  // of their axes to the world's
};

/// A Gaussian's weight is alpha e^(-d^2 / 2), d the distance from its centre on the frame in its own standard
/// deviations there.
struct Gaussians {
    Buffer<glm::vec3> position;  // scene units, world space
    Buffer<glm::vec3> color;     // straight; linear light until encode_for_display. 0..1 but of captures
    Buffer<float> alpha;         // 0..1, of the centre, > 0
    Buffer<glm::vec3> scale;     // standard deviations along its own axes, scene units
    Buffer<glm::vec4> rotation;  // of these: unit quaternion x y z w
    /// Empty: all look alike from everywhere. Else the colour of each by direction, in world axes and the
    /// space of `color`, up to `degree`; until finish_harmonics as their files have them.
    Buffer<Harmonics> harmonics;
    int degree = 0;                        // 0 to 3
    std::vector<HarmonicsSource> sources;  // in ascending order; Gaussians of none have no directions

    std::int64_t size() const { return static_cast<std::int64_t>(position.size()); }
};

/// The Gaussian that stands for a dot of alpha 1 and radius 1.
struct GaussianProfile {
    double peak = 1.0;   // of its weight; above 1 where the dot has a flat middle
    double sigma = 0.3;  // radii
};

/// Of all Gaussians with the integral I of w over the disc, the nearest in L2. With k = 1 / (2 sigma^2) it is
/// (I k / pi) e^(-k t^2), and its distance from w, but for what does not depend on k, is
///     I^2 k / (2 pi) - (2 I k / pi) Integral of w(t) e^(-k t^2) over the disc,
/// whose least value is searched. A constant dot gives k = ln 4; a gaussian one nearly its own sharpness.
GaussianProfile nearest_gaussian(const Falloff& falloff);

/// What became of the splats.
struct BakeCounts {
    std::int64_t unseen = 0;        // left out: no light, and they hide nothing
    std::int64_t bright = 0;        // of colours above 1 that no alpha could hold: light was lost
    std::int64_t dust = 0;          // absorb by channels; here all alike
    std::int64_t faint = 0;         // of alpha below 1/255, which some programs do not draw
    double flux = 0.0, lost = 0.0;  // luminance over the splats' discs, square scene units

    double share_lost() const { return flux > 0.0 ? lost / flux : 0.0; }
};

/// Appends a layer's splats; `gain` multiplies their light. The Gaussian of a splat has its integral: where
/// the peak of what it hides would exceed 1, it is 1 and the Gaussian is wider. Readers know one blend, over:
/// its alpha is what the splat hides under the layer's blend (add nothing, screen its colour, hybrid as seen
/// from the camera), but never less than its light needs with colours of at most 1. Stars have no size in
/// the scene: none may be given. Gaussians keep their shape, and their colour also beyond 1; it is the one
/// seen from the camera, and their harmonics are kept beside it (harmonics_export.h).
void bake_layer(const RenderLayer& layer, const Camera& camera, double gain, Gaussians& out,
                BakeCounts& counts);

/// Colours as a display shows them, for readers that blend those.
void encode_for_display(Gaussians& gaussians);

}  // namespace astrosplat
