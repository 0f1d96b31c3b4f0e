#include "scene/input_files.h"

#include <algorithm>

#include "source/mesh.h"
#include "source/obj.h"

namespace astrosplat {
namespace fs = std::filesystem;

std::vector<fs::path> named_files(const SourceParams& source) {
    if (source.kind == SourceKind::splats) return {source.file};
    if (source.kind == SourceKind::stars)
        return source.stars.catalogue.empty() ? std::vector<fs::path>() : std::vector{source.stars.catalogue};
    std::vector<fs::path> files;
    for (const MeshInput& input : source.meshes) {
        if (!is_builtin_mesh(input.mesh)) files.push_back(input.mesh);
        files.insert(files.end(), input.texture.begin(), input.texture.end());
        if (!input.shape.depth_map.empty()) files.push_back(input.shape.depth_map);
    }
    const PrepareParams& prepare = source.texture.prepare;
    for (const fs::path& file : {prepare.align, prepare.fill, prepare.mask})
        if (!file.empty()) files.push_back(file);
    for (const MaskParams& mask : source.texture.mask) {
        if (!mask.image.empty()) files.push_back(mask.image);
        for (const MaskTerms& terms : mask.any)
            if (!terms.image.empty()) files.push_back(terms.image);
    }
    return files;
}

std::vector<fs::path> all_files(const SourceParams& source) {
    std::vector<fs::path> files = named_files(source);
    if (source.kind != SourceKind::mesh) return files;
    for (const MeshInput& input : source.meshes) {
        if (!has_own_pictures(input)) continue;
        const std::vector<fs::path> materials = obj_materials(input.mesh);
        files.insert(files.end(), materials.begin(), materials.end());
    }
    return files;
}

bool has_own_pictures(const MeshInput& input) {
    const auto is_empty = [](const fs::path& file) { return file.empty(); };
    return !is_builtin_mesh(input.mesh) && std::ranges::all_of(input.texture, is_empty);
}

std::vector<fs::path> picture_files(const Scene& scene) {
    std::vector<fs::path> files = scene.environment.cube;
    files.push_back(scene.environment.image);
    files.push_back(scene.environment.tile);
    for (const LayerParams& layer : scene.layers) files.push_back(layer.look.thickness.map);
    std::erase(files, fs::path());
    return files;
}

}  // namespace astrosplat
