#include "render/project.h"

#include <glm/common.hpp>

#include "camera/projection.h"
#include "core/progress.h"
#include "render/shape.h"
#include "render/shared_render.h"
#include "render/sphere_shape.h"
#include "splats/splat_set.h"

namespace astrosplat {

std::uint16_t hybrid_of(const LayerProjection& layer, const glm::vec3& p) {
    if (layer.render.blend != Blend::hybrid) return 0;
    const float h = shared::hybrid_amount(shared::axis_cosine(layer.lens, layer.axis_in_camera, p),
                                          layer.render.hybrid_from_deg, layer.render.hybrid_to_deg);
    return std::uint16_t(h * 65535.0f + 0.5f);
}

namespace {

constexpr double slope_margin = 0.15;  // of the frame: how far outside it footprints of Gaussians differ

/// A splat relative to the camera, still in scene units.
struct CameraSplat {
    glm::vec3 position;  // camera space; in front is -z
    float radius;
    float alpha;
    glm::vec3 color;
};

CameraSplat splat_in_camera(const LayerProjection& layer, std::int64_t i) {
    const ShadedSplats& splats = *layer.splats;
    return {to_camera(layer, splats.position[i]), splats.radius[i] * layer.radius_scale, splats.alpha[i],
            splats.color[i]};
}

void set_color(ScreenSplat& splat, const glm::vec3& color) {
    for (int k = 0; k < 3; ++k) splat.color[k] = color[k];
}

/// Where a splat is and what it looks like there, if `support_px` around it touches `rect` and it shows
/// at all.
bool place_splat(const LayerProjection& layer, const CameraSplat& splat, const shared::Instance& at,
                 std::int64_t index, float support_px, const ScreenRect& rect, ScreenSplat& out) {
    if (!shared::is_in_range(layer.lens, at.depth) || !(splat.alpha > 0.0f)) return false;
    out.x_px = shared::snap_px(at.x_px);
    out.y_px = shared::snap_px(at.y_px);
    if (!shared::appears_in_rect(layer.lens, out.x_px, out.y_px, support_px, rect.x0, rect.y0, rect.x1,
                                 rect.y1))
        return false;
    out.opacity = splat.alpha * layer.opacity * shared::near_fade(layer.lens, at.depth, splat.radius);
    set_color(out, splat.color);
    out.depth = std::bit_cast<std::uint32_t>(shared::sort_depth(layer.lens, splat.position));
    out.index = std::uint32_t(index);
    out.layer = layer.layer;
    out.hybrid = hybrid_of(layer, splat.position);
    return out.opacity > 0.0f;
}

/// Projects one ball, whose image is `size` times as large as the ball.
void project_one(const LayerProjection& layer, const CameraSplat& splat, std::int64_t index,
                 const ScreenRect& rect, Buffer<ScreenSplat>& out, float size = 1.0f) {
    const shared::Instance at = shared::instance_of(layer.lens, splat.position);
    ScreenSplat screen;
    screen.radius_px = splat.radius * at.px_per_unit * size;
    const float support = shared::frame_reach_px(layer.lens, at.x_px, at.y_px,
                                                 screen.radius_px * layer.reach + layer.margin_px);
    if (place_splat(layer, splat, at, index, support, rect, screen))
        push_places(screen, shared::period_px(layer.lens), support, rect, out);
}

/// Projects a star that stays a point close by, with all the light that its ball would have.
void project_star(const LayerProjection& layer, CameraSplat splat, std::int64_t index, const ScreenRect& rect,
                  Buffer<ScreenSplat>& out) {
    const float size = near_star_size(layer, splat.position);
    splat.color /= size * size;
    project_one(layer, splat, index, rect, out, size);
}

/// Where an ellipsoid's outline is on the frame.
Shape outline_of(const LayerProjection& layer, const CameraSplat& splat, const shared::Instance& at,
                 std::int64_t index) {
    const glm::mat3 ellipsoid =
        splat.radius / layer.layer_scale * glm::mat3(layer.camera_from_layer) * layer.splats->stretch[index];
    if (shared::is_onto_sphere(layer.lens)) {
        // Of its own direction, which a stereo pair does not show it in.
        float x_px = shared::snap_px(at.x_px);
        if (layer.lens.parallax != 0.0f)
            x_px -= layer.lens.focal_px * shared::panorama_parallax(layer.lens, at.depth);
        const SphereAxes axes = sphere_axes(layer.lens, double(x_px), double(shared::snap_px(at.y_px)));
        return project_onto_sphere(axes, ellipsoid, at.px_per_unit);
    }
    if (!layer.gaussians || shared::has_parallel_rays(layer.lens))
        return project_ellipsoid(layer.lens, splat.position, ellipsoid, at.px_per_unit);
    const glm::vec2 slope =
        glm::clamp(glm::vec2(splat.position) / at.depth, layer.least_slope, layer.largest_slope);
    return project_affine(slope, ellipsoid, at.px_per_unit);
}

/// Projects one ellipsoid, which fades at the near plane as the ball around its outline; a Gaussian over one
/// standard deviation of it.
void project_stretched(const LayerProjection& layer, CameraSplat splat, std::int64_t index,
                       const ScreenRect& rect, Buffer<ScreenSplat>& out, Buffer<Shape>& shapes) {
    const shared::Instance at = shared::instance_of(layer.lens, splat.position);
    if (!shared::is_in_range(layer.lens, at.depth)) return;
    const Shape shape = outline_of(layer, splat, at, index);
    splat.radius = float(ellipse_of(shape).larger) / at.px_per_unit;
    if (layer.gaussians) splat.radius *= layer.deviation;
    ScreenSplat screen;
    const float support =
        shared::frame_reach_px(layer.lens, at.x_px, at.y_px,
                               shape_support_px(shape, {layer.reach, layer.margin_px, layer.variance}));
    if (!place_splat(layer, splat, at, index, support, rect, screen)) return;
    set_shape_number(screen, std::uint32_t(shapes.size()));
    push_places(screen, shared::period_px(layer.lens), support, rect, out);
    shapes.push_back(shape);
}

void project_level(const LayerProjection& layer, const CameraSplat& parent, std::int64_t index, int level,
                   const shared::LevelShade& shade, const ScreenRect& rect, Buffer<ScreenSplat>& out) {
    if (!(shade.alpha > 0.0f)) return;
    const ShadedSplats& splats = *layer.splats;
    shared::ChildTables tables(layer.lod->numbers());
    const std::uint64_t id = splats.id[index];
    const float radius = splats.radius[index];
    const float structure = structure_of(layer, parent.position, parent.color, parent.alpha);
    const ChildNoise noise = make_child_noise(structure, radius, level, layer.seed);
    CameraSplat child{parent.position, parent.radius * shared::child_radius_scale(level), shade.alpha,
                      shade.color};
    const std::int64_t children = children_of_level(level);
    constexpr std::int64_t uninterrupted = 4096;
    for (std::int64_t k = 0; k < children; ++k) {
        if (k % uninterrupted == 0) Progress{{}, layer.cancelled}.check();
        glm::vec3 p = splats.position[index];
        if (level > 0) {
            p += radius * tables.child_offset(level, std::uint32_t(k), layer.seed, std::uint32_t(id),
                                              std::uint32_t(id >> 32));
            child.position = to_camera(layer, p);
        }
        const std::size_t first = out.size();
        project_one(layer, child, index, rect, out);
        if (noise.count == 0 || out.size() == first) continue;
        // Only for those that show: noise costs more than all the rest.
        const glm::vec3 lit = shade.color * child_light(noise, p);
        for (std::size_t i = first; i < out.size(); ++i) set_color(out[i], lit);
    }
}

/// True when the splat was replaced by children (of which none may show). A splat whose centre has passed the
/// camera may still have children in front of it, so the size is taken no nearer than the near plane.
bool project_as_children(const LayerProjection& layer, const CameraSplat& splat, std::int64_t index,
                         const ScreenRect& rect, Buffer<ScreenSplat>& out) {
    const glm::vec3& p = splat.position;
    const float near = layer.lens.near, reach = splat.radius * child_reach;
    const float px_per_unit = shared::instance_of(layer.lens, shared::beyond_near(layer.lens, p)).px_per_unit;
    const LevelChoice choice =
        choose_levels(2.0f * splat.radius * px_per_unit, layer.lod_limit_px, layer.render.lod.max_children);
    if (choice.fine == 0) return false;
    if (layer.render.lod.noise > 0.0f && is_star(layer.splats->id[index])) return false;
    const shared::Instance at = shared::instance_of(layer.lens, p);
    if (at.depth + reach < near) return true;
    if (at.depth - reach > near) {
        const float support_px = shared::reach_px(layer.lens, p, reach, layer.margin_px);
        if (!shared::appears_in_rect(layer.lens, at.x_px, at.y_px, support_px, rect.x0, rect.y0, rect.x1,
                                     rect.y1))
            return true;
    }
    if (layer.render.falloff.shape == Falloff::Shape::constant && splat.alpha > 0.5f) return false;
    const Blend blend = layer.render.holdout ? Blend::over : layer.render.blend;
    shared::ChildTables tables(layer.lod->numbers());
    const shared::LevelShades shades = tables.shade_levels(int(blend), float(hybrid_of(layer, p)) / 65535.0f,
                                                           choice, splat.alpha, splat.color);
    project_level(layer, splat, index, choice.coarse, shades.coarse, rect, out);
    project_level(layer, splat, index, choice.fine, shades.fine, rect, out);
    return true;
}

}  // namespace

float structure_of(const LayerProjection& layer, const glm::vec3& position, const glm::vec3& color,
                   float alpha) {
    const LayerRender& render = layer.render;
    return shared::child_structure(render.lod.noise, int(render.blend),
                                   float(hybrid_of(layer, position)) / 65535.0f, alpha, color);
}

LayerProjection make_projection(const RenderLayer& layer, std::uint16_t number, const Camera& camera,
                                const RenderSettings& settings) {
    LayerProjection p;
    const glm::dmat3 camera_from_world = glm::transpose(camera.world_from_camera);
    p.splats = layer.splats;
    p.blocks = layer.blocks;
    p.camera_from_layer = camera_from_world * layer.world_from_layer * layer.scale;
    p.origin_in_camera = camera_from_world * (layer.translate - camera.eye);
    const glm::dvec3 axis = camera_from_world * layer.world_from_layer * layer.axis;
    p.axis_in_camera = glm::vec3(axis / std::sqrt(glm::dot(axis, axis)));
    p.layer_scale = float(layer.scale);
    p.radius_scale = float(layer.scale * layer.radius_scale);
    p.gaussians = layer.gaussians;
    p.deviation = float(1.0 / (3.0 * layer.radius_scale));
    p.opacity = layer.render.opacity;
    p.lens = make_lens(camera);
    const glm::dvec2 size(settings.width, settings.height), center(camera.center_x_px, camera.center_y_px);
    const glm::dvec2 least = (-slope_margin * size - center) / camera.focal_px,
                     largest = ((1.0 + slope_margin) * size - center) / camera.focal_px;
    p.least_slope = glm::vec2(least.x, -largest.y);
    p.largest_slope = glm::vec2(largest.x, -least.y);
    p.margin_px = 4.0f * settings.pixel_filter;
    p.render = layer.render;
    // Lighten keeps the brightest splat of a pixel: no number of children has the parent's light, so it is
    // not split.
    if (layer.render.blend != Blend::lighten)
        p.lod_limit_px = layer.render.lod.max_px * float(settings.height) / 1080.0f;
    if (stars_stay_points(layer.render) && camera.projection != Projection::orthographic)
        p.star_distance = layer.render.lod.star_distance;
    p.seed = layer.seed;
    p.layer = number;
    p.star_pixels = layer.star_pixels;
    return p;
}

float near_star_size(const LayerProjection& layer, const glm::vec3& p) {
    if (!(layer.star_distance > 0.0f)) return 1.0f;
    const float depth = std::max(shared::instance_of(layer.lens, p).depth, layer.lens.near);
    return near_star_size(std::min(1.0f, depth / layer.star_distance));
}

float support_px(const LayerProjection& layer, const ScreenSplat& splat, const Buffer<Shape>& shapes) {
    const bool round = shapes.empty() || is_round(splat);
    const float reach_px =
        round ? splat.radius_px * layer.reach + layer.margin_px
              : shape_support_px(shapes[shape_number(splat)], {layer.reach, layer.margin_px, layer.variance});
    return shared::frame_reach_px(layer.lens, splat.x_px, splat.y_px, reach_px);
}

void project_most(const LayerProjection& layer, std::int64_t begin, std::int64_t end, const ScreenRect& rect,
                  Buffer<ScreenSplat>& out, Buffer<Shape>& shapes, Buffer<std::int64_t>& rest) {
    if (!layer.star_splats.empty()) return project_stars(layer, begin, end, rect, out, shapes);
    if (!layer.splats->stretch.empty()) {
        for (std::int64_t i = begin; i < end; ++i)
            project_stretched(layer, splat_in_camera(layer, i), i, rect, out, shapes);
        return;
    }
    begin = project_whole_blocks(layer, begin, end, rect, out, rest);
    for (; begin < end; ++begin) rest.push_back(begin);
}

void project_rows(const LayerProjection& layer, std::span<const std::int64_t> rows, const ScreenRect& rect,
                  Buffer<ScreenSplat>& out) {
    for (const std::int64_t i : rows) {
        const CameraSplat splat = splat_in_camera(layer, i);
        if (layer.star_distance > 0.0f && is_star(layer.splats->id[i]))
            project_star(layer, splat, i, rect, out);
        else if (!layer.lod || !project_as_children(layer, splat, i, rect, out))
            project_one(layer, splat, i, rect, out);
    }
}

void project(const LayerProjection& layer, std::int64_t begin, std::int64_t end, const ScreenRect& rect,
             Buffer<ScreenSplat>& out, Buffer<Shape>& shapes) {
    Buffer<std::int64_t> rest;
    project_most(layer, begin, end, rect, out, shapes, rest);
    project_rows(layer, rest, rect, out);
}

}  // namespace astrosplat
