#include "render/render.h"

#include <fmt/format.h>

#include <atomic>

#include "core/error.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "render/device.h"
#include "render/frame_job.h"
#include "render/scatter.h"
#include "render/screen_splat.h"

namespace astrosplat {
namespace {

// ---- a band of the frame

/// Bytes besides the record itself while its tile is folded: its places in the order, and its disc.
constexpr std::int64_t fold_bytes_per_record = SplatSorter::bytes_per_record + 6 * sizeof(float);

// Of a record: itself with the unused ends of blocks, and an id where they are kept.
constexpr double record_bytes = 1.125 * sizeof(ScreenSplat), id_bytes = sizeof(std::uint64_t);

/// One band while it is rendered: its splats are scattered into tiles, and these are folded. Splats that
/// would take more memory than there may be come in slabs of depth, near to far.
class BandRun {
  public:
    /// `before` of the frame's share is done already.
    BandRun(const FrameJob& job, const TileGrid& grid, std::int64_t records, double before,
            RenderCache::State& cache, RenderedFrame& frame)
        : job_(job),
          grid_(grid),
          records_(records),
          before_(before),
          cache_(cache),
          frame_(frame),
          workers_(make_tile_workers(job)),
          order_(tile_order(job, grid)) {
        blocks_ = visible_blocks(job.projections, rect_of(grid));
        for (const VisibleBlock& block : blocks_) visible_splats_ += splats_of(block);
    }

    /// Throws InputError where what lies at one distance takes more than the limit.
    void run() {
        std::vector<DepthRange> slabs = plan();
        if (slabs.size() == 1 && try_whole()) return;
        if (slabs.size() == 1) slabs = refined(slabs[0]);
        CarriedTiles carried(job_, grid_);
        limit_store(carried_bytes(job_, grid_));
        while (!slabs.empty()) {
            if (try_slab(slabs.front(), carried))
                slabs.erase(slabs.begin());
            else
                slabs = refined(slabs.front());
        }
        for_each_tile(slabs_share, 1.0 - slabs_share,
                      [&](std::int64_t tile, TileWorker& worker) { carried.finish(tile, worker, frame_); });
    }

  private:
    // Of a band's progress: all slabs, before their tiles are resolved; of one slab, its two steps.
    static constexpr double slabs_share = 0.95, scatter_share = 0.4, fold_share = 0.6;
    static constexpr double filled = 0.9;  // of the limit by what is planned: estimates miss some
    static constexpr double finer = 0.7;   // records of a slab over those of one that did not fit

    std::int64_t splats_of(const VisibleBlock& block) const {
        return job_.projections[block.layer].blocks->blocks()[block.block].splats;
    }

    /// Bytes that records may take besides the pixels between slabs.
    void limit_store(std::int64_t pixels_bytes) {
        const std::int64_t limit = job_.settings.memory_limit_bytes;
        // Where all is in memory bands alone do, but for frames of few tiles.
        constexpr std::int64_t few = 16'000'000;
        const std::int64_t least =
            std::max(TileBins::least_bytes(grid_, int(job_.groups.size())), blocks_.empty() ? few : 0);
        limit_ = limit > 0 ? std::max({limit - pixels_bytes, limit / 4, least}) : 0;
        cache_.store.limit(limit_);
    }

    /// One slab where all records fit, as far as can be estimated.
    std::vector<DepthRange> plan() {
        limit_store(0);
        const double bytes = record_bytes + (blocks_.empty() ? 0.0 : id_bytes);
        if (limit_ == 0 || blocks_.empty() || double(records_) * bytes <= filled * double(limit_))
            return std::vector<DepthRange>(1);
        limit_store(carried_bytes(job_, grid_));
        sample_ = sample_depths(job_.projections, grid_, job_.progress);
        most_records_ = filled * double(limit_) / bytes;
        return sample_->cut(most_records_, 0);
    }

