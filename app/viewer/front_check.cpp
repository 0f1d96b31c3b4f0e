#include "viewer/front_check.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "core/error.h"
#include "fidelity/signed_difference.h"
#include "measure_fidelity.h"

namespace astrosplat {

FrontRequest front_request(Scene now, std::vector<std::shared_ptr<const SplatSet>> sets,
                           std::uint64_t files) {
    OutputParams output;
    output.pixel_filter = now.output.pixel_filter;
    now.output = output;
    now.camera = {};
    now.environment = {};
    now.animation.clear();
    return {std::move(now), std::move(sets), files};
}

bool has_front_picture(const Scene& now) {
    return std::ranges::any_of(now.layers, [](const LayerParams& layer) {
        return layer.visible && layer.source.kind == SourceKind::mesh;
    });
}

bool front_changed_by_look(const Scene& now) {
    return std::ranges::any_of(now.layers, [](const LayerParams& layer) {
        LayerRender render = layer.render;
        render.lod = {};
        return layer.visible && !(layer.look == Look{} && render == LayerRender{});
    });
}

FrontCheck::FrontCheck(std::int64_t width_px, SetCache cache)
    : width_px_(width_px), cache_(std::move(cache)) {}
FrontCheck::~FrontCheck() { cancel(); }

void FrontCheck::want(const FrontRequest& request) {
    {
        const auto held = worker_.lock();
        if (asked_ && request == request_) return;
        *cancelled_ = true;
        request_ = request;
        found_.reset();
        asked_ = pending_ = true;
    }
    worker_.wake();
}

void FrontCheck::cancel() {
    const auto held = worker_.lock();
    if (found_) return;
    *cancelled_ = true;
    asked_ = pending_ = false;
}

bool FrontCheck::working() const {
    const auto held = worker_.lock();
    return asked_ && !found_;
}

std::shared_ptr<const FrontFound> FrontCheck::found(const FrontRequest& request) const {
    const auto held = worker_.lock();
    return asked_ && request == request_ ? found_ : nullptr;
}

Worker::Task FrontCheck::next_task() {
    if (!std::exchange(pending_, false)) return {};
    cancelled_ = std::make_shared<std::atomic<bool>>(false);
    return [this, request = request_, cancelled = cancelled_] { work(request, cancelled); };
}

void FrontCheck::work(const FrontRequest& request, const std::shared_ptr<std::atomic<bool>>& cancelled) {
    auto found = std::make_shared<FrontFound>();
    try {
        Progress progress;
        progress.cancelled = cancelled.get();
        const FidelityReference reference = fidelity_reference(request.scene, {}, progress, cache_);
        const std::int64_t width_px = std::min(width_px_, reference.picture.width);
        FrontComparison front = compare_front(request.scene, request.sets, reference, width_px, progress);
        found->difference = signed_difference(front.seen, front.picture);
        found->fidelity = std::move(front.fidelity);
    } catch (const Cancelled&) {
        return;
    } catch (const std::exception& error) {
        found->error = error.what();
    }
    const auto held = worker_.lock();
    if (!*cancelled) found_ = std::move(found);
}

}  // namespace astrosplat
