// One pipeline, used by the thread alone. Each request is a Run of its own, so that what a cancelled one
// still writes reaches nobody; tiles are copied into the run's canvas without a lock, since each is written
// once. The thread has the window's priority: the window sleeps between events, which serves it first, while
// a lower one would hold up the pool's threads at the end of every loop on a busy machine.
#include "viewer/final_frame.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <mutex>
#include <new>
#include <stdexcept>
#include <utility>

#include "core/progress.h"
#include "pipeline.h"

namespace astrosplat {
namespace {

void copy_tile(const Image& from, const Region& tile, Image& to) {
    const auto bytes = static_cast<std::size_t>(tile.width * from.channels) * sizeof(float);
    for (std::int64_t y = tile.y; y < tile.y + tile.height; ++y)
        std::memcpy(to.at(tile.x, y), from.at(tile.x, y), bytes);
}

}  // namespace

/// One request and its tiles.
struct FinalFrame::Run {
    FinalRequest request;
    std::atomic<float> progress{0.0f};
    Image canvas;               // region-sized RGBA; a tile is whole before it appears in `fresh`
    std::mutex mutex;           // for `fresh`
    std::vector<Region> fresh;  // px of the canvas
};

FinalFrame::Found FinalFrame::render(Pipeline& pipeline, Run& run, Progress progress) {
    const auto start = Clock::now();
    const FinalRequest& request = run.request;
    const Region region = request.part();
    run.canvas = unfilled_image(region.width, region.height, 4);
    pipeline.set_scene(request.scene, request.sets, request.environment.get(), progress);
    const FrameScene now = pipeline.frame_scene(request.frame);
    RenderSettings settings = render_settings(now.scene.output);
    settings.width = request.width;
    settings.height = request.height;
    settings.region = request.region;
    settings.aov_depth = request.depth;
    settings.memory_limit_bytes = RenderSettings::what_is_free;
    settings.aov_coverage = settings.aov_count = settings.aov_layers = false;
    progress.report = [&run](double fraction) { run.progress = static_cast<float>(fraction); };
    const TileDone tile_done = [&run, region](const Region& tile, const RenderedFrame& frame) {
        const Region here{tile.x - region.x, tile.y - region.y, tile.width, tile.height};
        copy_tile(frame.beauty, here, run.canvas);
        const std::lock_guard lock(run.mutex);
        run.fresh.push_back(here);
    };
    auto frame = std::make_shared<const RenderedFrame>(pipeline.frame(now, settings, progress, tile_done));
    run.progress = 1.0f;
    return {seconds_since(start), std::move(frame), {}};
}

FinalFrame::Work::Work FinalFrame::renderer() {
    return [pipeline = std::make_shared<Pipeline>(), files = std::uint64_t{0}](
               const std::shared_ptr<Run>& run, const Progress& progress) mutable {
        if (std::exchange(files, run->request.files) != files) pipeline = std::make_shared<Pipeline>();
        try {
            return render(*pipeline, *run, progress);
        } catch (const std::bad_alloc&) {
            throw std::runtime_error("not enough memory for the final frame");
        }
    };
}

void FinalFrame::start(FinalRequest request) {
    run_ = std::make_shared<Run>();
    run_->request = std::move(request);
    work_.want(run_);
}

void FinalFrame::cancel() {
    work_.forget();
    run_.reset();
}

FinalFrame::Outcome FinalFrame::outcome() const {
    if (!run_) return {};
    const std::shared_ptr<const Found> found = work_.found(run_);
    if (!found) return {State::running, {}, 0.0, {}};
    return {found->error.empty() ? State::done : State::failed, found->error, found->seconds, found->frame};
}

float FinalFrame::progress() const { return run_ ? run_->progress.load() : 0.0f; }

std::vector<Region> FinalFrame::take_tiles(Image& image) {
    if (!run_) return {};
    const Region region = run_->request.part();
    if (image.width != region.width || image.height != region.height || image.channels != 4)
        image = make_image(region.width, region.height, 4);
    std::vector<Region> tiles;
    {
        const std::lock_guard lock(run_->mutex);
        tiles.swap(run_->fresh);
    }
    for (const Region& tile : tiles) copy_tile(run_->canvas, tile, image);
    return tiles;
}

}  // namespace astrosplat
