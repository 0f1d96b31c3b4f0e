#include "gaussians/gaussians.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "core/bounds.h"
#include "merge/cut.h"
#include "merge/tree.h"

namespace astrosplat {
namespace {

constexpr double frame_px = 65536.0;  // of the frame that shows the whole model: every splat has some size

/// A set of what the look left, because the tree is of a set.
std::shared_ptr<const SplatSet> set_of(const RenderLayer& layer) {
    const ShadedSplats& splats = *layer.splats;
    auto set = std::make_shared<SplatSet>();
    set->absorbs = layer.absorbs;
    set->position = splats.position;
    set->color = splats.color;
    set->alpha = splats.alpha;
    set->radius = splats.radius;
    set->id = splats.id;
    set->distance.resize(splats.position.size());
    std::ranges::fill(set->distance, 0.0f);
    return set;
}

/// A camera with parallel rays that shows all positions.
Camera camera_around(std::span<const RenderLayer> layers, const glm::dmat3& world_from_camera) {
    glm::dvec3 lo(1e300), hi(-1e300);
    for (const RenderLayer& layer : layers)
        for (const glm::vec3& p : layer.splats->position) {
            const glm::dvec3 place = layer.world_from_layer * (layer.scale * glm::dvec3(p)) + layer.translate;
            lo = glm::min(lo, place);
            hi = glm::max(hi, place);
        }
    const double size = std::max(glm::length(hi - lo), 1e-6);
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.world_from_camera = world_from_camera;
    camera.eye = 0.5 * (lo + hi) + 2.0 * size * world_from_camera[2];
    camera.focal_px = frame_px / (1.1 * size);
    camera.center_x_px = camera.center_y_px = 0.5 * frame_px;
    camera.near = 1e-3 * size;
    return camera;
}

ShadedSplats with_opacity(const RenderLayer& layer) {
    ShadedSplats splats = *layer.splats;
    for (float& alpha : splats.alpha) alpha *= layer.render.opacity;
    return splats;
}

}  // namespace

std::vector<ShadedSplats> reduce_splats(std::span<const RenderLayer> layers,
                                        const glm::dmat3& world_from_camera, std::int64_t count,
                                        const Progress& progress) {
    std::vector<ShadedSplats> reduced;
    std::int64_t all = 0;
    for (const RenderLayer& layer : layers) all += layer.splats->size();
    if (all <= count) {
        for (const RenderLayer& layer : layers) reduced.push_back(with_opacity(layer));
        return reduced;
    }
    RenderSettings frame;
    frame.width = frame.height = static_cast<std::int64_t>(frame_px);
    const Camera camera = camera_around(layers, world_from_camera);
    std::vector<MergedSplats> merged(layers.size());
    std::vector<DotSettings> dots;
    for (const RenderLayer& layer : layers) dots.emplace_back(layer.render);
    std::vector<CutLayer> cuts;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const std::shared_ptr<const SplatSet> set = set_of(layers[i]);
        const auto tree = std::make_shared<const MergeTree>(build_merge_tree(*set, progress));
        merged[i] = merge_splats({set, tree}, *layers[i].splats, progress);
        RenderLayer plain = layers[i];
        plain.render.lod = {};  // nobody looks from there, however near
        cuts.push_back(
            {&merged[i], &dots[i], make_projection(plain, static_cast<std::uint16_t>(i), camera, frame)});
    }
    CutSettings settings;
    settings.budget = count;
    settings.least_px = 0.0f;
    settings.width = settings.height = frame.width;
    return cut_splats(cuts, settings);
}

}  // namespace astrosplat
