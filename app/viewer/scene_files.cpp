#include "viewer/scene_files.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "scene/layer_setup.h"
#include "source/texture.h"

namespace astrosplat {
namespace fs = std::filesystem;
namespace {

/// Of a layer's source: what the scene names, and what was found in there.
std::vector<fs::path> files_of(const LayerParams& layer, const SetLoader& loader) {
    std::vector<fs::path> paths = named_files(layer.source);
    if (const auto loaded = loader.layer(layer.name))
        paths.insert(paths.end(), loaded->files.begin(), loaded->files.end());
    return paths;
}

}  // namespace

const Image& PictureFiles::map(const fs::path& file, Derived derive) {
    std::unique_ptr<Image>& image = maps_[{file, derive}];
    if (!image) image = std::make_unique<Image>(load_map(file, derive));
    return *image;
}

bool PictureFiles::ByPictures::operator()(const EnvironmentParams& a, const EnvironmentParams& b) const {
    const auto key = [](const EnvironmentParams& p) {
        return std::tie(p.image, p.cube, p.tile, p.tiling.height_deg, p.tiling.seed, p.tiling.face_px);
    };
    return key(a) < key(b);
}

std::shared_ptr<const Environment> PictureFiles::environment(const EnvironmentParams& params) {
    constexpr std::size_t most_skies = 3;
    const bool seen = has_environment(params) && params.visible;
    const EnvironmentParams files = pictures_of(params);
    {
        const auto held = worker_.lock();
        wanted_ = seen ? std::optional(files) : std::nullopt;
        if (!seen) return nullptr;
        if (const auto known = skies_.find(files); known != skies_.end()) {
            const Sky& sky = known->second;
            if (sky.error) std::rethrow_exception(sky.error);
            if (!sky.loaded) return nullptr;
            Environment environment = *sky.loaded;
            set_environment_params(environment, params);
            return std::make_shared<const Environment>(std::move(environment));
        }
        if (skies_.size() >= most_skies)
            std::erase_if(skies_, [](const auto& sky) { return sky.second.rests(); });
        skies_[files];
    }
    worker_.wake();
    return nullptr;
}

bool PictureFiles::loading() const {
    const auto held = worker_.lock();
    const auto sky = wanted_ ? skies_.find(*wanted_) : skies_.end();
    return sky != skies_.end() && !sky->second.rests();
}

void PictureFiles::forget(const std::vector<fs::path>& files) {
    const auto is_changed = [&](const fs::path& file) {
        return std::ranges::find(files, file) != files.end();
    };
    old_maps_.clear();
    for (auto& [of, image] : maps_)
        if (is_changed(of.first)) old_maps_.push_back(std::move(image));
    {
        const auto held = worker_.lock();
        for (auto& [of, sky] : skies_)
            if (is_changed(of.image) || is_changed(of.tile) || std::ranges::any_of(of.cube, is_changed))
                sky.due = true;
    }
    worker_.wake();
}

/// The one that is waited for first.
Worker::Task PictureFiles::next_sky() {
    auto next = wanted_ ? skies_.find(*wanted_) : skies_.end();
    if (next == skies_.end() || !next->second.due)
        next = std::ranges::find_if(skies_, [](const auto& sky) { return sky.second.due; });
    if (next == skies_.end()) return {};
    next->second.due = false;
    next->second.loading = true;
    return [this, files = next->first] { load(files); };
}

void PictureFiles::load(const EnvironmentParams& params) {
    std::optional<Environment> loaded;
    std::exception_ptr error;
    try {
        loaded = load_environment(params);
    } catch (...) {
        error = std::current_exception();
    }
    const auto held = worker_.lock();
    Sky& sky = skies_[params];  // which stays while it is loading
    sky.loaded = std::move(loaded);
    sky.error = error;
    sky.loading = false;
}

void ColorManagement::update(const OcioParams& params, bool seen) {
    const fs::path file = config_file(params);
    if (!params.wanted() && (!seen || file.empty())) {
        asked_.reset();
        transform_.reset();
        status_.reset();
        return;
    }
    const Asked now{params, file, stamp_of(file)};
    if (asked_ == now) return;
    asked_ = now;
    read(now);
}

void ColorManagement::read(const Asked& now) {
    ColorStatus status;
    transform_.reset();
    try {
        if (!now.file.empty()) status.config = read_color_config(now.file);
        if (now.params.wanted()) transform_ = display_transform(now.params);
    } catch (const InputError& error) {
        status.error = error.what();
    }
    if (transform_) {
        status.display = transform_->display();
        status.view = transform_->view();
        status.space = transform_->space();
    }
    status_ = std::move(status);
}

bool DiskWatch::due(double now) {
    constexpr double every_s = 1.0;
    if (now - checked_at_s_ < every_s) return false;
    checked_at_s_ = now;
    return true;
}

void DiskWatch::watch(const Scene& scene, const SetLoader& loader, const fs::path& reference) {
    std::vector<fs::path> paths = picture_files(scene);
    for (const LayerParams& layer : scene.layers) {
        const std::vector<fs::path> more = files_of(layer, loader);
        paths.insert(paths.end(), more.begin(), more.end());
    }
    if (!reference.empty()) paths.push_back(reference);
    files_.watch(paths);
}

std::vector<fs::path> DiskWatch::changed() {
    std::vector<fs::path> files = files_.changed();
    if (!files.empty()) ++changes_;
    return files;
}

void outdate_layers_of(const std::vector<fs::path>& files, const Scene& scene, SetLoader& loader) {
    for (const LayerParams& layer : scene.layers) {
        const std::vector<fs::path> its = files_of(layer, loader);
        if (std::find_first_of(its.begin(), its.end(), files.begin(), files.end()) != its.end())
            loader.outdate(layer.name);
    }
    loader.want(scene);
}

}  // namespace astrosplat
