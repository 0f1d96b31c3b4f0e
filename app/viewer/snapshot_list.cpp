#include "viewer/snapshot_list.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
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

}  // namespace

void SnapshotList::open(const fs::path& scene_file, std::vector<std::string>& problems) {
    snapshots_.clear();
    folder_ = scene_file.empty() ? fs::path() : snapshot_folder(scene_file);
    if (folder_.empty()) return;
    for (KeptSnapshot& kept : read_snapshots(folder_, problems)) {
        StoredView view;
        view.look = {kept.facts.name, std::make_shared<const Scene>(std::move(kept.scene)), kept.facts.frame};
        view.picture = read_thumbnail(snapshot_picture(kept.file));
        view.thumbnail.upload(view.picture);
        view.splats = kept.facts.splats;
        view.seconds = kept.facts.seconds;
        view.file = kept.file;
        snapshots_.push_back(std::move(view));
    }
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
    StoredView& view = snapshots_.emplace_back();
    view.look = std::move(look);
    view.picture = std::move(picture);
    view.thumbnail.upload(view.picture);
    view.splats = splats;
    view.seconds = seconds;
    keep(view);
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

std::vector<Snapshot> SnapshotList::cards() const {
    std::vector<Snapshot> cards;
    for (const StoredView& view : snapshots_)
        cards.push_back({view.look.name, to_handle(view.thumbnail.handle()),
                         static_cast<float>(view.picture.width) / static_cast<float>(view.picture.height),
                         view.splats, view.seconds});
    return cards;
}

}  // namespace astrosplat
