#include "viewer/comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/color.h"
#include "core/error.h"
#include "scene/reference_place.h"
#include "source/texture.h"
#include "source/write_image.h"

namespace astrosplat {

namespace fs = std::filesystem;
namespace {

std::string png_of(const Image& rgba) {
    std::vector<unsigned char> rgb;
    for (std::size_t i = 0; i < rgba.pixels.size(); ++i)
        if (i % 4 != 3)
            rgb.push_back(
                static_cast<unsigned char>(std::lround(255.0f * std::clamp(rgba.pixels[i], 0.0f, 1.0f))));
    return png_bytes(rgba.width, rgba.height, rgb);
}

/// Black where it is gone: a snapshot is its scene.
Image read_thumbnail(const fs::path& file) {
    try {
        const Image raw = load_raw_image(file);
        Image rgba = make_image(raw.width, raw.height, 4, 1.0f);
        for (std::int64_t y = 0; y < raw.height; ++y)
            for (std::int64_t x = 0; x < raw.width; ++x)
                for (int c = 0; c < 3; ++c) rgba.at(x, y)[c] = raw.at(x, y)[std::min(c, raw.channels - 1)];
        return rgba;
    } catch (const InputError&) {
        return make_image(16, 9, 4, 0.0f);
    }
}

DisplaySettings::Mode mode_of(CompareMode compare, bool blink_shows_other) {
    using Mode = DisplaySettings::Mode;
    if (compare == CompareMode::wipe) return Mode::wipe;
    if (compare == CompareMode::difference) return Mode::difference;
    return compare == CompareMode::blink && !blink_shows_other ? Mode::a : Mode::b;
}

/// Linear light of display values, from a table: 3e-7 of white off at most.
class LightTable {
  public:
    LightTable() {
        for (std::size_t i = 0; i < light_.size(); ++i)
            light_[i] = real::srgb_to_linear(std::min(1.0, double(i) / steps));
    }
    double operator()(float displayed) const {
        const double at = std::clamp(double(displayed), 0.0, 1.0) * steps;
        const auto i = static_cast<std::size_t>(at);
        return light_[i] + (light_[i + 1] - light_[i]) * (at - double(i));
    }

