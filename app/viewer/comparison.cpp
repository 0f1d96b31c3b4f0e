#include "viewer/comparison.h"

#include <algorithm>
#include <utility>

#include "source/texture.h"

namespace astrosplat {
namespace {

/// A file's pixels as display values, grey ones in all three channels.
Image read_reference(const std::filesystem::path& file) {
    const Image raw = load_raw_image(file);
    Image rgba = make_image(raw.width, raw.height, 4, 1.0f);
    for (std::int64_t y = 0; y < raw.height; ++y)
        for (std::int64_t x = 0; x < raw.width; ++x)
            for (int c = 0; c < 3; ++c)
                rgba.at(x, y)[c] = raw.at(x, y)[std::min(c, raw.channels >= 3 ? 2 : 0)];
    return rgba;
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

void Comparison::take_snapshot(const Document& document, const ViewState& view, const Display& display,
                               glm::ivec2 size_px, const ViewFrameStatus& frame) {
    constexpr std::size_t most = 24;
    constexpr int thumbnail_px = 192;
    StoredView stored;
    stored.look = store_look("Look " + std::to_string(++snapshots_taken_), document, view);
    const Image small = thumbnail_of(display.read(), size_px.x, size_px.y, thumbnail_px);
    stored.thumbnail.upload(small);
    stored.aspect = static_cast<float>(small.width) / static_cast<float>(small.height);
    const bool final = frame.state == ViewFrameState::final;
    stored.splats = final ? frame.total : frame.shown;
    stored.seconds = final ? frame.seconds : 0.0;
    snapshots_.push_back(std::move(stored));
    if (snapshots_.size() > most) delete_snapshot(0);
}

void Comparison::delete_snapshot(std::size_t index) {
    if (index >= snapshots_.size()) return;
    snapshots_.erase(snapshots_.begin() + static_cast<std::ptrdiff_t>(index));
    if (b_snapshot_ == static_cast<int>(index)) b_snapshot_ = -1;
    if (b_snapshot_ > static_cast<int>(index)) --b_snapshot_;
}

void Comparison::clear_snapshots() {
    snapshots_.clear();
    b_snapshot_ = -1;
}

const StoredLook* Comparison::snapshot(std::size_t index) const {
    return index < snapshots_.size() ? &snapshots_[index].look : nullptr;
}

void Comparison::set_b(std::size_t index) {
    if (index < snapshots_.size()) b_snapshot_ = static_cast<int>(index);
}

void Comparison::load_reference(const std::filesystem::path& file) {
    if (file == reference_file_) return;
    reference_.upload(read_reference(file));
    reference_file_ = file;
    ++references_loaded_;
}

void Comparison::show(const Scene& scene, const ViewState& view, const ViewOfB& how, DisplaySettings& shown) {
    using Mode = DisplaySettings::Mode;
    comparing_ = view.compare != CompareMode::a && view.compare != CompareMode::front;
    if (!comparing_) return;
    const bool has_reference = reference_.handle() != 0;
    const bool with_reference = needs_reference(view);
    if (with_reference ? !has_reference : b_snapshot_ < 0) return;
    if (with_reference) {
        shown.b = reference_.handle();
        shown.b_is_display = true;
    } else {
        const StoredLook& look = snapshots_[static_cast<std::size_t>(b_snapshot_)].look;
        PreviewChoice choice = how.choice;
        choice.refined = false;  // two sums of whole sets would take twice the memory
        b_.show(how.request_for(with_look_of(scene, *look.scene)), choice, how.may_settle, how.now);
        shown.b = b_.texture();
    }
    shown.mode = view.compare == CompareMode::b            ? Mode::b
                 : view.compare == CompareMode::difference ? Mode::difference
                                                           : Mode::wipe;
    shown.difference_gain = view.difference_gain;
}

const ViewFrameStatus* Comparison::refining() const {
    return comparing_ && b_.status().state == ViewFrameState::refining ? &b_.status() : nullptr;
}

void Comparison::fill(Status& status) const {
    status.snapshots.clear();
    for (const StoredView& stored : snapshots_)
        status.snapshots.push_back({stored.look.name, to_handle(stored.thumbnail.handle()), stored.aspect,
                                    stored.splats, stored.seconds});
    status.b_snapshot = b_snapshot_;
    status.b_name = b_snapshot_ >= 0 ? snapshots_[static_cast<std::size_t>(b_snapshot_)].look.name : "";
}

}  // namespace astrosplat
