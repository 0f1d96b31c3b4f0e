// A block is as near as the nearest point of its box, and as far as the farthest of its corners; both with a
// margin for the largest radius, within which children lie, and for what floats round away.
#include "render/scatter.h"

#include "camera/projection.h"

namespace astrosplat {
namespace {

constexpr double rounding = 1e-5;  // of distances; floats round by 1e-7

/// A block's box in camera space.
struct BlockPlace {
    glm::dvec3 center;
    double ball = 0.0;             // all of its splats, with their radii, lie so near the centre
    double near = 0.0, far = 0.0;  // what distances are sorted by
};

double length(const glm::dvec3& v) { return std::sqrt(glm::dot(v, v)); }

BlockPlace place_of(const LayerProjection& layer, const BlockFacts& block) {
    const auto to_camera = [&](const glm::dvec3& p) {
        return layer.camera_from_layer * p + layer.origin_in_camera;
    };
    const double scale = double(layer.layer_scale);
    const double reach = double(block.radius * layer.radius_scale);
    BlockPlace place;
    place.center = to_camera(block.box.center());
    double farthest = 0.0, deepest = -std::numeric_limits<double>::infinity(), nearest = -deepest,
           size = reach;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 corner = to_camera(block.box.corner(i));
        place.ball = std::max(place.ball, length(corner - place.center));
        farthest = std::max(farthest, length(corner));
        nearest = std::min(nearest, -corner.z);
        deepest = std::max(deepest, -corner.z);
        size = std::max(size, scale * length(block.box.corner(i)));
    }
    if (!shared::has_parallel_rays(layer.lens)) {
        const glm::dvec3 eye =
            glm::transpose(layer.camera_from_layer) * -layer.origin_in_camera / (scale * scale);
        nearest = scale * length(glm::clamp(eye, block.box.lo, block.box.hi) - eye);
        deepest = farthest;
    }
    const double margin = reach + rounding * (size + std::fabs(deepest));
    place.ball += margin;
    place.near = nearest - margin;
    place.far = deepest + margin;
    return place;
}

std::uint32_t key_of(double depth) {
    const double most = 3.4e38;
    return std::bit_cast<std::uint32_t>(float(std::clamp(depth, 0.0, most)));
}

DepthRange depths_of(const Lens& lens, const BlockPlace& place) {
    const double near = std::max(0.0, place.near), far = std::max(0.0, place.far);
    if (shared::has_parallel_rays(lens)) return {key_of(near), key_of(far)};
    return {key_of(near * near * (1.0 - rounding)), key_of(far * far * (1.0 + rounding))};
}

/// Judged by the corners of the box, grown by the largest radius, for a lens that shows straight lines
/// straight: all of it lies between them, its footprints within the widest of theirs. True where a corner is
/// not before the camera.
bool may_show_between_corners(const LayerProjection& layer, const BlockFacts& block, const ScreenRect& rect) {
    const Bounds grown{block.box.lo - double(block.radius), block.box.hi + double(block.radius)};
    constexpr float inf = std::numeric_limits<float>::infinity();
    float x0 = inf, y0 = inf, x1 = -inf, y1 = -inf, widest = 0.0f;
    for (int i = 0; i < 8; ++i) {
        const shared::Instance at = shared::instance_of(
            layer.lens, glm::vec3(layer.camera_from_layer * grown.corner(i) + layer.origin_in_camera));
        if (!(at.depth > layer.lens.near)) return true;
        x0 = std::min(x0, at.x_px);
        x1 = std::max(x1, at.x_px);
        y0 = std::min(y0, at.y_px);
        y1 = std::max(y1, at.y_px);
        widest = std::max(widest, at.px_per_unit);
    }
    const float radius_px = block.radius * layer.radius_scale * widest * std::max(1.0f, layer.reach);
    const float margin = radius_px * 1.0001f + layer.margin_px + 1.0f +
                         1e-5f * std::max({x1 - x0, y1 - y0, std::fabs(x0), std::fabs(y0)});
    return x1 + margin > rect.x0 && x0 - margin < rect.x1 && y1 + margin > rect.y0 && y0 - margin < rect.y1;
}

/// False only where none of the block's splats can leave a record.
bool may_show(const LayerProjection& layer, const BlockPlace& place, const ScreenRect& rect) {
    if (!(place.far > 0.0)) return false;
    const glm::vec3 center(place.center);
    const auto ball = float(place.ball * (1.0 + rounding));
    const shared::Instance at = shared::instance_of(layer.lens, center);
    if (at.depth + ball < layer.lens.near) return false;
    if (!(at.depth - ball > layer.lens.near)) return true;
    const float wide = std::max(1.0f, layer.reach) * ball;
    const float support_px = shared::reach_px(layer.lens, center, wide, layer.margin_px + 1.0f);
    return shared::appears_in_rect(layer.lens, at.x_px, at.y_px, support_px, rect.x0, rect.y0, rect.x1,
                                   rect.y1);
}

}  // namespace

std::vector<VisibleBlock> visible_blocks(std::span<const LayerProjection> layers, const ScreenRect& rect) {
    std::vector<VisibleBlock> visible;
    for (std::size_t l = 0; l < layers.size(); ++l) {
        const LayerProjection& layer = layers[l];
        if (!layer.blocks) continue;
        for (std::size_t b = 0; b < layer.blocks->size(); ++b) {
            const BlockFacts& block = layer.blocks->blocks()[b];
            if (block.splats == 0) continue;
            const BlockPlace place = place_of(layer, block);
            if (!shared::is_onto_sphere(layer.lens) && !may_show_between_corners(layer, block, rect))
                continue;
            if (may_show(layer, place, rect)) visible.push_back({l, b, depths_of(layer.lens, place)});
        }
    }
    return visible;
}

}  // namespace astrosplat
