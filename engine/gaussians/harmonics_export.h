// Colours by direction on their way into files. In: a layer of Gaussians with harmonics, and what the look
// and the frame made of the colour that its camera sees. Out: harmonics of the same degree, whose colours are
// the source's times what became of that one.
//
// A look is no operator on harmonics. What it did to a Gaussian is known in the one direction that the frame
// sees it from: there the result is exact. To all others the factors of that direction are applied, channel
// by channel: exact for a look that scales linear light where harmonics are linear, and for none at all.
#pragma once

#include <cstddef>

#include "camera/camera.h"
#include "gaussians/gaussians.h"

namespace astrosplat {

/// Takes the source's harmonics of a layer along while its splats are baked one after the other.
class HarmonicsTaker {
  public:
    HarmonicsTaker(const RenderLayer& layer, Gaussians& out);
    /// Of splat i, if it became the last Gaussian of `out`.
    void take(std::size_t i, Gaussians& out);

  private:
    const RenderLayer& layer_;
    std::size_t row_ = 0, taken_ = 0;
};

/// Brings harmonics to what their Gaussians' colours became, as a camera sees them. `encoded`: these are
/// display values. Harmonics of the other space are evaluated all around, converted, and fitted again in the
/// same degree: nearest in the mean over all directions, and exact in the camera's by the least change over
/// all. A factor ends at four times that of the three channels together, which also stands for those where
/// the source is dark: nothing else says what the look does there.
void finish_harmonics(Gaussians& gaussians, const Camera& camera, bool encoded);

}  // namespace astrosplat