    /// The depths from the range on, in smaller slabs than before.
    std::vector<DepthRange> refined(const DepthRange& range) {
        if (range.first == range.last)
            throw InputError(
                fmt::format("splats at one distance need more than {} of memory, which --memory leaves "
                            "for them",
                            human_bytes(double(limit_))));
        if (!sample_) sample_ = sample_depths(job_.projections, grid_, job_.progress);
        if (most_records_ == 0.0) most_records_ = sample_->records();
        most_records_ *= finer;
        std::vector<DepthRange> slabs = sample_->cut(most_records_, range.first);
        if (slabs[0].last < range.last) return slabs;
        const auto [near, far] = sample_->halve(range);
        slabs[0].first = far.first;
        slabs.insert(slabs.begin(), near);
        return slabs;
    }

    /// The records of a slab into bins; none where they take too much.
    std::optional<TileBins> scatter(const DepthRange& slab) try {
        std::optional<TileBins> bins(std::in_place, grid_, int(job_.groups.size()), records_in(slab));
        cache_.store.clear();
        bins->scatter(job_.projections, job_.group_of_layer, slab, blocks_, cache_.store, job_.progress);
        if (limit_ > 0 &&
            cache_.store.used_bytes() + fold_bytes_per_record * bins->records_of_fullest(thread_count()) >
                limit_)
            throw StoreFull();
        const TileBins::Sums sums = bins->sums();
        make_footprints(job_, sums, cache_);
        frame_.statistics.splats_drawn += sums.instances;
        frame_.statistics.mean_overlap += sums.footprint_px;
        return bins;
    } catch (const StoreFull&) {
        return {};
    }

    std::int64_t records_in(const DepthRange& slab) const {
        return slab.is_all() || most_records_ == 0.0 ? records_
                                                     : std::min(records_, std::int64_t(most_records_));
    }

    bool try_whole() {
        const std::optional<TileBins> bins = scatter({});
        if (!bins) return false;
        for_each_tile(scatter_share, fold_share, [&](std::int64_t tile, TileWorker& worker) {
            render_tile(job_, *bins, tile, worker, frame_);
        });
        return true;
    }

    bool try_slab(const DepthRange& slab, CarriedTiles& carried) {
        const std::optional<TileBins> bins = scatter(slab);
        if (!bins) return false;
        const double share =
            std::min(1.0 - done_, visible_splats_ > 0 ? share_of(slab) : 0.5 * (1.0 - done_));
        for_each_tile(slabs_share * (done_ + scatter_share * share), slabs_share * fold_share * share,
                      [&](std::int64_t tile, TileWorker& worker) { carried.fold_slab(*bins, tile, worker); });
        done_ += share;
        return true;
    }

    /// Of all splats that come by the block, those of which a slab is likely to be the last;
    /// for progress alone.
    double share_of(const DepthRange& slab) const {
        std::int64_t splats = 0;
        for (const VisibleBlock& block : blocks_)
            if (slab.holds(block.depths.last)) splats += splats_of(block);
        return double(splats) / double(visible_splats_);
    }

    void progress_at(double fraction) const {
        const double share = double(grid_.height) / double(job_.region.height);
        job_.progress.at(before_ + share * fraction);
    }

    /// body(tile, worker) for all tiles, which is so much of the band's work.
    template <class Body>
    void for_each_tile(double before, double share, const Body& body) {
        progress_at(before);
        std::atomic<std::int64_t> done = 0;
        parallel_for(grid_.tiles(), [&](std::int64_t i, int worker) {
            job_.progress.check();
            body(order_[i], workers_[worker]);
            const std::int64_t finished = ++done;
            if (finished % 64 == 0) progress_at(before + share * double(finished) / double(grid_.tiles()));
        });
    }

