#include "edit/placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "camera/camera.h"
#include "camera/projection.h"
#include "core/real.h"
#include "core/rotation.h"
#include "core/text.h"

namespace astrosplat {
namespace {

/// The same angles up to whole turns, next to those of `near`.
glm::dvec3 nearest_turns(const glm::dvec3& degrees, const glm::dvec3& near) {
    return degrees + 360.0 * glm::round((near - degrees) / 360.0);
}

}  // namespace

LayerPlacement placement_of(const LayerTransform& transform) {
    return {rotation_from_degrees(transform.rotate), transform.scale, transform.translate};
}

glm::dvec3 to_world(const LayerPlacement& placement, const glm::dvec3& in_layer) {
    return placement.rotation * (placement.scale * in_layer) + placement.translate;
}

glm::dvec3 to_layer(const LayerPlacement& placement, const glm::dvec3& in_world) {
    return glm::transpose(placement.rotation) * (in_world - placement.translate) / placement.scale;
}

glm::dvec3 degrees_of(const glm::dmat3& r, const glm::dvec3& near) {
    const auto degrees = [](double y, double x) { return real::degrees(real::atan2(y, x)); };
    // r[column][row]; r = about z * about y * about x.
    const double cosine_y = std::hypot(r[0][0], r[0][1]);
    if (cosine_y < 1e-9) {  // x and z turn about the same line: x stays
        const double x = real::radians(near.x);
        const double turn = real::atan2(-r[1][0], r[1][1]);
        const glm::dvec3 found(near.x, degrees(-r[0][2], cosine_y),
                               real::degrees(turn + (r[0][2] < 0.0 ? x : -x)));
        return nearest_turns(found, near);
    }
    const glm::dvec3 one(degrees(r[1][2], r[2][2]), degrees(-r[0][2], cosine_y), degrees(r[0][1], r[0][0]));
    const glm::dvec3 a = nearest_turns(one, near);
    const glm::dvec3 b = nearest_turns({one.x + 180.0, 180.0 - one.y, one.z + 180.0}, near);
    return glm::length(a - near) <= glm::length(b - near) ? a : b;
}

glm::dmat3 rotation_about(const glm::dvec3& axis, double radians) {
    return matrix_of_quaternion({axis * real::sin(0.5 * radians), real::cos(0.5 * radians)});
}

namespace {

glm::vec2 to_px(const Camera& camera, const glm::dvec3& in_camera) {
    const exact::Instance at = exact::instance_of(make_exact_lens(camera), in_camera);
    return {static_cast<float>(at.x_px), static_cast<float>(at.y_px)};
}

glm::dvec3 in_camera(const Camera& camera, const glm::dvec3& point) {
    return glm::transpose(camera.world_from_camera) * (point - camera.eye);
}

/// Points of camera space up to here are seen.
double front_of(const Camera& camera) {
    const bool all = exact::has_parallel_rays(make_exact_lens(camera)) || is_onto_sphere(camera.projection);
    return all ? 1e300 : -std::max(1e-6, camera.near);
}

/// A line between the two goes round what lies behind a fisheye or across a panorama's seam.
bool is_torn(const Camera& camera, const glm::vec2& from, const glm::vec2& to) {
    return is_onto_sphere(camera.projection) && glm::distance(from, to) > 2.0f * float(camera.focal_px);
}

}  // namespace

Camera camera_on_screen(const Camera& camera, const glm::dvec2& corner, double scale) {
    Camera shown = camera;
    shown.focal_px *= scale;
    shown.center_x_px = corner.x + scale * camera.center_x_px;
    shown.center_y_px = corner.y + scale * camera.center_y_px;
    return shown;
}

double view_depth(const Camera& camera, const glm::dvec3& point) {
    const glm::dvec3 p = in_camera(camera, point);
    return is_onto_sphere(camera.projection) ? glm::length(p) : -p.z;
}

std::optional<glm::vec2> project_point(const Camera& camera, const glm::dvec3& point) {
    const glm::dvec3 p = in_camera(camera, point);
    if (p.z > front_of(camera)) return std::nullopt;
    return to_px(camera, p);
}

std::vector<std::vector<glm::vec2>> project_line(const Camera& camera, const std::vector<glm::dvec3>& line) {
    const double front = front_of(camera);
    std::vector<std::vector<glm::vec2>> parts;
    bool open = false;
    glm::dvec3 before(0.0);
    for (std::size_t i = 0; i < line.size(); ++i) {
        const glm::dvec3 p = in_camera(camera, line[i]);
        const bool seen = p.z <= front;
        if (i > 0 && seen != (before.z <= front)) {
            const glm::dvec3 cut = before + (p - before) * ((front - before.z) / (p.z - before.z));
            if (!open) parts.emplace_back();
            parts.back().push_back(to_px(camera, cut));
            open = seen;
        }
        if (seen) {
            const glm::vec2 px = to_px(camera, p);
            if (!open || is_torn(camera, parts.back().back(), px)) parts.emplace_back();
            open = true;
            parts.back().push_back(px);
        }
        before = p;
    }
    return parts;
}

ViewRay ray_through(const Camera& camera, const glm::dvec2& px) {
    const ExactLens lens = make_exact_lens(camera);
    const glm::dvec3 direction =
        glm::normalize(camera.world_from_camera * exact::ray_through(lens, px.x, px.y));
    const glm::dvec3 begin =
        exact::has_parallel_rays(lens) ? exact::point_at_depth(lens, px.x, px.y, 0.0) : glm::dvec3(0.0);
    return {camera.eye + camera.world_from_camera * begin, direction};
}

double units_per_px(const Camera& camera, const glm::dvec3& point) {
    const bool parallel = exact::has_parallel_rays(make_exact_lens(camera));
    return (parallel ? 1.0 : std::max(1e-9, view_depth(camera, point))) / camera.focal_px;
}

namespace {

double longest_side(const Bounds& box) {
    const glm::dvec3 extent = box_to_frame(box).extent();
    return std::max({extent.x, extent.y, extent.z, 1e-9});
}

/// The next larger of 1, 2 or 5 times a power of ten.
double round_step(double length) {
    const double power = std::pow(10.0, std::floor(std::log10(length)));
    for (const double step : {1.0, 2.0, 5.0})
        if (step * power >= length * (1.0 - 1e-9)) return step * power;
    return 10.0 * power;
}

/// The next smaller one.
double round_step_below(double length) { return 1.0 / round_step(1.0 / length); }

/// The two axes of the plane that a view faces, then the one across.
std::array<int, 3> plane_of(ViewKind view) {
    if (view == ViewKind::front) return {0, 1, 2};
    if (view == ViewKind::side) return {1, 2, 0};
    return {0, 2, 1};
}

}  // namespace

std::vector<MarkLine> box_edges(const Bounds& box, const LayerTransform& transform) {
    std::vector<MarkLine> edges;
    if (box.empty()) return edges;
    const LayerPlacement placement = placement_of(transform);
    for (int corner = 0; corner < 8; ++corner)
        for (const int side : {1, 2, 4})
            if (!(corner & side))
                edges.push_back({to_world(placement, box.corner(corner)),
                                 to_world(placement, box.corner(corner | side))});
    return edges;
}

Grid grid_around(const Bounds& box, ViewKind view) {
    constexpr double lines_a_side = 12.0;
    const Bounds framed = box_to_frame(box);
    Grid grid;
    grid.spacing = round_step(longest_side(box) / lines_a_side);
    const auto [u, v, across] = plane_of(view);
    const auto first = [&](int axis) { return std::floor(framed.lo[axis] / grid.spacing) - 1.0; };
    const auto last = [&](int axis) { return std::ceil(framed.hi[axis] / grid.spacing) + 1.0; };
    const auto add_lines = [&](int along, int step) {
        for (double i = first(step); i <= last(step); ++i) {
            glm::dvec3 from(0.0);
            from[across] = std::clamp(0.0, framed.lo[across], framed.hi[across]);
            from[step] = i * grid.spacing;
            glm::dvec3 to = from;
            from[along] = first(along) * grid.spacing;
            to[along] = last(along) * grid.spacing;
            grid.lines.push_back({from, to});
        }
    };
    add_lines(u, v);
    add_lines(v, u);
    return grid;
}

ScaleBar scale_bar(double units_per_px, double light_years_per_unit, double most_px) {
    const bool known = light_years_per_unit > 0.0;
    const double per_px = units_per_px * (known ? light_years_per_unit : 1.0);
    const double length = round_step_below(per_px * most_px);
    return {length / per_px, known ? light_years_text(length) : length_text(length, 0.0)};
}

std::string length_text(double units, double light_years_per_unit) {
    const std::string in_units = fmt::format("{:.4g} scene unit{}", units, units == 1.0 ? "" : "s");
    if (light_years_per_unit == 0.0) return in_units;
    return in_units + ", " + light_years_text(units * light_years_per_unit);
}

std::array<MarkLine, 3> axis_lines(const Bounds& box) {
    std::array<MarkLine, 3> axes{};
    for (int axis = 0; axis < 3; ++axis)
        axes[static_cast<std::size_t>(axis)].to[axis] = 0.5 * longest_side(box);
    return axes;
}

}  // namespace astrosplat
