// The offline renderer: shaded layers + camera -> image (DESIGN 7). Tile by tile: project, scatter the
// projected splats into their tiles, sort inside each tile, fold near to far.
#pragma once

#include "camera/camera.h"
#include "core/image.h"
#include "core/progress.h"
#include "render/environment.h"
#include "render/frame.h"

namespace astrosplat {

/// State that may stay between frames: big buffers, footprint and level-of-detail tables. Changes no pixel.
/// Not to be used by two renders at once.
class RenderCache {
  public:
    RenderCache();
    ~RenderCache();
    struct State;
    std::unique_ptr<State> state;
};

/// Called when the pixels of a tile are final in the frame's images; `tile_px` in px of the whole frame.
/// Comes from the worker threads, several at once but never for the same pixels, and the work waits for it.
using TileDone = std::function<void(const Region& tile_px, const RenderedFrame& frame)>;

/// A pure function of its arguments but for `progress`. Layers in file order; invisible ones are left out by
/// the caller. `environment` may be null. With `tile_done` the tiles come from the middle of the frame
/// outwards, each pixel in exactly one. Throws Cancelled within some 20 ms of being asked to stop, and
/// InputError when memory does not suffice.
RenderedFrame render(std::span<const RenderLayer> layers, const Camera& camera,
                     const Environment* environment, const RenderSettings& settings,
                     const Progress& progress = {}, RenderCache* cache = nullptr,
                     const TileDone& tile_done = {});

/// Bytes that the projected splats of a frame take with what folding them takes, whatever the memory limit:
/// they are projected and scattered into their tiles, and no pixel is made. Of a sample
/// (RenderSettings::splats_each), what all splats would take.
std::int64_t scattered_bytes(std::span<const RenderLayer> layers, const Camera& camera,
                             const RenderSettings& settings, RenderCache& cache,
                             const Progress& progress = {});

}  // namespace astrosplat