    const FrameJob& job_;
    const TileGrid& grid_;
    std::int64_t records_;
    double before_, done_ = 0.0;
    RenderCache::State& cache_;
    RenderedFrame& frame_;
    std::vector<TileWorker> workers_;
    std::vector<std::int64_t> order_;
    std::vector<VisibleBlock> blocks_;
    std::int64_t visible_splats_ = 0;  // in them
    std::int64_t limit_ = 0;           // bytes for records and what folding them takes; 0: none
    double most_records_ = 0.0;        // of a slab, as planned; 0: all
    std::optional<DepthSample> sample_;
};

/// Bytes of all records of the frame with what folding them takes, without the memory that no record uses.
std::int64_t scattered_bytes(const FrameJob& job, RenderCache::State& cache) {
    const auto [grid, expected] = choose_tiles(job);
    TileBins bins(grid, int(job.groups.size()), expected);
    cache.store.limit(0);
    cache.store.clear();
    bins.scatter(job.projections, job.group_of_layer, {}, {}, cache.store, job.progress);
    return bins.records() * std::int64_t(sizeof(ScreenSplat)) +
           std::ssize(bins.shapes()) * std::int64_t(sizeof(Shape)) +
           bins.records_of_fullest(thread_count()) * fold_bytes_per_record;
}

// ---- the frame

std::int64_t image_bytes(std::span<const RenderLayer> layers, const RenderSettings& settings,
                         std::int64_t width, std::int64_t height) {
    const std::int64_t channels = 4 + settings.aov_depth + settings.opacity + settings.aov_coverage +
                                  settings.aov_count +
                                  (settings.aov_layers ? 4 * std::int64_t(layers.size()) : 0);
    return width * height * channels * std::int64_t(sizeof(float));
}

/// RenderSettings::what_is_free in bytes: the memory available now, less the frame's images and what each
/// thread takes besides records. With less than 24 MB a frame would be cut into ever more bands and slabs for
/// hours: it is better to begin, and to fail where that does not suffice.
std::int64_t free_bytes(std::span<const RenderLayer> layers, const RenderSettings& settings,
                        const RenderCache::State& state) {
    constexpr std::int64_t least = 24'000'000, of_a_thread = 6'000'000;
    const Region& part = settings.region;
    const bool whole = part.width <= 0 || part.height <= 0;
    const std::int64_t images = image_bytes(layers, settings, whole ? settings.width : part.width,
                                            whole ? settings.height : part.height);
    const std::int64_t room = available_memory_bytes() - images - thread_count() * of_a_thread;
    // A thirtieth is lost to holes in the heaps of malloc. The buffers of the last frame are used again.
    return std::max(least, room - room / 32 + state.store.bytes());
}

/// `beauty`: false where it comes from elsewhere.
RenderedFrame make_frame(std::span<const RenderLayer> layers, const RenderSettings& settings,
                         const Region& region, bool beauty) {
    claim_memory(image_bytes(layers, settings, region.width, region.height), "the frame");
    RenderedFrame frame;
    if (beauty) frame.beauty = make_image(region.width, region.height, 4);
    if (settings.aov_depth) frame.depth = make_image(region.width, region.height, 1);
    if (settings.opacity) frame.opacity = make_image(region.width, region.height, 1);
    if (settings.aov_coverage) frame.coverage = make_image(region.width, region.height, 1);
    if (settings.aov_count) frame.count = make_image(region.width, region.height, 1);
    if (settings.aov_layers)
        for (std::size_t i = 0; i < layers.size(); ++i)
            frame.layers.push_back(make_image(region.width, region.height, 4));
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

/// Projects, scatters and folds the frame, band after band.
void render_bands(const FrameJob& job, RenderCache::State& state, RenderedFrame& frame) {
    const std::int64_t limit = job.settings.memory_limit_bytes;
    const Bands bands = make_bands(job);
    std::int64_t bytes = bands.records * std::int64_t(sizeof(ScreenSplat));
    if (limit > 0) bytes = std::min(bytes, limit);
    if (bytes > state.store.bytes()) claim_memory(bytes - state.store.bytes(), "projected splats");
    double done = 0.0;
    for (const TileGrid& band : bands.grids) {
        BandRun(job, band, bands.records, done, state, frame).run();
        done += double(band.height) / double(job.region.height);
    }
    if (limit > 0) state.store.shrink(limit);
}

/// Splats that only the device has are made here. False: there are none.
bool fetch_splats(std::vector<RenderLayer>& layers) {
    bool any = false;
    for (RenderLayer& layer : layers)
        if (layer.on_device) {
            layer.splats = std::exchange(layer.on_device, nullptr)->make();
            any = true;
        }
    return any;
}

/// By the settings' device, where it can, else by the processor. `layers` are the job's.
RenderedFrame draw_frame(FrameJob& job, std::vector<RenderLayer>& layers, RenderCache::State& state) {
    RenderStatistics statistics;
    std::optional<DrawnGroups> groups;
    const auto try_device = [&] {
        if (job.settings.device) groups = draw_on_device(job, state, statistics);
    };
    try_device();
    if (!groups && fetch_splats(layers)) {
        for (std::size_t l = 0; l < layers.size(); ++l) job.projections[l].splats = layers[l].splats;
        try_device();
    }
    RenderedFrame frame = make_frame(job.layers, job.settings, job.region, !(groups && groups->alone));
    frame.statistics = statistics;
    for (const RenderLayer& layer : job.layers) frame.statistics.splats_in += layer.size();
    if (groups)
        resolve_drawn(job, std::move(*groups), frame);
    else
        render_bands(job, state, frame);
    return frame;
}

}  // namespace

std::int64_t scattered_bytes(std::span<const RenderLayer> layers, const Camera& camera,
                             const RenderSettings& settings, RenderCache& cache, const Progress& progress) {
    const std::vector<RenderLayer> drawn = as_drawn(layers);
    RenderSettings unlimited = settings;
    unlimited.memory_limit_bytes = 0;
    const TileDone unwatched;
    FrameJob job{drawn, camera, nullptr, unlimited, progress, unwatched, {}, {}, {}, {}, {}, {}};
    prepare(job, *cache.state);
    return std::int64_t(settings.splats_each * double(scattered_bytes(job, *cache.state)));
}

RenderedFrame render(std::span<const RenderLayer> layers, const Camera& camera,
                     const Environment* environment, const RenderSettings& asked, const Progress& progress,
                     RenderCache* cache, const TileDone& tile_done) {
    assert(asked.tile_px == 0 ||
           (asked.tile_px >= 16 && asked.tile_px <= TilePlanes::widest_px && asked.tile_px % 8 == 0));
    const auto start = Clock::now();
    const DenormalsAreZero as_on_cards;
    for (const RenderLayer& layer : layers)
        if (layer.splats && layer.splats->size() > 0xffffffffLL)
            throw InputError("layer " + layer.name + ": " + human_count(double(layer.splats->size())) +
                             " splats in one layer, at most 4294967295 can be drawn");
    std::unique_ptr<RenderCache> own = cache ? nullptr : std::make_unique<RenderCache>();
    RenderCache::State& state = cache ? *cache->state : *own->state;
    std::vector<RenderLayer> drawn = as_drawn(layers);
    RenderSettings settings = asked;
    if (settings.memory_limit_bytes == RenderSettings::what_is_free)
        settings.memory_limit_bytes = free_bytes(layers, settings, state);
    FrameJob job{drawn, camera, environment, settings, progress, tile_done, {}, {}, {}, {}, {}, {}};
    prepare(job, state);
    RenderedFrame frame = draw_frame(job, drawn, state);
    const double covered = double(covered_pixels(frame.beauty));
    frame.statistics.mean_overlap = covered > 0.0 ? frame.statistics.mean_overlap / covered : 0.0;
    frame.statistics.seconds = seconds_since(start);
    return frame;
}

}  // namespace astrosplat
