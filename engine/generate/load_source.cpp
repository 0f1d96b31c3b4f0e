// The front door of a layer's source: meshes and pictures from files or built in, or a splat file.
#include "generate/load_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "generate/generate.h"
#include "source/obj.h"
#include "source/relief.h"
#include "splat_files/splat_file.h"

namespace astrosplat {
namespace {

using Wrap = TextureSettings::Wrap;

TexturedMesh load_builtin(const MeshInput& input, const SourceParams& source, const Progress& progress) {
    const std::string name = input.mesh.string();
    if (input.texture.empty()) bad_input(name, "texture", "a picture, which built-in meshes need", "none");
    TexturedMesh loaded;
    loaded.textures.push_back(load_texture(input.texture, source.texture, Wrap::clamp, progress));
    const Texture& texture = loaded.textures.front();
    const double aspect =
        static_cast<double>(texture.image.width) / static_cast<double>(texture.image.height);
    loaded.mesh = name == "relief" ? relief_mesh(texture, input.relief) : builtin_mesh(name, aspect);
    return loaded;
}

// One picture per material that a face uses; others get an empty one, so that indices stay.
std::vector<Texture> load_maps(const Mesh& mesh, const TextureSettings& settings, Wrap wrap,
                               const Progress& progress) {
    std::vector<bool> used(std::max<std::size_t>(1, mesh.maps.size()), false);
    for (const Mesh::Triangle& face : mesh.triangles) used[mesh.maps.empty() ? 0 : face.material] = true;
    std::vector<Texture> textures(used.size());
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (!used[i]) continue;
        if (i >= mesh.maps.size() || mesh.maps[i].empty()) {
            bad_input(mesh.name, "", "a texture in the scene, or a material with map_Kd for every face",
                      "neither");
        }
        textures[i] = load_texture({mesh.maps[i]}, settings, wrap, progress);
    }
    return textures;
}

TexturedMesh load_file(const MeshInput& input, const SourceParams& source, const Progress& progress) {
    const Wrap wrap = source.uv == UvMode::mesh ? Wrap::repeat : Wrap::clamp;
    TexturedMesh loaded;
    loaded.mesh = load_obj(input.mesh, progress);
    if (input.texture.empty()) {
        loaded.textures = load_maps(loaded.mesh, source.texture, wrap, progress);
    } else {
        loaded.textures.push_back(load_texture(input.texture, source.texture, wrap, progress));
    }
    return loaded;
}

std::string describe_lattice(const Lattice& lattice, double max_distance, std::int64_t bytes) {
    const glm::dvec3 voxel = lattice.spacing();
    const bool cubic =
        std::max({voxel.x, voxel.y, voxel.z}) <= std::min({voxel.x, voxel.y, voxel.z}) * 1.000001;
    const std::string size = cubic ? fmt::format("{:.4g}", voxel.x)
                                   : fmt::format("{:.4g} x {:.4g} x {:.4g}", voxel.x, voxel.y, voxel.z);
    return fmt::format("{} x {} x {} voxels of {}, {} positions, max distance {:.4g}, about {}", lattice.n.x,
                       lattice.n.y, lattice.n.z, size, human_count(static_cast<double>(lattice.positions())),
                       max_distance, human_bytes(static_cast<double>(bytes)));
}

// Reading inputs is heard by a request to stop, but is no share of the work reported.
Progress cancel_only(const Progress& progress) { return {{}, progress.cancelled}; }

SplatSet generate_source(const SourceParams& source, const std::string& layer_name, const Progress& progress,
                         KeptWatcher* watcher) {
    const std::vector<TexturedMesh> meshes = load_meshes(source, cancel_only(progress));
    for (const TexturedMesh& m : meshes) {
        for (const Texture& texture : m.textures) {
            if (!texture.summary.empty())
                log_detail(fmt::format("layer '{}': {}", layer_name, texture.summary));
        }
    }
    const double max_distance = resolved_max_distance(source, bounds(meshes));
    const Lattice lattice = make_lattice(source, meshes, max_distance);
    const std::int64_t bytes = generate_memory_bytes(meshes, lattice, max_distance);
    log_info(fmt::format("layer '{}': {}", layer_name, describe_lattice(lattice, max_distance, bytes)));
    const std::uint32_t seed = resolved_seed(source.seed, layer_name);
    SplatSet set = generate(meshes, lattice, max_distance, source.jitter, seed, progress, watcher);
    log_detail(fmt::format("layer '{}': kept {} of {} positions, {} more have alpha 0", layer_name,
                           set.size(), set.test_positions, set.zero_alpha));
    return set;
}

SplatSet read_source(const SourceParams& source, const Progress& progress) {
    SplatSet set = read_splats(source.file, progress);
    sort_by_id(set);
    if (set.max_distance <= 0.0 && !set.distance.empty()) {
        set.max_distance = *std::ranges::max_element(set.distance);
    }
    return set;
}

}  // namespace

std::vector<TexturedMesh> load_meshes(const SourceParams& source, const Progress& progress) {
    if (source.meshes.empty()) bad_input("source.meshes", "", "at least one mesh", "none");
    std::vector<TexturedMesh> meshes;
    for (const MeshInput& input : source.meshes) {
        meshes.push_back(is_builtin_mesh(input.mesh) ? load_builtin(input, source, progress)
                                                     : load_file(input, source, progress));
    }
    const Bounds box = bounds(meshes);
    for (TexturedMesh& m : meshes) apply_uv(m.mesh, source.uv, box);
    return meshes;
}

SplatSet load_source(const SourceParams& source, const std::string& layer_name, const Progress& progress,
                     KeptWatcher* watcher) try {
    switch (source.kind) {
        case SourceKind::mesh:
            return generate_source(source, layer_name, progress, watcher);
        case SourceKind::splats:
            return read_source(source, progress);
        case SourceKind::stars:
            break;
    }
    throw InputError("kind = \"stars\" comes with a later release");
} catch (const InputError& error) {
    throw InputError(fmt::format("layer '{}': {}", layer_name, error.what()));
}

}  // namespace astrosplat
