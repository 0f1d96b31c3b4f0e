// Where along each line of sight the light of a body of revolution is, for splats that stay on theirs. In:
// the rings found in a picture, and its light. Out: depths by the share of the light that lies behind them,
// and which colours shine there.
#pragma once

#include <glm/vec3.hpp>

#include "bodies/axis_fit.h"
#include "core/image.h"

namespace astrosplat {

struct AxisDepths {
    AxisFit fit;
    double width = 0.0;  // of the picture, texels
    /// By lines of sight over the picture, texels towards the viewer: where 0, 1/steps, 2/steps .. 1 of the
    /// light lies behind.
    static constexpr int steps = 64;
    Image depths;
    Image seen;     // RGB, of the rings along each line
    Image residue;  // 0..1 of the picture's light there, which the rings are not

    /// Of a place of the picture in texels, at a share 0..1.
    float depth(float x, float y, float share) const;
    float residue_at(float x, float y) const;
    /// By which a splat at a depth, which has the colour of its line, is to be multiplied, so that it shines
    /// as the rings there do and its line as the picture does.
    glm::vec3 tint(float x, float y, float z) const;
};

/// `light`: RGB, linear, that of the fit; of a picture so many texels wide, 0: its own. The same bits with
/// any number of threads.
AxisDepths make_axis_depths(AxisFit fit, const Image& light, std::int64_t width = 0);

}  // namespace astrosplat
