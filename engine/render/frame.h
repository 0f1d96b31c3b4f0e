// A frame's inputs and outputs: layers and settings in, images and statistics out. The vocabulary that
// scenes, writers and the preview share with the renderer (render.h).
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"
#include "core/text.h"
#include "splats/shaded_splats.h"
#include "splats/splat_set.h"

namespace astrosplat {

// ---- the values of [layer.render] (profile of a splat, mixing, level of detail), and those of
// [layer.source] of kind "stars" about the image of a star: the program's own description has the defaults

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
inline bool is_mixed_in_display_space(const LayerRender& render) {
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

// ---- a frame

class RenderDevice;

/// Splats that a look made in the device's memory (LookDevice), and nowhere else.
struct DeviceSplats {
    std::uint64_t stamp = 0;
    std::int64_t rows = 0, kept = 0;                        // of the set; of these by the look
    float largest_light = 0.0f, largest_star_light = 0.0f;  // of one splat: alpha * brightest channel
    /// Makes them here, where the device does not draw them after all.
    std::function<const ShadedSplats*()> make;
};

/// One layer as the renderer sees it.
struct RenderLayer {
    std::string name;
    const ShadedSplats* splats = nullptr;     // these, or
    const ShadedBlocks* blocks = nullptr;     // those, which are not in memory as a whole, or
    const DeviceSplats* on_device = nullptr;  // those, which the settings' device has
    LayerRender render;
    glm::dmat3 world_from_layer{1.0};  // rotation
    double scale = 1.0;                // uniform; scales radii too
    glm::dvec3 translate{0.0};
    glm::dvec3 axis{0.0, 1.0, 0.0};  // the layer's thin direction, layer space
    std::int64_t size() const {
        return blocks ? blocks->splats() : on_device ? on_device->rows : splats->size();
    }
    glm::dvec3 to_world(const glm::dvec3& p) const { return world_from_layer * (scale * p) + translate; }
    std::uint32_t seed = 1;  // for the children of level of detail
    /// Some splats may have colours below 0: these add no light and let (1 - s)^-color through, whatever the
    /// layer's blend.
    bool absorbs = false;
    /// Gaussians: the radius of each is three standard deviations. The gaussian falloff is drawn out to four,
    /// and the footprint is that of the frame's affine approximation at the centre (EWA).
    bool gaussians = false;
    /// Of Gaussians whose colours depend on where they are seen from: the set that the splats were made of.
    /// Not for the renderer.
    const SplatSet* directional = nullptr;
    double radius_scale = 1.0;  // of radii alone
    /// Stars: the splats' colours are their light over all pixels as seen from the layer's origin, radii and
    /// alphas are not used. Stars at infinity lie 1e15 units or more away.
    std::optional<StarPsf> stars;
    StarPixels star_pixels;  // of stars: the pixels that their light was measured in, where these are known
};

struct RenderSettings {
    std::int64_t width = 1920, height = 1080;  // px, the whole frame
    Region region;              // part to render; empty: all. The pixels are those of the whole frame
    float pixel_filter = 0.5f;  // px, standard deviation
    float exposure = 0.0f;      // stops; only tightens the stop rule
    bool aov_depth = false, aov_coverage = false, aov_count = false, aov_layers = false;
    bool opacity = false;  // with aov_depth: what depth is weighted by, for means of several renderings
    int tile_px = 0;       // a multiple of 8 from 16 to 128; 0: the quicker of 32 and 64. Changes no bit
    /// For all that rendering takes besides the splats in memory and the frame's images; 0: none. What takes
    /// more is rendered in bands and slabs of depth, same bits. `what_is_free`: what there is of memory when
    /// the splats are shaded.
    std::int64_t memory_limit_bytes = 0;
    static constexpr std::int64_t what_is_free = -1;
    /// Of a sample: how many splats each stands for, at least 1. Tiles are then as large as those of all.
    /// Changes no bit.
    double splats_each = 1.0;
    /// For previews: the whole frame's backdrop (draw_backdrop()), which stands for the environment;
    /// null: none.
    const Image* backdrop = nullptr;
    RenderDevice* device = nullptr;  // draws what it can (device.h); changes no bit
};

struct RenderStatistics {
    std::int64_t splats_in = 0;     // shaded splats of visible layers
    std::int64_t splats_drawn = 0;  // instances that touch the region, children included
    double mean_overlap = 0.0;      // footprints per covered pixel
    double seconds = 0.0;           // from shaded splats to the finished image
    std::string device;             // that drew it; empty: the processor did,
    std::string not_on_device;      // and why, where it was asked for a device
};

struct RenderedFrame {
    Image beauty;    // RGBA, linear, premultiplied; region-sized
    Image depth;     // 1 channel: opacity-weighted mean distance along the view axis, 0 where alpha is 0
    Image opacity;   // 1 channel, in no file: the splats' own, without an environment behind them
    Image coverage;  // 1 channel: 1 - product of (1 - weight), whatever the opacity
    Image count;     // 1 channel: splats that reached the pixel
    std::vector<Image> layers;  // RGBA each, in the order given: the layer's light as it arrives
    RenderStatistics statistics;
};

}  // namespace astrosplat
