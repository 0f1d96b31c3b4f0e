#include "viewer/final_frames.h"

#include "core/memory.h"

namespace astrosplat {
namespace {

/// Histograms may come later than the set. What grows has none yet, and every sample of it is another.
bool same_set(const std::shared_ptr<const LoadedLayer>& a, const std::shared_ptr<const LoadedLayer>& b) {
    const auto set_of = [](const LoadedLayer& layer) { return layer.set ? layer.set : layer.sample.set; };
    return (a ? set_of(*a) : nullptr) == (b ? set_of(*b) : nullptr);
}

}  // namespace

bool have_same_sets(const ViewRequest& a, const ViewRequest& b) {
    return std::ranges::equal(a.layers, b.layers, same_set);
}

bool ask_the_same(const FrameRequest& a, const FrameRequest& b) {
    const auto view = [](const FrameRequest& r) { return std::tie(r.width, r.height, r.files, r.frame); };
    return view(a) == view(b) && a.region == b.region &&
           a.scene.camera == b.scene.camera &&  // soon found out
           a.scene == b.scene;
}

namespace {

std::shared_ptr<const SplatSet> set_of(const std::shared_ptr<const LoadedLayer>& layer) {
    return layer ? layer->set : nullptr;
}

/// There was a set, and nothing holds it any more.
bool gone(const std::weak_ptr<const SplatSet>& set) {
    const std::weak_ptr<const SplatSet> none;
    return set.expired() && (set.owner_before(none) || none.owner_before(set));
}

std::int64_t bytes_of(const RenderedFrame& frame) {
    std::int64_t values = 0;
    for (const Image* image : {&frame.beauty, &frame.depth, &frame.opacity})
        values += image->width * image->height * image->channels;
    return values * static_cast<std::int64_t>(sizeof(float));
}

}  // namespace

const FinalFrames::Kept* FinalFrames::find(const ViewRequest& request) {
    drop([](const Kept& kept) { return std::ranges::any_of(kept.sets, gone); });
    for (Kept& kept : kept_) {
        const auto is_set = [](const auto& layer, const auto& set) { return set_of(layer) == set.lock(); };
        if (!ask_the_same(kept.request, request)) continue;
        if (!std::ranges::equal(request.layers, kept.sets, is_set)) continue;
        kept.used = ++clock_;
        return &kept;
    }
    return nullptr;
}

bool FinalFrames::keep(const ViewRequest& request, std::shared_ptr<const RenderedFrame> frame,
                       double seconds) {
    full_ = !make_room(bytes_of(*frame));
    if (full_) return false;
    Kept kept{request, {}, std::move(frame), seconds, ++clock_};
    for (const auto& layer : request.layers) kept.sets.push_back(set_of(layer));
    bytes_ += bytes_of(*kept.frame);
    kept_.push_back(std::move(kept));
    return true;
}

bool FinalFrames::make_room(std::int64_t bytes) {
    const std::int64_t most = std::min(most_bytes_, (available_memory_bytes() + bytes_) / 4);
    while (!kept_.empty() && bytes_ + bytes > most) {
        const std::uint64_t oldest = std::ranges::min_element(kept_, {}, &Kept::used)->used;
        if (oldest > round_ && bytes_ <= most) break;
        drop([&](const Kept& kept) { return kept.used == oldest; });
    }
    return bytes_ + bytes <= most;
}

void FinalFrames::drop(const std::function<bool(const Kept&)>& which) {
    const std::size_t before = kept_.size();
    std::erase_if(kept_, which);
    if (kept_.size() == before) return;
    ++drops_;
    bytes_ = 0;
    for (const Kept& kept : kept_) bytes_ += bytes_of(*kept.frame);
}

}  // namespace astrosplat
