#include "render/render.h"

#include <algorithm>
#include <atomic>
#include <cassert>

#include "core/clock.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "render/bands.h"
#include "render/frame_job.h"
#include "render/plan_bands.h"

namespace astrosplat {
namespace {

std::int64_t image_bytes(std::span<const RenderLayer> layers, const RenderSettings& settings,
                         std::int64_t width, std::int64_t height) {
    const std::int64_t channels = 4 + settings.aov_depth + settings.aov_coverage + settings.aov_count +
                                  (settings.aov_layers ? 4 * static_cast<std::int64_t>(layers.size()) : 0);
    return width * height * channels * static_cast<std::int64_t>(sizeof(float));
}

/// Of what there is now; less than any frame is worth is left to fail.
std::int64_t free_bytes(std::span<const RenderLayer> layers, const RenderSettings& settings,
                        const RenderCache::State& state) {
    constexpr std::int64_t least = 24'000'000, of_a_thread = 6'000'000;
    const Region& part = settings.region;
    const bool whole = part.width <= 0 || part.height <= 0;
    const std::int64_t images = image_bytes(layers, settings, whole ? settings.width : part.width,
                                            whole ? settings.height : part.height);
    const std::int64_t room = available_memory_bytes() - images - thread_count() * of_a_thread;
    // What malloc does not give back is a thirtieth. The buffers of the last frame are used again.
    return std::max(least, room - room / 32 + state.store.bytes());
}

RenderedFrame make_frame(std::span<const RenderLayer> layers, const RenderSettings& settings,
                         const Region& region) {
    claim_memory(image_bytes(layers, settings, region.width, region.height), "the frame");
    RenderedFrame frame;
    frame.beauty = make_image(region.width, region.height, 4);
    if (settings.aov_depth) frame.depth = make_image(region.width, region.height, 1);
    if (settings.aov_coverage) frame.coverage = make_image(region.width, region.height, 1);
    if (settings.aov_count) frame.count = make_image(region.width, region.height, 1);
    if (settings.aov_layers)
        for (std::size_t i = 0; i < layers.size(); ++i)
            frame.layers.push_back(make_image(region.width, region.height, 4));
    for (const RenderLayer& layer : layers) frame.statistics.splats_in += layer.size();
    return frame;
}

std::int64_t covered_pixels(const Image& beauty) {
    constexpr std::int64_t chunk = 1 << 16;
    std::atomic<std::int64_t> covered = 0;
    parallel_chunks(beauty.width * beauty.height, chunk, [&](std::int64_t begin, std::int64_t end, int) {
        std::int64_t here = 0;
        const float* p = beauty.pixels.data() + 4 * begin;
        for (std::int64_t i = begin; i < end; ++i, p += 4)
            here += std::max(std::max(p[0], p[1]), std::max(p[2], p[3])) > 0.0f;
        covered += here;
    });
    return covered;
}

/// A Gaussian that ends at three standard deviations lacks a twentieth of its light, at four a 200th: the
/// same curve further out.
void extend_gaussians(RenderLayer& layer) {
    constexpr float further = 4.0f / 3.0f;
    if (layer.render.falloff.shape != Falloff::Shape::gaussian) return;
    layer.radius_scale *= further;
    layer.render.falloff.sharpness *= further * further;
}

/// Stars as they are drawn: gaussians that add light. Gaussians with their tails.
std::vector<RenderLayer> as_drawn(std::span<const RenderLayer> layers) {
    std::vector<RenderLayer> drawn(layers.begin(), layers.end());
    for (RenderLayer& layer : drawn) {
        if (layer.gaussians) extend_gaussians(layer);
        if (!layer.stars) continue;
        layer.render.falloff = {Falloff::Shape::gaussian, 0.5f, 4.5f};
        layer.render.blend = Blend::add;
        layer.render.lod = {};
        layer.absorbs = false;
    }
    return drawn;
}

}  // namespace

std::int64_t scattered_bytes(std::span<const RenderLayer> layers, const Camera& camera,
                             const RenderSettings& settings, RenderCache& cache, const Progress& progress) {
    const std::vector<RenderLayer> drawn = as_drawn(layers);
    RenderSettings unlimited = settings;
    unlimited.memory_limit_bytes = 0;
    const TileDone nobody;
    FrameJob job{drawn, camera, nullptr, unlimited, progress, nobody, {}, {}, {}, {}, {}, {}};
    prepare(job, *cache.state);
    return static_cast<std::int64_t>(settings.splats_each *
                                     static_cast<double>(scattered_bytes(job, *cache.state)));
}

RenderedFrame render(std::span<const RenderLayer> layers, const Camera& camera,
                     const Environment* environment, const RenderSettings& asked, const Progress& progress,
                     RenderCache* cache, const TileDone& tile_done) {
    assert(asked.tile_px == 0 ||
           (asked.tile_px >= 16 && asked.tile_px <= TilePlanes::widest_px && asked.tile_px % 8 == 0));
    const auto start = Clock::now();
    for (const RenderLayer& layer : layers)
        if (layer.splats && layer.splats->size() > 0xffffffffLL)
            throw InputError("layer " + layer.name + ": " +
                             human_count(static_cast<double>(layer.splats->size())) +
                             " splats in one layer, at most 4294967295 can be drawn");
    std::unique_ptr<RenderCache> own = cache ? nullptr : std::make_unique<RenderCache>();
    RenderCache::State& state = cache ? *cache->state : *own->state;
    const std::vector<RenderLayer> drawn = as_drawn(layers);
    RenderSettings settings = asked;
    if (settings.memory_limit_bytes == RenderSettings::what_is_free)
        settings.memory_limit_bytes = free_bytes(layers, settings, state);
    FrameJob job{drawn, camera, environment, settings, progress, tile_done, {}, {}, {}, {}, {}, {}};
    prepare(job, state);
    const Bands bands = make_bands(job);
    std::int64_t bytes = bands.records * static_cast<std::int64_t>(sizeof(ScreenSplat));
    if (settings.memory_limit_bytes > 0) bytes = std::min(bytes, settings.memory_limit_bytes);
    if (bytes > state.store.bytes()) claim_memory(bytes - state.store.bytes(), "projected splats");
    RenderedFrame frame = make_frame(layers, settings, job.region);
    double done = 0.0;
    for (const TileGrid& band : bands.grids) {
        render_band(job, band, bands.records, done, state, frame);
        done += static_cast<double>(band.height) / static_cast<double>(job.region.height);
    }
    if (settings.memory_limit_bytes > 0) state.store.shrink(settings.memory_limit_bytes);
    const double covered = static_cast<double>(covered_pixels(frame.beauty));
    frame.statistics.mean_overlap = covered > 0.0 ? frame.statistics.mean_overlap / covered : 0.0;
    frame.statistics.seconds = seconds_since(start);
    return frame;
}

}  // namespace astrosplat