  private:
    static constexpr int steps = 1024;
    std::array<double, steps + 2> light_;
};

}  // namespace

void SnapshotList::open(const fs::path& scene_file, std::vector<std::string>& problems) {
    snapshots_.clear();
    b_ = no_b;
    folder_ = scene_file.empty() ? fs::path() : snapshot_folder(scene_file);
    if (folder_.empty()) return;
    for (KeptSnapshot& kept : read_snapshots(folder_, problems))
        push({{kept.facts.name, std::make_shared<const Scene>(std::move(kept.scene)), kept.facts.frame},
              read_thumbnail(snapshot_picture(kept.file)),
              kept.facts.splats,
              kept.facts.seconds,
              kept.file});
}

SnapshotList::StoredView& SnapshotList::push(StoredView view) {
    view.thumbnail.upload(view.picture);
    return snapshots_.emplace_back(std::move(view));
}

void SnapshotList::keep(StoredView& view) const {
    if (folder_.empty() || view.file.parent_path() == folder_) return;
    const SnapshotFacts facts{view.look.name, view.look.frame, view.splats, view.seconds};
    view.file = write_snapshot(folder_, facts, *view.look.scene, png_of(view.picture));
}

void SnapshotList::move_to(const fs::path& scene_file) {
    folder_ = snapshot_folder(scene_file);
    for (StoredView& view : snapshots_) keep(view);
}

void SnapshotList::add(StoredLook look, Image picture, std::int64_t splats, double seconds) {
    keep(push({std::move(look), std::move(picture), splats, seconds, {}}));
}

void SnapshotList::rename(std::size_t index, const std::string& name) {
    if (index >= snapshots_.size() || name.empty()) return;
    StoredView& view = snapshots_[index];
    if (!view.file.empty()) rename_snapshot(view.file, name);
    view.look.name = name;
}

void SnapshotList::remove(std::size_t index) {
    if (index >= snapshots_.size()) return;
    if (const fs::path& file = snapshots_[index].file; !file.empty()) remove_snapshot(file);
    snapshots_.erase(snapshots_.begin() + static_cast<std::ptrdiff_t>(index));
    if (b_ == index) b_ = no_b;
    if (b_ != no_b && b_ > index) --b_;
}

std::string SnapshotList::next_name() const {
    const auto is_taken = [&](const std::string& name) {
        return std::ranges::any_of(snapshots_,
                                   [&](const StoredView& view) { return view.look.name == name; });
    };
    std::string name;
    for (std::size_t number = snapshots_.size() + 1; name.empty() || is_taken(name); ++number)
        name = "Look " + std::to_string(number);
    return name;
}

void SnapshotList::fill(Status& status) const {
    status.snapshots.clear();
    for (const StoredView& view : snapshots_)
        status.snapshots.push_back(
            {view.look.name, to_handle(view.thumbnail.handle()),
             static_cast<float>(view.picture.width) / static_cast<float>(view.picture.height), view.splats,
             view.seconds});
    status.b_snapshot = b() ? static_cast<int>(b_) : -1;
    status.b_name = b() ? b()->name : "";
}

Image thumbnail_of(const std::vector<unsigned char>& rgba, int width, int height, int most) {
    const int factor = std::max(1, (width + most - 1) / most);
    const int rows = std::min(factor, height);  // of a block, in a view lower than a block is wide
    Image small = make_image(std::max(1, width / factor), std::max(1, height / factor), 4, 0.0f);
    for (std::int64_t y = 0; y < small.height; ++y)
        for (std::int64_t x = 0; x < small.width; ++x)
            for (int c = 0; c < 4; ++c) {
                int sum = 0;
                for (int j = 0; j < rows; ++j)
                    for (int i = 0; i < factor; ++i)
                        sum += rgba[static_cast<std::size_t>(((y * factor + j) * width + x * factor + i) * 4 +
                                                             c)];
                small.at(x, y)[c] = static_cast<float>(sum) / (255.0f * static_cast<float>(factor * rows));
            }
    return small;
}

void Comparison::find_reference(const Scene& scene, const ViewState& view, Status& status) {
    const auto index = astrosplat::find_reference(scene, reference_view(view.view), view.frame);
    reference_.want(index ? scene.references[*index].file : std::filesystem::path());
    status.reference.reset();
    if (!index) return;
    status.reference.emplace();
    status.reference->index = *index;
    status.reference->error = reference_.error();
    if (reference_.picture()) status.reference->aspect = reference_.aspect();
}

void Comparison::show(const Scene& scene, const ViewState& view, const ViewOfB& how, DisplaySettings& shown) {
    comparing_ = compares(view);
    blink_shows_other_ = std::fmod(std::floor(how.now * view.blink_hz), 2.0) == 1.0;
    if (!comparing_) return;
    if (view.compare_with == CompareWith::reference) {
        const auto index = astrosplat::find_reference(scene, reference_view(view.view), view.frame);
        if (!index || !reference_.picture()) return;
        const ReferenceParams& reference = scene.references[*index];
        shown.b = reference_.texture();
        shown.b_is_display = true;
        shown.b_place = place_of(reference, reference_.aspect(), how.frame);
        shown.b_opacity = static_cast<float>(reference.opacity);
    } else {
        if (!how.look) return;
        PreviewChoice choice = how.choice;
        choice.refined = false;  // two sums of whole sets would take twice the memory
        b_.show(how.request_for(with_look_of(scene, *how.look->scene)), choice, how.may_settle, how.now);
        shown.b = b_.texture();
    }
    shown.mode = mode_of(view.compare, blink_shows_other_);
    shown.difference_gain = view.difference_gain;
}

const ViewFrameStatus* Comparison::refining() const {
    return comparing_ && b_.status().state == ViewFrameState::refining ? &b_.status() : nullptr;
}

std::optional<DifferenceStatus> difference_of(const Image& a, const Image& b) {
    static const LightTable light;
    double sum = 0.0, squares = 0.0, light_a = 0.0, light_b = 0.0;
    std::int64_t count = 0;
    for (std::int64_t i = 0; i < a.width * a.height; ++i) {
        const float *const pa = a.pixels.data() + 4 * i, *const pb = b.pixels.data() + 4 * i;
        if (pb[3] < 1.0f) continue;
        for (int c = 0; c < 3; ++c) {
            const double difference = double(pa[c]) - double(pb[c]);
            sum += difference;
            squares += difference * difference;
            light_a += light(pa[c]);
            light_b += light(pb[c]);
        }
        count += 3;
    }
    if (count == 0) return std::nullopt;
    const double mean_square = squares / double(count);
    DifferenceStatus found;
    found.mean = sum / double(count);
    found.psnr_db =
        mean_square > 0.0 ? -10.0 * std::log10(mean_square) : std::numeric_limits<double>::infinity();
    found.light = light_b > 0.0   ? light_a / light_b
                  : light_a > 0.0 ? std::numeric_limits<double>::infinity()
                                  : 1.0;
    return found;
}

void DifferenceMeter::measure(Display& display, const DisplaySettings& shown, glm::ivec2 target_px,
                              double now) {
    constexpr double every_s = 0.25;
    waiting_ = !(shown == measured_ && target_px == target_px_);
    if (!waiting_ || (measured_at_ >= 0.0 && now - measured_at_ < every_s)) return;
    const Display::Compared sides = display.read_compared(shown, target_px.x, target_px.y);
    found_ = difference_of(sides.a, sides.b);
    measured_ = shown;
    target_px_ = target_px;
    measured_at_ = now;
    waiting_ = false;
}

}  // namespace astrosplat
