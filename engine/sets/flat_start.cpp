#include "sets/flat_start.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "bodies/uv_surface.h"

namespace astrosplat {
namespace {

constexpr double most_splats = 1 << 16;

/// Mean of the texels [x, x + step) x [y, y + step) that there are, premultiplied.
glm::vec4 mean_of(const Image& image, std::int64_t x, std::int64_t y, std::int64_t step) {
    glm::vec4 sum(0.0f);
    const std::int64_t right = std::min(x + step, image.width), below = std::min(y + step, image.height);
    for (std::int64_t j = y; j < below; ++j)
        for (std::int64_t i = x; i < right; ++i) {
            const float* texel = image.at(i, j);
            sum += glm::vec4(texel[0], texel[1], texel[2], texel[3]);
        }
    return sum / static_cast<float>((right - x) * (below - y));
}

/// The side of a part in texels, so that all pictures have so many together.
std::int64_t step_of(std::span<const TexturedMesh> meshes) {
    double texels = 0.0;
    for (const TexturedMesh& mesh : meshes)
        for (const Texture& texture : mesh.textures)
            texels += static_cast<double>(texture.image.width) * static_cast<double>(texture.image.height);
    return std::max<std::int64_t>(1, std::llround(std::ceil(std::sqrt(texels / most_splats))));
}

void add_picture(const TexturedMesh& mesh, std::uint32_t material, std::int64_t step, KeptStore& store) {
    const Texture& texture = mesh.textures[material];
    const Image& image = texture.image;
    const UvSurface surface(mesh.mesh, material, image.width, image.height,
                            texture.wrap == TextureSettings::Wrap::repeat,
                            mesh.camera ? &*mesh.camera : nullptr);
    std::uint64_t id = std::uint64_t{material} << 32;
    for (std::int64_t y = 0; y < image.height; y += step)
        for (std::int64_t x = 0; x < image.width; x += step, ++id) {
            const glm::vec4 mean = mean_of(image, x, y, step);
            if (!(mean.a > 0.0f)) continue;
            const float half = 0.5f * static_cast<float>(step);
            const glm::vec2 uv((static_cast<float>(x) + half) / static_cast<float>(image.width),
                               1.0f - (static_cast<float>(y) + half) / static_cast<float>(image.height));
            surface.at(uv, [&](const SurfacePlace& place) {
                store.add(
                    {place.position, glm::vec3(mean) / mean.a, mean.a, 0.0f, id, uv, place.normal, 0, 0});
            });
        }
}

/// Scene units from one part to the next, where the mesh has the most texels a unit.
double spacing_of(const TexturedMesh& mesh, std::int64_t step) {
    double texels_per_unit = 0.0;
    for (std::uint32_t material = 0; material < mesh.textures.size(); ++material) {
        const Image& image = mesh.textures[material].image;
        const UvSurface surface(mesh.mesh, material, image.width, image.height, true);
        texels_per_unit = std::max(texels_per_unit, surface.texels_per_unit());
    }
    return texels_per_unit > 0.0 ? static_cast<double>(step) / texels_per_unit : 0.0;
}

}  // namespace

void show_flat(std::span<const TexturedMesh> meshes, KeptWatcher& watcher) {
    const std::int64_t step = step_of(meshes);
    double spacing = 0.0;
    for (const TexturedMesh& mesh : meshes) spacing = std::max(spacing, spacing_of(mesh, step));
    if (!(spacing > 0.0)) return;
    SplatSet empty;
    empty.spacing = glm::dvec3(spacing);
    empty.max_distance = 0.25 * spacing;  // one layer of a lattice has then as many splats
    empty.generated = true;
    watcher.begins(empty, bounds(meshes));
    for (const TexturedMesh& mesh : meshes)
        for (std::uint32_t material = 0; material < mesh.textures.size(); ++material) {
            KeptStore store;
            store.begin_run();
            add_picture(mesh, material, step, store);
            watcher.keeps(store.runs());
        }
}

}  // namespace astrosplat
