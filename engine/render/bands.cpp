#include "render/bands.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "core/error.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "render/plan_bands.h"
#include "render/record_sample.h"
#include "render/tiles.h"

namespace astrosplat {
namespace {

// Of a record: itself with the unused ends of blocks, and an id where they are kept.
constexpr double record_bytes = 1.125 * sizeof(ScreenSplat), id_bytes = sizeof(std::uint64_t);

/// One band while it is rendered.
class BandRun {
  public:
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
        const ScreenRect rect{static_cast<float>(grid.x0), static_cast<float>(grid.y0),
                              static_cast<float>(grid.x0 + grid.width),
                              static_cast<float>(grid.y0 + grid.height)};
        blocks_ = visible_blocks(job.projections, rect);
        for (const VisibleBlock& block : blocks_) visible_splats_ += splats_of(block);
    }

    void run() {
        std::vector<DepthRange> slabs = plan();
        if (slabs.size() == 1 && try_whole()) return;
        if (slabs.size() == 1) slabs = refined(slabs[0]);
        CarriedTiles carried(job_, grid_);
        limit_store(CarriedTiles::bytes(job_, grid_));
        while (!slabs.empty()) {
            if (try_slab(slabs.front(), carried))
                slabs.erase(slabs.begin());
            else
                slabs = refined(slabs.front());
        }
        for_each_tile(0.95, 0.05,
                      [&](std::int64_t tile, TileWorker& worker) { carried.finish(tile, worker, frame_); });
    }

  private:
    std::int64_t splats_of(const VisibleBlock& block) const {
        return job_.projections[block.layer].blocks->blocks()[block.block].splats;
    }

    /// What records may take beside the pixels between slabs.
    void limit_store(std::int64_t pixels_bytes) {
        const std::int64_t limit = job_.settings.memory_limit_bytes;
        // Where all is in memory bands alone do, but for frames of few tiles.
        constexpr std::int64_t few = 16'000'000;
        const std::int64_t least = std::max(
            TileBins::least_bytes(grid_, static_cast<int>(job_.groups.size())), blocks_.empty() ? few : 0);
        limit_ = limit > 0 ? std::max({limit - pixels_bytes, limit / 4, least}) : 0;
        cache_.store.limit(limit_);
    }

    /// One slab where all records fit, as far as can be told.
    std::vector<DepthRange> plan() {
        limit_store(0);
        const double bytes = record_bytes + (blocks_.empty() ? 0.0 : id_bytes);
        if (limit_ == 0 || blocks_.empty() ||
            static_cast<double>(records_) * bytes <= 0.9 * static_cast<double>(limit_))
            return std::vector<DepthRange>(1);
        limit_store(CarriedTiles::bytes(job_, grid_));
        sample_ = sample_depths(job_.projections, grid_, job_.progress);
        most_records_ = 0.9 * static_cast<double>(limit_) / bytes;
        return sample_->cut(most_records_, 0);
    }

    /// The depths from the range on, in smaller slabs than before.
    std::vector<DepthRange> refined(const DepthRange& range) {
        if (range.first == range.last)
            throw InputError(
                fmt::format("splats at one distance need more than {} of memory, which --memory leaves "
                            "for them",
                            human_bytes(static_cast<double>(limit_))));
        if (!sample_) sample_ = sample_depths(job_.projections, grid_, job_.progress);
        if (most_records_ == 0.0) most_records_ = sample_->records();
        most_records_ *= 0.7;
        std::vector<DepthRange> slabs = sample_->cut(most_records_, range.first);
        if (slabs[0].last < range.last) return slabs;
        const auto [near, far] = sample_->halve(range);
        slabs[0].first = far.first;
        slabs.insert(slabs.begin(), near);
        return slabs;
    }

    /// The records of a slab into bins; none where they take too much.
    std::optional<TileBins> scatter(const DepthRange& slab) try {
        std::optional<TileBins> bins(std::in_place, grid_, static_cast<int>(job_.groups.size()),
                                     records_in(slab));
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
        return slab.is_all() || most_records_ == 0.0
                   ? records_
                   : std::min(records_, static_cast<std::int64_t>(most_records_));
    }

    bool try_whole() {
        const std::optional<TileBins> bins = scatter({});
        if (!bins) return false;
        progress_at(0.4);
        for_each_tile(0.4, 0.6, [&](std::int64_t tile, TileWorker& worker) {
            render_tile(job_, *bins, tile, worker, frame_);
        });
        return true;
    }

    bool try_slab(const DepthRange& slab, CarriedTiles& carried) {
        const std::optional<TileBins> bins = scatter(slab);
        if (!bins) return false;
        const double share =
            0.95 * std::min(1.0 - done_, visible_splats_ > 0 ? share_of(slab) : 0.5 * (1.0 - done_));
        for_each_tile(0.95 * done_ + 0.4 * share, 0.6 * share,
                      [&](std::int64_t tile, TileWorker& worker) { carried.fold_slab(*bins, tile, worker); });
        done_ += share / 0.95;
        return true;
    }

    /// Of all splats that come by the block, those of which a slab is likely to be the last; for progress
    /// alone.
    double share_of(const DepthRange& slab) const {
        std::int64_t splats = 0;
        for (const VisibleBlock& block : blocks_)
            if (slab.holds(block.depths.last)) splats += splats_of(block);
        return static_cast<double>(splats) / static_cast<double>(visible_splats_);
    }

    void progress_at(double fraction) const {
        const double share = static_cast<double>(grid_.height) / static_cast<double>(job_.region.height);
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
            if (finished % 64 == 0)
                progress_at(before +
                            share * static_cast<double>(finished) / static_cast<double>(grid_.tiles()));
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

}  // namespace

void render_band(const FrameJob& job, const TileGrid& grid, std::int64_t records, double before,
                 RenderCache::State& cache, RenderedFrame& frame) {
    BandRun(job, grid, records, before, cache, frame).run();
}

std::int64_t scattered_bytes(const FrameJob& job, RenderCache::State& cache) {
    const auto [grid, expected] = choose_tiles(job);
    TileBins bins(grid, static_cast<int>(job.groups.size()), expected);
    cache.store.limit(0);
    cache.store.clear();
    bins.scatter(job.projections, job.group_of_layer, {}, {}, cache.store, job.progress);
    return bins.records() * static_cast<std::int64_t>(sizeof(ScreenSplat)) +
           std::ssize(bins.shapes()) * static_cast<std::int64_t>(sizeof(Shape)) +
           bins.records_of_fullest(thread_count()) * fold_bytes_per_record;
}

}  // namespace astrosplat
