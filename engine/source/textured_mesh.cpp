#include "source/textured_mesh.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <utility>

#include "core/error.h"
#include "core/log.h"
#include "source/obj.h"
#include "source/picture_camera.h"
#include "source/planar_uv.h"
#include "source/relief.h"
#include "source/shapes.h"

namespace astrosplat {
namespace {

using Wrap = TextureSettings::Wrap;

constexpr const char* neutral_summary = "neutral grey";

// Beyond a picture of a given width lies nothing; one that is stretched over the mesh has no beyond.
Wrap default_wrap(const SourceParams& source, Wrap of_own_uv) {
    if (source.uv == UvMode::mesh) return of_own_uv;
    return source.uv == UvMode::camera || source.uv_width > 0.0 ? Wrap::black : Wrap::clamp;
}

// Of a mesh's own uv.
Wrap own_wrap(const MeshInput& input) { return is_builtin_mesh(input.mesh) ? Wrap::clamp : Wrap::repeat; }

double aspect_of(const Image& image) {
    return static_cast<double>(image.width) / static_cast<double>(image.height);
}

// Of the first of its pictures that it uses.
double aspect_of(const TexturedMesh& mesh) {
    for (const Texture& texture : mesh.textures)
        if (texture.image.height > 0) return aspect_of(texture.image);
    return 1.0;
}

// Pictures of a source, wrapped as its settings or else its mesh wants it.
using PictureLoader = std::function<Texture(const std::vector<std::filesystem::path>& files, Wrap)>;

TexturedMesh load_builtin(const MeshInput& input, const SourceParams& source, const PictureLoader& load) {
    const std::string name = input.mesh.string();
    TexturedMesh loaded;
    loaded.textures.push_back(load(input.texture, default_wrap(source, own_wrap(input))));
    const Texture& texture = loaded.textures.front();
    const double aspect = aspect_of(texture.image);
    loaded.mesh = name == "relief"        ? relief_mesh(texture, input.relief)
                  : name == "sheet"       ? sheet_mesh(texture, input.shape)
                  : is_turned_shape(name) ? turned_shape(name, input.shape)
                                          : builtin_mesh(name, aspect);
    return loaded;
}

// Of a material; none where it names no picture.
std::vector<std::filesystem::path> map_of(const Mesh& mesh, std::size_t material) {
    if (material >= mesh.maps.size() || mesh.maps[material].empty()) return {};
    return {mesh.maps[material]};
}

// Stands for the picture that a mesh has not.
Texture neutral_grey() {
    constexpr float grey = 0.18f;  // as reflective as the world is on average
    Texture texture;
    texture.image = make_image(16, 16, 4);
    for (std::size_t i = 0; i < texture.image.pixels.size(); ++i)
        texture.image.pixels[i] = i % 4 == 3 ? 1.0f : grey;
    texture.summary = neutral_summary;
    return texture;
}

bool is_neutral(const Texture& texture) { return texture.summary == neutral_summary; }

// The picture of a mesh as its source wants it read.
Texture load_picture(const std::vector<std::filesystem::path>& files, const SourceParams& source, Wrap wrap,
                     const Progress& progress, const PictureReaders& readers) {
    if (files.empty()) return neutral_grey();
    return load_texture(files, source.texture, wrap, progress, readers);
}

// One picture per material that a face uses; others get an empty one, so that indices stay.
std::vector<Texture> load_maps(const Mesh& mesh, Wrap wrap, const PictureLoader& load) {
    std::vector<bool> used(std::max<std::size_t>(1, mesh.maps.size()), false);
    for (const Mesh::Triangle& face : mesh.triangles) used[mesh.maps.empty() ? 0 : face.material] = true;
    std::vector<Texture> textures(used.size());
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (!used[i]) continue;
        textures[i] = load(map_of(mesh, i), wrap);
    }
    return textures;
}

TexturedMesh load_file(const MeshInput& input, const SourceParams& source, const PictureLoader& load,
                       const Progress& progress) {
    const Wrap wrap = default_wrap(source, own_wrap(input));
    TexturedMesh loaded;
    loaded.mesh = load_obj(input.mesh, progress);
    if (input.texture.empty()) {
        loaded.textures = load_maps(loaded.mesh, wrap, load);
    } else {
        loaded.textures.push_back(load(input.texture, wrap));
    }
    return loaded;
}

}  // namespace

Bounds bounds(std::span<const TexturedMesh> meshes) {
    Bounds box;
    for (const TexturedMesh& m : meshes) box.add(bounds(m.mesh));
    return box;
}

std::vector<TexturedMesh> load_meshes(const SourceParams& source, const Progress& progress,
                                      const PictureReaders& readers) {
    if (source.meshes.empty()) bad_input("source.meshes", "", "at least one mesh", "none");
    const PictureLoader load = [&](const std::vector<std::filesystem::path>& files, Wrap wrap) {
        return load_picture(files, source, wrap, progress, readers);
    };
    std::vector<TexturedMesh> meshes;
    for (const MeshInput& input : source.meshes) {
        meshes.push_back(is_builtin_mesh(input.mesh) ? load_builtin(input, source, load)
                                                     : load_file(input, source, load, progress));
    }
    for (const TexturedMesh& m : meshes)
        if (std::ranges::any_of(m.textures, is_neutral))
            log_warning(m.mesh.name + " has no picture, for which neutral grey stands");
    const Bounds box = bounds(meshes);
    for (TexturedMesh& m : meshes) {
        if (source.uv == UvMode::camera) {
            m.camera = picture_camera(source.uv_camera, aspect_of(m));
            apply_camera_uv(m.mesh, *m.camera);
        } else {
            apply_source_uv(m.mesh, source, box, aspect_of(m));
        }
        for (Texture& texture : m.textures) apply_mask(texture);
    }
    return meshes;
}

void reload_pictures(const SourceParams& source, std::vector<TexturedMesh>& meshes, const Progress& progress,
                     const PictureReaders& readers) {
    assert(meshes.size() == source.meshes.size());
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        const MeshInput& input = source.meshes[m];
        for (std::size_t i = 0; i < meshes[m].textures.size(); ++i) {
            Texture& texture = meshes[m].textures[i];
            if (texture.image.width == 0) continue;  // no face uses it
            const auto files = input.texture.empty() ? map_of(meshes[m].mesh, i) : input.texture;
            texture = load_picture(files, source, default_wrap(source, own_wrap(input)), progress, readers);
            apply_mask(texture);
        }
    }
}

}  // namespace astrosplat
