// A second, slow and simple renderer of captures, to compare ours with: every Gaussian at every pixel, in
// double, as 3D Gaussian Splatting describes it (Kerbl et al. 2023), but sorted by distance from the eye.
// Shares no code with the program but the camera's numbers.
#pragma once

#include <vector>

#include "camera/camera.h"
#include "core/image.h"
#include "support/capture.h"

namespace astrosplat::test {

struct EwaSettings {
    double filter_variance = 0.25;  // square px added to every footprint
    bool conserves_light = true;    // the peak sinks as the filter widens it; not so in 3D Gaussian Splatting
    double least_alpha = 0.0;       // what is fainter is not drawn: 1/255 there
};

/// Red, green and blue in display values over black, and alpha. `camera` is a perspective one.
Image ewa_reference(std::vector<Trained> capture, const Camera& camera, std::int64_t width,
                    std::int64_t height, const EwaSettings& settings = {});

}  // namespace astrosplat::test
