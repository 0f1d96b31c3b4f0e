#include "edit/selection.h"

#include <glm/geometric.hpp>

#include "core/rotation.h"
#include "edit/edits.h"
#include "edit/layers.h"
#include "generate/lattice.h"
#include "stars/star_set.h"

namespace astrosplat {
namespace {

// Of a line's directions from an outline's own: tangents beyond it are large and coarse.
constexpr double least_cosine = 0.35;  // 70 degrees

double area_of(std::span<const glm::dvec2> polygon) {
    double twice = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return 0.5 * std::fabs(twice);
}

// A straight line of a frame that shows directions is none of an outline.
std::vector<glm::dvec2> with_short_edges(std::span<const glm::dvec2> line, bool closes) {
    constexpr double longest = 12.0;  // px; off by the square of that over 8 radii of curvature
    std::vector<glm::dvec2> points;
    for (std::size_t i = 0; i + (closes ? 0 : 1) < line.size(); ++i) {
        const glm::dvec2 &a = line[i], &b = line[(i + 1) % line.size()];
        const int pieces = std::max(1, int(std::ceil(glm::distance(a, b) / longest)));
        for (int k = 0; k < pieces; ++k) points.push_back(glm::mix(a, b, double(k) / pieces));
    }
    if (!closes) points.push_back(line.back());
    return points;
}

// Right, up and back of a view along `forward` that stands as upright as the camera does.
glm::dmat3 axes_along(const Camera& camera, const glm::dvec3& forward) {
    const glm::dmat3& axes = camera.world_from_camera;
    const bool along_up = std::fabs(glm::dot(forward, axes[1])) > 0.99;
    const glm::dvec3 right = glm::normalize(glm::cross(forward, along_up ? axes[2] : axes[1]));
    return {right, glm::cross(right, forward), -forward};
}

// The camera's own axes where the frame is flat as an outline is: strokes of one view have one view. Else
// those of the middle of the line, where an outline stretches a brush the least.
std::optional<glm::dmat3> axes_for(const Camera& camera, std::span<const ViewRay> rays) {
    const auto fits = [&](const glm::dmat3& axes) {
        return std::ranges::all_of(
            rays, [&](const ViewRay& ray) { return glm::dot(ray.direction, -axes[2]) >= least_cosine; });
    };
    if (!is_onto_sphere(camera.projection) && fits(camera.world_from_camera)) return camera.world_from_camera;
    glm::dvec3 sum(0.0);
    for (const ViewRay& ray : rays) sum += ray.direction;
    if (!(glm::length(sum) > 1e-6)) return std::nullopt;
    const glm::dmat3 axes = axes_along(camera, glm::normalize(sum));
    if (!fits(axes)) return std::nullopt;
    return axes;
}

bool is_of_same_view(const Crop& a, const Crop& b) {
    return a.shape == Crop::Shape::outline && b.shape == a.shape && a.keep == b.keep &&
           a.center == b.center && a.rotate == b.rotate && a.width == b.width && a.parallel == b.parallel &&
           a.soft == b.soft;
}

void add_crop(std::vector<Crop>& crops, const Crop& crop) {
    constexpr std::size_t most_text = 40'000;  // of 4096 points, which one outline may have
    const bool joins = crop.width > 0.0f && !crops.empty() && is_of_same_view(crops.back(), crop) &&
                       crops.back().outline.size() + crop.outline.size() < most_text;
    if (joins)
        crops.back().outline += " " + crop.outline;
    else
        crops.push_back(crop);
}

// The layer above, where it is the part that earlier strokes of the view made of this one.
bool is_part_of(const LayerParams& part, const LayerParams& layer, const Crop& erased) {
    const std::vector<Crop>&of_part = part.look.crop, &of_layer = layer.look.crop;
    if (of_part.empty() || of_layer.empty() || erased.width == 0.0f) return false;
    return is_of_same_view(of_layer.back(), erased) && of_part.back().keep == Crop::Keep::inside &&
           of_part.back().outline == of_layer.back().outline && part.source.seed == layer.source.seed;
}

}  // namespace

std::vector<glm::dvec2> simplified(std::span<const glm::dvec2> line, double tolerance) {
    std::vector<glm::dvec3> path;
    for (const glm::dvec2& p : line) path.emplace_back(p, 0.0);
    std::vector<glm::dvec2> kept;
    for (const glm::dvec3& p : simplified_path(path, tolerance)) kept.emplace_back(p);
    if (kept.size() == 1) kept.push_back(kept[0]);
    return kept;
}

std::optional<Crop> crop_behind(const Camera& camera, const LayerPlacement& placement,
                                const DrawnLine& line) {
    constexpr double tolerance = 0.5;  // px
    const bool is_stroke = line.radius > 0.0;
    std::vector<glm::dvec2> points = simplified(line.points, tolerance);
    if (!is_stroke && (points.size() < 3 || area_of(points) < 1.0)) return std::nullopt;
    if (is_onto_sphere(camera.projection)) points = with_short_edges(points, !is_stroke);
    std::vector<ViewRay> rays;
    for (const glm::dvec2& point : points) rays.push_back(ray_through(camera, point));
    rays.push_back(ray_through(camera, points[0] + glm::dvec2(line.radius, 0.0)));  // the brush's rim
    const std::optional<glm::dmat3> axes = axes_for(camera, rays);
    if (!axes) return std::nullopt;

    Crop crop;
    crop.shape = Crop::Shape::outline;
    crop.parallel = exact::has_parallel_rays(make_exact_lens(camera));
    crop.center = glm::vec3(to_layer(placement, camera.eye));
    crop.rotate = glm::vec3(degrees_of(glm::transpose(placement.rotation) * *axes, glm::dvec3(0.0)));
    std::vector<std::vector<glm::vec2>> lines(1);
    const auto place_of = [&](const ViewRay& ray) {
        const glm::dvec3 from_eye = (ray.origin - camera.eye) / placement.scale;
        const glm::dvec3 seen = glm::transpose(*axes) * (crop.parallel ? from_eye : ray.direction);
        return glm::dvec2(seen) / (crop.parallel ? 1.0 : -seen.z);
    };
    for (std::size_t i = 0; i < points.size(); ++i) lines[0].emplace_back(place_of(rays[i]));
    crop.outline = outline_text(lines);
    const double unit = units_per_px(camera, to_world(placement, glm::dvec3(0.0)));
    crop.soft = float(rounded_to_step(line.feather * unit / placement.scale, 0.1 * unit / placement.scale));
    if (is_stroke) crop.width = float(2.0 * glm::distance(place_of(rays[0]), place_of(rays.back())));
    return crop;
}

std::size_t select_part(Scene& scene, std::size_t layer, const Crop& kept, SelectionFate fate) {
    if (fate == SelectionFate::keep) {
        add_crop(scene.layers.at(layer).look.crop, kept);
        return layer;
    }
    Crop erased = kept;
    erased.keep = Crop::Keep::outside;
    std::size_t part = layer;
    if (fate == SelectionFate::part) {
        LayerParams& whole = scene.layers.at(layer);
        // Both have the same splats, whatever the part is called.
        whole.source.seed = resolved_seed(whole.source.seed, whole.name);
        part = layer + 1;
        if (part >= scene.layers.size() || !is_part_of(scene.layers[part], whole, erased))
            part = duplicate_layer(scene, layer);
        add_crop(scene.layers[part].look.crop, kept);
    }
    add_crop(scene.layers[layer].look.crop, erased);
    return part;
}

void forget_outlines(Scene& scene, std::size_t layer) {
    std::erase_if(scene.layers.at(layer).look.crop,
                  [](const Crop& crop) { return crop.shape == Crop::Shape::outline; });
}

}  // namespace astrosplat
