// One thread with one pipeline. Each request is a Run of its own, so that what a cancelled one still writes
// reaches nobody; tiles are copied into the run's canvas without a lock, since each is written once. The
// thread has the window's priority: the window sleeps between events, which serves it first, while a lower
// one would hold up the pool's threads at the end of every loop on a busy machine.
#include "viewer/final_frame.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <exception>
#include <mutex>
#include <new>
#include <utility>

#include "core/error.h"
#include "core/progress.h"
#include "pipeline.h"

namespace astrosplat {
namespace {

Region whole_region(const FinalRequest& request) {
    const Region& r = request.region;
    return r.width > 0 && r.height > 0 ? r : Region{0, 0, request.width, request.height};
}

void copy_tile(const Image& from, const Region& tile, Image& to) {
    const auto bytes = static_cast<std::size_t>(tile.width * from.channels) * sizeof(float);
    for (std::int64_t y = tile.y; y < tile.y + tile.height; ++y)
        std::memcpy(to.at(tile.x, y), from.at(tile.x, y), bytes);
}

}  // namespace

/// One request and what has come of it.
struct FinalFrame::Run {
    FinalRequest request;
    std::atomic<bool> cancelled{false};
    std::atomic<float> progress{0.0f};
    Image canvas;  // region-sized RGBA; a tile is whole before it appears in `fresh`

    std::mutex mutex;           // for all below
    std::vector<Region> fresh;  // px of the canvas
    Outcome outcome{State::running, {}, 0.0, {}};

    void end(Outcome how) {
        const std::lock_guard lock(mutex);
        outcome = std::move(how);
    }
};

FinalFrame::FinalFrame() = default;
FinalFrame::~FinalFrame() { cancel(); }

void FinalFrame::render(Pipeline& pipeline, Run& run) {
    const auto start = Clock::now();
    const FinalRequest& request = run.request;
    Progress progress;
    progress.cancelled = &run.cancelled;
    pipeline.set_scene(request.scene, request.sets, request.environment.get(), progress);
    const FrameScene now = pipeline.frame_scene(request.frame);
    RenderSettings settings = render_settings(now.scene.output);
    settings.width = request.width;
    settings.height = request.height;
    settings.region = request.region;
    settings.aov_depth = request.depth;
    settings.memory_limit_bytes = RenderSettings::what_is_free;
    settings.aov_coverage = settings.aov_count = settings.aov_layers = false;
    const Region region = whole_region(request);
    progress.report = [&run](double fraction) { run.progress = static_cast<float>(fraction); };
    const TileDone tile_done = [&run, region](const Region& tile, const RenderedFrame& frame) {
        const Region here{tile.x - region.x, tile.y - region.y, tile.width, tile.height};
        copy_tile(frame.beauty, here, run.canvas);
        const std::lock_guard lock(run.mutex);
        run.fresh.push_back(here);
    };
    auto frame = std::make_shared<RenderedFrame>(pipeline.frame(now, settings, progress, tile_done));
    run.end({State::done, {}, seconds_since(start), std::move(frame)});
    run.progress = 1.0f;
}

void FinalFrame::work(Run& run) {
    try {
        const Region region = whole_region(run.request);
        run.canvas = {region.width, region.height, 4, {}};
        run.canvas.pixels.resize(static_cast<std::size_t>(region.width * region.height * 4));
        const bool other_files = std::exchange(files_, run.request.files) != files_;
        if (!pipeline_ || other_files) pipeline_ = std::make_unique<Pipeline>();
        render(*pipeline_, run);
    } catch (const Cancelled&) {
        run.end({});
    } catch (const std::bad_alloc&) {
        run.end({State::failed, "not enough memory for the final frame", 0.0, {}});
    } catch (const std::exception& error) {
        run.end({State::failed, error.what(), 0.0, {}});
    }
}

void FinalFrame::replace(std::shared_ptr<Run> run) {
    {
        const auto held = worker_.lock();
        if (current_) current_->cancelled = true;
        current_ = next_ = std::move(run);
    }
    worker_.wake();
}

std::shared_ptr<FinalFrame::Run> FinalFrame::latest() const {
    const auto held = worker_.lock();
    return current_;
}

Worker::Task FinalFrame::next_run() {
    if (!next_) return {};
    return [this, run = std::exchange(next_, nullptr)] { work(*run); };
}

void FinalFrame::start(FinalRequest request) {
    auto run = std::make_shared<Run>();
    run->request = std::move(request);
    replace(std::move(run));
}

FinalFrame::Outcome FinalFrame::outcome() const {
    const std::shared_ptr<Run> run = latest();
    if (!run) return {};
    const std::lock_guard lock(run->mutex);
    return run->outcome;
}

float FinalFrame::progress() const {
    const std::shared_ptr<Run> run = latest();
    return run ? run->progress.load() : 0.0f;
}

std::vector<Region> FinalFrame::take_tiles(Image& image, Outcome* outcome) {
    const std::shared_ptr<Run> run = latest();
    if (outcome) *outcome = {};
    if (!run) return {};
    const Region region = whole_region(run->request);
    if (image.width != region.width || image.height != region.height || image.channels != 4)
        image = make_image(region.width, region.height, 4);
    std::vector<Region> tiles;
    {
        const std::lock_guard lock(run->mutex);
        tiles.swap(run->fresh);
        if (outcome) *outcome = run->outcome;
    }
    for (const Region& tile : tiles) copy_tile(run->canvas, tile, image);
    return tiles;
}

}  // namespace astrosplat
