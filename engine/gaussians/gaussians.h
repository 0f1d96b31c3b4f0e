// A scene's splats as the Gaussians that other programs draw (3D Gaussian Splatting). In: shaded layers, a
// camera and an exposure. Out: Gaussians in world space, which are laid over each other; fewer splats in the
// place of many before, and colours that look right where readers blend display values after.
// Also how each splat looks on a frame, as a Gaussian, for whatever is written for other programs.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "camera/camera.h"
#include "core/buffer.h"
#include "core/image.h"
#include "core/progress.h"
#include "render/frame.h"
#include "splats/harmonics.h"

namespace astrosplat {

/// Some Gaussians whose harmonics are of one set.
struct HarmonicsSource {
    std::size_t begin = 0, end = 0;
    bool display = false;  // they give display values (sRGB); else linear light
    glm::dmat3 turn{1.0};  // of their axes to the world's
};

/// How many there are of degree 0 to `degree`.
constexpr std::size_t harmonics_up_to(int degree) { return std::size_t((degree + 1) * (degree + 1)); }

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
    std::string credit, origin;            // of the inputs; what is measured and what is invented

    std::int64_t size() const { return std::int64_t(position.size()); }
    std::size_t harmonics_each() const { return harmonics_up_to(degree); }
};

/// The Gaussian that stands for a splat of alpha 1 and radius 1.
struct GaussianProfile {
    double peak = 1.0;   // of its weight; above 1 where the splat has a flat middle
    double sigma = 0.3;  // radii
};

/// Of all Gaussians with the integral I of w over the disc, the nearest in L2. With k = 1 / (2 sigma^2) it is
/// (I k / pi) e^(-k t^2), and its distance from w, but for what does not depend on k, is
///     I^2 k / (2 pi) - (2 I k / pi) Integral of w(t) e^(-k t^2) over the disc,
/// whose least value is searched. A constant splat gives k = ln 4; a gaussian one nearly its own sharpness.
GaussianProfile nearest_gaussian(const Falloff& falloff);

/// Splats that are left out or lose something, counted.
struct BakeCounts {
    std::int64_t unseen = 0;        // left out: no light, and they hide nothing
    std::int64_t bright = 0;        // of colours above 1 that no alpha could hold: light was lost
    std::int64_t dust = 0;          // absorb by channels; here all alike
    std::int64_t faint = 0;         // of alpha below 1/255, which some programs do not draw
    double flux = 0.0, lost = 0.0;  // luminance over the splats' discs, square scene units

    double share_lost() const { return flux > 0.0 ? lost / flux : 0.0; }
};

/// How a splat looks on a frame, blend and exposure applied. Values hold at the centre; elsewhere on the
/// frame they fall as e^(-d^2 / 2), d in standard deviations. Above 1 where a splat has a flat middle, whose
/// integral the Gaussian has.
struct SplatAppearance {
    glm::dvec3 place{0.0};  // scene units, world space
    double sigma = 0.0;     // standard deviation of the ball, scene units
    double shows = 0.0;     // its own opacity
    double hides = 0.0;     // of what lies behind it, by its layer's blend
    glm::dvec3 light{0.0};  // linear, exposed
};

/// How much each splat of a shaded layer shows, hides and shines.
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

/// Appends a layer's splats; `gain` multiplies their light. The Gaussian of a splat has its integral: where
/// the peak of what it hides would exceed 1, it is 1 and the Gaussian is wider. Readers know one blend, over:
/// its alpha is what the splat hides under the layer's blend (add nothing, screen its colour, hybrid as seen
/// from the camera), but never less than its light needs with colours of at most 1. Stars have no size in
/// the scene: none may be given. Gaussians keep their shape, and their colour also beyond 1; it is the one
/// seen from the camera, and the harmonics of their set are kept alongside, for finish_harmonics().
void bake_layer(const RenderLayer& layer, const Camera& camera, double gain, Gaussians& out,
                BakeCounts& counts);

/// Colours as a display shows them, for readers that blend those.
void encode_for_display(Gaussians& gaussians);

/// Brings harmonics to what their Gaussians' colours became, as a camera sees them. A look is no operator on
/// harmonics: what it did to a Gaussian is known in the one direction that the frame sees it from, and there
/// the result is exact. To all others the factors of that direction are applied, channel by channel: exact
/// for a look that scales linear light where harmonics are linear, and for none at all. `encoded`: these are
/// display values. Harmonics of the other space are evaluated all around, converted, and fitted again in the
/// same degree: nearest in the mean over all directions, and exact in the camera's by the least change over
/// all. A factor ends at four times that of the three channels together, which also stands for those where
/// the source is dark: nothing else says what the look does there.
void finish_harmonics(Gaussians& gaussians, const Camera& camera, bool encoded);

/// Changes colours, and alphas where colours would exceed 1, until the encoded Gaussians laid over each other
/// as they are look from the camera like `wanted` on black, encoded: piles of faint splats would be too dark.
/// `wanted` is a frame of `settings`, linear light with the gain in it.
void fit_to_view(Gaussians& gaussians, const Image& wanted, const Camera& camera,
                 const RenderSettings& settings);

/// Fewer splats, by the preview's tree (merge/README.md): at most `count` of all layers together, which
/// stand for all of them, seen from everywhere; those of layer i at place i, with its opacity in their
/// alphas; where the layers have no more than that, a copy of them. Their size is judged along the view of
/// `world_from_camera` (right, up, back), all as if equally far, so that no side of the model is coarser and
/// nothing is left out. `count` is at least 1. Throws InputError (memory), Cancelled.
std::vector<ShadedSplats> reduce_splats(std::span<const RenderLayer> layers,
                                        const glm::dmat3& world_from_camera, std::int64_t count,
                                        const Progress& progress = {});

}  // namespace astrosplat
