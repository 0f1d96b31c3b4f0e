#include "edit/watched_files.h"

#include <algorithm>
#include <utility>

#include "source/mesh.h"

namespace astrosplat {
namespace fs = std::filesystem;

std::vector<fs::path> named_files(const SourceParams& source) {
    if (source.kind != SourceKind::mesh) return {source.file};
    std::vector<fs::path> files;
    for (const MeshInput& input : source.meshes) {
        if (!is_builtin_mesh(input.mesh)) files.push_back(input.mesh);
        files.insert(files.end(), input.texture.begin(), input.texture.end());
    }
    return files;
}

std::vector<fs::path> all_files(const SourceParams& source) {
    std::vector<fs::path> files = named_files(source);
    if (source.kind != SourceKind::mesh) return files;
    for (const MeshInput& input : source.meshes) {
        if (is_builtin_mesh(input.mesh) || !input.texture.empty()) continue;
        const std::vector<fs::path> materials = obj_materials(input.mesh);
        files.insert(files.end(), materials.begin(), materials.end());
    }
    return files;
}

std::vector<fs::path> picture_files(const Scene& scene) {
    std::vector<fs::path> files = scene.environment.cube;
    files.push_back(scene.environment.image);
    for (const LayerParams& layer : scene.layers) files.push_back(layer.look.thickness.map);
    std::erase(files, fs::path());
    return files;
}

void WatchedFiles::watch(const std::vector<fs::path>& files) {
    std::map<fs::path, Entry> watched;
    for (const fs::path& file : files) {
        const auto known = files_.find(file);
        if (known != files_.end()) {
            watched.insert(*known);
        } else if (!watched.count(file)) {
            const FileStamp now = stamp_of(file);
            watched[file] = {now, now};
        }
    }
    files_ = std::move(watched);
}

std::vector<fs::path> WatchedFiles::changed() {
    std::vector<fs::path> found;
    for (auto& [file, entry] : files_) {
        const FileStamp now = stamp_of(file), before = std::exchange(entry.seen, now);
        if (now == FileStamp{} || now == entry.known || now != before) continue;
        entry.known = now;
        found.push_back(file);
    }
    return found;
}

}  // namespace astrosplat
