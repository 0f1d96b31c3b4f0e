// The image of a star: what [layer.source] of kind "stars" says of its point-spread function. Plain values.
#pragma once

namespace astrosplat {

/// A point-spread function of fixed size in output pixels: a Gaussian core, Moffat wings and diffraction
/// spikes, each with its share of the light; all shares together are 1.
struct StarPsf {
    float core_px = 1.0f;     // standard deviation of the core, the pixel filter included
    float wing_share = 0.0f;  // 0..1 of the light, in wings (1 + (r / wing_px)^2)^-wing_power
    float wing_px = 3.0f;
    float wing_power = 2.5f;   // > 1
    float spike_share = 0.0f;  // 0..1 of the light, in spikes
    int vanes = 4;          // that hold the secondary mirror: an even number of them makes as many spikes, an
                            // odd one twice as many
    float vane_deg = 0.0f;  // of the first vane, counter-clockwise from the frame's x axis
    float spike_px = 40.0f;  // length at which a spike has fallen to 1/e
    bool operator==(const StarPsf&) const = default;
};

}  // namespace astrosplat
