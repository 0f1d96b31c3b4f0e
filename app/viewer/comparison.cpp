#include "viewer/comparison.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/reference_place.h"

namespace astrosplat {
namespace {

DisplaySettings::Mode mode_of(CompareMode compare, bool blink_shows_other) {
    using Mode = DisplaySettings::Mode;
    switch (compare) {
        case CompareMode::wipe:
            return Mode::wipe;
        case CompareMode::blink:
            return blink_shows_other ? Mode::b : Mode::a;
        case CompareMode::difference:
            return Mode::difference;
        default:
            return Mode::b;
    }
}

}  // namespace

Image thumbnail_of(const std::vector<unsigned char>& rgba, int width, int height, int most) {
    const int factor = std::max(1, (width + most - 1) / most);
    Image small = make_image(std::max(1, width / factor), std::max(1, height / factor), 4, 0.0f);
    for (std::int64_t y = 0; y < small.height; ++y)
        for (std::int64_t x = 0; x < small.width; ++x)
            for (int c = 0; c < 4; ++c) {
                int sum = 0;
                for (int j = 0; j < factor; ++j)
                    for (int i = 0; i < factor; ++i)
                        sum += rgba[static_cast<std::size_t>(((y * factor + j) * width + x * factor + i) * 4 +
                                                             c)];
                small.at(x, y)[c] = static_cast<float>(sum) / (255.0f * static_cast<float>(factor * factor));
            }
    return small;
}

void Comparison::open_snapshots(const std::filesystem::path& scene_file, std::vector<std::string>& problems) {
    snapshots_.open(scene_file, problems);
    b_snapshot_ = -1;
}

void Comparison::delete_snapshot(std::size_t index) {
    snapshots_.remove(index);
    if (b_snapshot_ == static_cast<int>(index)) b_snapshot_ = -1;
    if (b_snapshot_ > static_cast<int>(index)) --b_snapshot_;
}

void Comparison::set_b(std::size_t index) {
    if (index < snapshots_.size()) b_snapshot_ = static_cast<int>(index);
}

void Comparison::find_reference(const Scene& scene, const ViewState& view, Status& status) {
    const auto index = astrosplat::find_reference(scene, reference_view(view.view), view.frame);
    reference_.want(index ? scene.references[*index].file : std::filesystem::path());
    status.reference.reset();
    if (!index) return;
    status.reference.emplace();
    status.reference->index = *index;
    status.reference->error = reference_.error();
    if (const Image* picture = reference_.picture())
        status.reference->aspect = static_cast<double>(picture->width) / static_cast<double>(picture->height);
}

void Comparison::show(const Scene& scene, const ViewState& view, const ViewOfB& how, DisplaySettings& shown) {
    comparing_ = compares(view);
    blink_shows_other_ = std::fmod(std::floor(how.now * view.blink_hz), 2.0) == 1.0;
    if (!comparing_) return;
    if (view.compare_with == CompareWith::reference) {
        const auto index = astrosplat::find_reference(scene, reference_view(view.view), view.frame);
        const Image* picture = reference_.picture();
        if (!index || !picture) return;
        const ReferenceParams& reference = scene.references[*index];
        shown.b = reference_.texture();
        shown.b_is_display = true;
        shown.b_place = place_of(reference, double(picture->width) / double(picture->height), how.frame);
        shown.b_opacity = static_cast<float>(reference.opacity);
    } else {
        if (b_snapshot_ < 0) return;
        const StoredLook& look = snapshots_.look(static_cast<std::size_t>(b_snapshot_));
        PreviewChoice choice = how.choice;
        choice.refined = false;  // two sums of whole sets would take twice the memory
        b_.show(how.request_for(with_look_of(scene, *look.scene)), choice, how.may_settle, how.now);
        shown.b = b_.texture();
    }
    shown.mode = mode_of(view.compare, blink_shows_other_);
    shown.difference_gain = view.difference_gain;
}

const ViewFrameStatus* Comparison::refining() const {
    return comparing_ && b_.status().state == ViewFrameState::refining ? &b_.status() : nullptr;
}

void Comparison::fill(Status& status) const {
    status.snapshots = snapshots_.cards();
    status.b_snapshot = b_snapshot_;
    status.b_name = b_snapshot_ >= 0 ? snapshots_.look(static_cast<std::size_t>(b_snapshot_)).name : "";
}

}  // namespace astrosplat
