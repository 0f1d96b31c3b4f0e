// Light of needles on a frame whose great circles are not straight. In: a place's axes, a thin ellipse. Out:
// what the pixels it crosses add up to beyond what they would for a straight one.
#pragma once

#include <glm/vec2.hpp>

#include "render/sphere_shape.h"

namespace astrosplat {

/// A thin gaussian on the map around a place, by its variances along and across, the pixel filter's included:
/// a needle follows a row of pixels only as far as it is straight on the frame, which great circles are not.
class BentNeedle {
  public:
    BentNeedle(const SphereAxes& axes, const Ellipse& e, double along_variance, double across_variance);
    /// By how much the relative excess of its sum over pixels differs from that of a straight one.
    double excess(float x_px, float y_px) const;

  private:
    double excess_at(double kx, double ky, double cosine, double sine) const;

    double along_, across_;
    glm::dvec2 along_px_, across_px_, bend_;
};

}  // namespace astrosplat
