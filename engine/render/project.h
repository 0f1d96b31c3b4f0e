// Projection: shaded splats of one layer -> 0..n screen splats each, through the camera, with near fade,
// hybrid angle and level of detail. The mathematics of the projections is shaders/shared/projection.glsl.
#pragma once

#include <atomic>
#include <glm/vec2.hpp>

#include "camera/camera.h"
#include "core/buffer.h"
#include "render/frame.h"
#include "render/lod.h"
#include "render/screen_splat.h"

namespace astrosplat {

struct FootprintTable;

/// Where on the frame splats are wanted, px of the whole frame.
struct ScreenRect {
    float x0, y0, x1, y1;
};

/// One of the gaussians that the image of a star is made of (star_splats()).
struct StarSplat {
    float share = 1.0f;      // of the star's light
    float per_light = 1.0f;  // colour that gives a light of 1 over all pixels
    float radius_px = 1.0f;  // of the falloff
    bool is_round = true;
    Shape shape{};  // else
};

/// One layer's constants for one frame.
struct LayerProjection {
    const ShadedSplats* splats = nullptr;
    const ShadedBlocks* blocks = nullptr;  // then `splats` are those of one block or of the sample
    glm::dmat3 camera_from_layer{1.0};     // rotation * scale
    glm::dvec3 origin_in_camera{0.0};      // of layer space
    glm::vec3 axis_in_camera{0.0f, 1.0f, 0.0f};
    float layer_scale = 1.0f, radius_scale = 1.0f;      // of the layer, and with it of radii
    bool gaussians = false;                             // as in RenderLayer
    float deviation = 0.25f;                            // of Gaussians, drawn radii
    glm::vec2 least_slope{-1.0f}, largest_slope{1.0f};  // x / z and y / z in footprints of Gaussians
    float opacity = 1.0f;
    Lens lens;
    float reach = 1.0f, margin_px = 2.0f;  // support = radius * reach + margin
    float variance = 0.25f;                // of the falloff, as in FootprintTable
    float lod_limit_px = 0.0f;
    float star_distance = 0.0f;  // as lod.star_distance, where it acts
    LayerRender render;
    std::uint32_t seed = 1;
    std::uint16_t layer = 0;
    const LodTable* lod = nullptr;                 // set when lod_limit_px > 0
    const std::atomic<bool>* cancelled = nullptr;  // as in Progress: one splat may have millions of children
    std::vector<StarSplat> star_splats;            // of a layer of stars; else empty
    StarPixels star_pixels;                        // theirs, as in RenderLayer
};

LayerProjection make_projection(const RenderLayer& layer, std::uint16_t number, const Camera& camera,
                                const RenderSettings& settings);

/// A place in layer space, camera space; rounded to float last.
inline glm::vec3 to_camera(const LayerProjection& layer, const glm::vec3& p) {
    return glm::vec3(layer.camera_from_layer * glm::dvec3(p) + layer.origin_in_camera);
}

/// How much structure (lod.noise) the children of a splat get: those of dust half of it. Light that screen
/// saturates has no room for it, and would be lost. `position` in camera space.
float structure_of(const LayerProjection& layer, const glm::vec3& position, const glm::vec3& color,
                   float alpha);

/// Radius of the image of a star at `position` in camera space over that of its splat: less than 1 within
/// lod.star_distance (near_star_size() of render/lod.h). Its colour is divided by the square.
float near_star_size(const LayerProjection& layer, const glm::vec3& position);

/// Half the width of the square around a splat's place on the frame outside of which all its weights are 0.
float support_px(const LayerProjection& layer, const ScreenSplat& splat, const Buffer<Shape>& shapes);

/// Appends the screen splats of shaded splats [begin, end) whose support touches `rect`, and the shapes of
/// those that are not round. A frame that goes all the way round shows splats at up to three places, a period
/// apart; of these the fold takes the one that is nearest to its cell.
/// Throws Cancelled within some thousand children.
void project(const LayerProjection& layer, std::int64_t begin, std::int64_t end, const ScreenRect& rect,
             Buffer<ScreenSplat>& out, Buffer<Shape>& shapes);

/// The same but for the rows that it appends to `rest`, of which level of detail may make thousands of
/// splats: for project_rows().
void project_most(const LayerProjection& layer, std::int64_t begin, std::int64_t end, const ScreenRect& rect,
                  Buffer<ScreenSplat>& out, Buffer<Shape>& shapes, Buffer<std::int64_t>& rest);
void project_rows(const LayerProjection& layer, std::span<const std::int64_t> rows, const ScreenRect& rect,
                  Buffer<ScreenSplat>& out);

// ---- for stars

/// The splats that a star's image is made of, the core first; `footprint` is that of a gaussian falloff.
///
/// Moffat's (1 + r^2)^-b and a spike's e^-|x| are mixtures of gaussians, by the gamma distribution of their
/// inverse variance and the exponential one of their variance; here in steps of a factor of two. The core's
/// gaussian and the pixel filter's together have the deviation core_px, as far as the filter is not wider.
std::vector<StarSplat> star_splats(const StarPsf& psf, const FootprintTable& footprint);

/// As project() does. A star at r from the layer's origin and c from the eye has (r / c)^2 of its colour as
/// light over all pixels, c no less than near and near_fade; at infinity just its colour. Wings and spikes
/// whose peak is below 2^-14 of scene light are left out with a soft edge, their light goes to the core. Onto
/// the sphere cores and wings are round there; spikes point and are as long as on a flat frame, in px of this
/// one, at the star.
void project_stars(const LayerProjection& layer, std::int64_t begin, std::int64_t end, const ScreenRect& rect,
                   Buffer<ScreenSplat>& out, Buffer<Shape>& shapes);

/// Largest light of a pixel of the layer's stars.
float largest_star_light(const LayerProjection& layer);

// ---- for the files that project

/// Projects splats [begin, end) as far as they fill whole vectors; returns where the others begin. Those that
/// level of detail may divide and may show, and stars that stay points close by, are left to `rest`.
std::int64_t project_whole_blocks(const LayerProjection& layer, std::int64_t begin, std::int64_t end,
                                  const ScreenRect& rect, Buffer<ScreenSplat>& out,
                                  Buffer<std::int64_t>& rest);

/// Appends a splat at each of the places at which the frame shows it, as far as the square of half width
/// support_px around it touches `rect`; period_px is the lens's.
inline void push_places(ScreenSplat splat, float period_px, float support_px, const ScreenRect& rect,
                        Buffer<ScreenSplat>& out) {
    const float x_px = splat.x_px;
    for (const float turn_px : {0.0f, -period_px, period_px}) {
        splat.x_px = x_px + turn_px;
        if (splat.x_px + support_px > rect.x0 && splat.x_px - support_px < rect.x1) out.push_back(splat);
        if (period_px == 0.0f) break;
    }
}

/// h of the hybrid blend for a splat at p in camera space, 65535 = 1; 0 for other blends.
std::uint16_t hybrid_of(const LayerProjection& layer, const glm::vec3& p);

}  // namespace astrosplat
