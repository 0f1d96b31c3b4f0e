#include "viewer/disk_watch.h"

#include <algorithm>

#include "scene/input_files.h"

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
