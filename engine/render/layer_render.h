// The values of [layer.render] (profile of a splat, mixing, level of detail), and those of [layer.source] of
// kind "stars" about the image of a star. Plain values; the program's own description has the defaults.
#pragma once

#include <glm/vec3.hpp>

#include "core/text.h"

namespace astrosplat {

/// Profile of a splat: w(t), t = distance / radius; w(0) = 1, zero from t = 1 on (DESIGN 7).
struct Falloff {
    enum class Shape { constant, linear, trapezoid, gaussian, exponential };
    friend constexpr auto names_of(Shape) {
        return names_up_to<Shape::exponential>("constant", "linear", "trapezoid", "gaussian", "exponential");
    }
    Shape shape = Shape::gaussian;
    float core = 0.5f;       // trapezoid: fraction of the radius that is flat
    float sharpness = 4.5f;  // gaussian e^(-sharpness t^2), exponential e^(-sharpness t), shifted and scaled
    bool operator==(const Falloff&) const = default;
};

enum class Blend { over, add, screen, lighten, hybrid, absorb };
constexpr auto names_of(Blend) {
    return names_up_to<Blend::absorb>("over", "add", "screen", "lighten", "hybrid", "absorb");
}

struct LevelOfDetail {
    float max_px = 0.0f;         // projected diameter at 1080 lines above which a splat is split; 0: off
    int max_children = 4096;     // largest number of children
    float noise = 0.0f;          // 0..2: how much structure the children's light has; 0: none
    float star_distance = 0.0f;  // scene units from the camera, within which stars stay points; 0: off
    bool operator==(const LevelOfDetail&) const = default;
};

/// Display: an isolated layer's colours are mixed as a display shows them, and the mix is decoded.
enum class BlendSpace { linear, display };
constexpr auto names_of(BlendSpace) { return names_up_to<BlendSpace::display>("linear", "display"); }

struct LayerRender {
    Falloff falloff;
    Blend blend = Blend::over;
    float opacity = 1.0f;
    float hybrid_from_deg = 30.0f;        // over up to here
    float hybrid_to_deg = 80.0f;          // screen from here on
    glm::vec3 absorb{0.8f, 1.0f, 1.35f};  // exponents of what it lets through; dust takes more of blue
    LevelOfDetail lod;
    bool holdout = false;
    bool isolate = false;
    BlendSpace space = BlendSpace::linear;
    bool operator==(const LayerRender&) const = default;
};

/// Whether lod.star_distance acts: mixed otherwise, a star that is smaller and brighter has another light.
inline bool stars_stay_points(const LayerRender& render) {
    return render.lod.star_distance > 0.0f && (render.blend == Blend::over || render.blend == Blend::add);
}

/// Whether the layer is composited in display values.
inline bool is_encoded(const LayerRender& render) {
    return render.space == BlendSpace::display && render.isolate && render.blend == Blend::over &&
           !render.holdout;
}

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
