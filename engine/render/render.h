// The offline renderer: shaded layers + camera -> image (DESIGN 7). Tile by tile: project, scatter the
// projected splats into their tiles, sort inside each tile, fold near to far.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "core/image.h"
#include "core/progress.h"
#include "render/environment.h"
#include "render/layer_render.h"
#include "splats/shaded_splats.h"

namespace astrosplat {

/// One layer as the renderer sees it. world = world_from_layer * (scale * p) + translate.
struct RenderLayer {
    std::string name;
    const ShadedSplats* splats = nullptr;
    LayerRender render;
    glm::dmat3 world_from_layer{1.0};  // rotation
    double scale = 1.0;                // uniform; scales radii too
    glm::dvec3 translate{0.0};
    glm::dvec3 axis{0.0, 1.0, 0.0};  // the layer's thin direction, layer space
    std::uint32_t seed = 1;          // for the children of level of detail
};

struct RenderSettings {
    std::int64_t width = 1920, height = 1080;  // px, the whole picture
    Region region;              // part to render; empty: all. The pixels are those of the whole picture
    float pixel_filter = 0.5f;  // px, standard deviation
    float exposure = 0.0f;      // stops; only tightens the stop rule
    bool aov_depth = false, aov_coverage = false, aov_count = false, aov_layers = false;
    int tile_px = 0;  // a multiple of 8 from 16 to 128; 0: the quicker of 32 and 64. Changes no bit
    std::int64_t memory_limit_bytes = 0;  // for screen splats; 0: none. Rendered in bands, same bits
    /// For previews: the whole picture's backdrop (backdrop.h), which stands for the environment; null: none.
    const Image* backdrop = nullptr;
};

struct RenderStatistics {
    std::int64_t splats_in = 0;     // shaded splats of visible layers
    std::int64_t splats_drawn = 0;  // instances that touch the region, children included
    double mean_overlap = 0.0;      // footprints per covered pixel
    double seconds = 0.0;           // from shaded splats to the finished image
};

struct RenderedFrame {
    Image beauty;  // RGBA, linear, premultiplied; region-sized
    Image depth;   // 1 channel: opacity-weighted mean distance along the view axis, 0 where alpha is 0
    Image
        coverage;  // 1 channel: 1 - product of (1 - weight): covered share of the pixel, whatever the opacity
    Image count;   // 1 channel: splats that reached the pixel
    std::vector<Image> layers;  // RGBA each, in the order given: the layer's light as it arrives
    RenderStatistics statistics;
};

/// What may stay between frames: big buffers, footprint and level-of-detail tables. Changes no pixel. Not to
/// be used by two renders at once.
class RenderCache {
  public:
    RenderCache();
    ~RenderCache();
    struct State;
    std::unique_ptr<State> state;
};

/// Called when the pixels of a tile are final in the frame's images; `tile_px` in px of the whole picture.
/// Comes from the worker threads, several at once but never for the same pixels, and the work waits for it.
using TileDone = std::function<void(const Region& tile_px, const RenderedFrame& frame)>;

/// A pure function of its arguments but for `progress`. Layers in file order; invisible ones are left out by
/// the caller. `environment` may be null. With `tile_done` the tiles come from the middle of the picture
/// outwards, each pixel in exactly one. Throws Cancelled within some 20 ms of being asked to stop, and
/// InputError when memory does not suffice.
RenderedFrame render(std::span<const RenderLayer> layers, const Camera& camera,
                     const Environment* environment, const RenderSettings& settings,
                     const Progress& progress = {}, RenderCache* cache = nullptr,
                     const TileDone& tile_done = {});

}  // namespace astrosplat
