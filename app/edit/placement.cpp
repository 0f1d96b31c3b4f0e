#include "edit/placement.h"

#include <fmt/format.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "camera/framing.h"
#include "camera/projection.h"
#include "core/real.h"
#include "core/rotation.h"
#include "core/text.h"
#include "edit/edits.h"

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

namespace {

constexpr double shortest_axis = 0.15;  // of its length, as it is seen
constexpr double flattest_ring = 0.2;   // cosine between its axis and the line of sight

/// Of a point from a line of several, px.
double distance_from(const std::vector<glm::vec2>& line, const glm::dvec2& point) {
    double nearest = 1e300;
    for (std::size_t i = 1; i < line.size(); ++i) {
        const glm::dvec2 a(line[i - 1]), along = glm::dvec2(line[i]) - a;
        const double length2 = std::max(1e-12, glm::dot(along, along));
        const double t = std::clamp(glm::dot(point - a, along) / length2, 0.0, 1.0);
        nearest = std::min(nearest, glm::length(a + along * t - point));
    }
    return nearest;
}

glm::dvec2 middle_px(const Camera& camera, const Handled& handled) {
    const auto at = project_point(camera, handled.origin);
    return at ? glm::dvec2(*at) : glm::dvec2(-1e9);
}

glm::dvec3 axis_of(const Handled& handled, Grip grip) { return handled.axes[static_cast<int>(grip)]; }

/// Where on the line through the origin along `axis` the mouse is nearest, scene units from the origin.
double along_axis(const Camera& camera, const Handled& handled, const glm::dvec3& axis,
                  const glm::dvec2& px) {
    const ViewRay ray = ray_through(camera, px);
    const glm::dvec3 between = handled.origin - ray.origin;
    const double cosine = glm::dot(axis, ray.direction);
    const double across = std::max(1e-6, 1.0 - cosine * cosine);
    return (cosine * glm::dot(ray.direction, between) - glm::dot(axis, between)) / across;
}

/// The point of the plane through the origin across `normal` under the mouse.
glm::dvec3 in_plane(const Camera& camera, const Handled& handled, const glm::dvec3& normal,
                    const glm::dvec2& px) {
    const ViewRay ray = ray_through(camera, px);
    const double slope = glm::dot(ray.direction, normal);
    return ray.origin + ray.direction * (glm::dot(handled.origin - ray.origin, normal) / slope);
}

/// About a line towards the eye, as the mouse goes around the middle.
double angle_on_screen(const glm::dvec2& from, const glm::dvec2& to) {
    return -real::atan2(from.x * to.y - from.y * to.x, glm::dot(from, to));
}

/// About an axis seen from the side: along the ring's nearer half, a radius for a radian.
double angle_from_side(const Camera& camera, const Handled& handled, const glm::dvec3& axis,
                       const HandleDrag& drag) {
    const ViewRay ray = ray_through(camera, drag.from_px);
    const glm::dvec3 along = glm::normalize(glm::cross(axis, -ray.direction));
    const double units = units_per_px(camera, handled.origin);
    const auto next = project_point(camera, handled.origin + along * units);
    if (!next) return 0.0;
    return glm::dot(glm::dvec2(*next) - middle_px(camera, handled), drag.to_px - drag.from_px) /
           HandleSizes().length;
}

double angle_about(const Camera& camera, const Handled& handled, const glm::dvec3& axis,
                   const HandleDrag& drag) {
    const double facing = glm::dot(axis, ray_through(camera, drag.from_px).direction);
    if (std::fabs(facing) < flattest_ring) return angle_from_side(camera, handled, axis, drag);
    const glm::dvec3 from = in_plane(camera, handled, axis, drag.from_px) - handled.origin,
                     to = in_plane(camera, handled, axis, drag.to_px) - handled.origin;
    return real::atan2(glm::dot(axis, glm::cross(from, to)), glm::dot(from, to));
}

/// Once around in the plane of a and b, from a to a.
std::vector<glm::dvec3> circle(const glm::dvec3& a, const glm::dvec3& b) {
    constexpr int pieces = 64;
    std::vector<glm::dvec3> points;
    for (int i = 0; i <= pieces; ++i) {
        const double turn = 2.0 * real::pi * i / pieces;
        points.push_back(a * real::cos(turn) + b * real::sin(turn));
    }
    return points;
}

}  // namespace

std::vector<glm::dvec3> handle_line(const Camera& camera, const Handled& handled, HandleTool tool, int axis,
                                    const HandleSizes& sizes) {
    const double length = sizes.length * units_per_px(camera, handled.origin);
    if (tool != HandleTool::rotate) return {handled.origin, handled.origin + handled.axes[axis] * length};
    std::vector<glm::dvec3> ring = circle(handled.axes[(axis + 1) % 3], handled.axes[(axis + 2) % 3]);
    for (glm::dvec3& point : ring) point = handled.origin + point * length;
    return ring;
}

Grip grip_at(const Camera& camera, const Handled& handled, HandleTool tool, const glm::dvec2& mouse_px,
             const HandleSizes& sizes) {
    if (tool == HandleTool::none || !project_point(camera, handled.origin)) return Grip::none;
    const double from_middle = glm::length(mouse_px - middle_px(camera, handled));
    if (from_middle <= sizes.reach) return Grip::middle;
    const bool has_axes = tool != HandleTool::scale || !handled.uniform;
    if (!has_axes) return std::fabs(from_middle - sizes.length) <= sizes.reach ? Grip::middle : Grip::none;
    Grip found = Grip::none;
    double nearest = sizes.reach;
    for (int axis = 0; axis < 3; ++axis) {
        for (const auto& part : project_line(camera, handle_line(camera, handled, tool, axis, sizes))) {
            const bool is_point = tool != HandleTool::rotate &&
                                  glm::length(part.back() - part.front()) < shortest_axis * sizes.length;
            const double distance = distance_from(part, mouse_px);
            if (is_point || distance > nearest) continue;
            nearest = distance;
            found = static_cast<Grip>(axis);
        }
    }
    return found;
}

glm::dvec3 moved_by(const Camera& camera, const Handled& handled, const HandleDrag& drag) {
    if (drag.grip == Grip::none) return glm::dvec3(0.0);
    if (drag.grip == Grip::middle) {
        const glm::dvec3 normal = camera.world_from_camera[2];
        return in_plane(camera, handled, normal, drag.to_px) -
               in_plane(camera, handled, normal, drag.from_px);
    }
    const glm::dvec3 axis = axis_of(handled, drag.grip);
    return axis *
           (along_axis(camera, handled, axis, drag.to_px) - along_axis(camera, handled, axis, drag.from_px));
}

glm::dmat3 turned_by(const Camera& camera, const Handled& handled, const HandleDrag& drag) {
    if (drag.grip == Grip::none) return glm::dmat3(1.0);
    if (drag.grip == Grip::middle) {
        const glm::dvec2 middle = middle_px(camera, handled);
        return rotation_about(camera.world_from_camera[2],
                              angle_on_screen(drag.from_px - middle, drag.to_px - middle));
    }
    const glm::dvec3 axis = axis_of(handled, drag.grip);
    return rotation_about(axis, angle_about(camera, handled, axis, drag));
}

glm::dvec3 scaled_by(const Camera& camera, const Handled& handled, const HandleDrag& drag) {
    constexpr double least = 0.01, px_for_factor_two = 100.0;
    glm::dvec3 factors(1.0);
    if (drag.grip == Grip::none) return factors;
    if (drag.grip == Grip::middle) {
        const glm::dvec2 middle = middle_px(camera, handled);
        const double from = glm::length(drag.from_px - middle), to = glm::length(drag.to_px - middle);
        const double by =
            from > px_for_factor_two / 5.0
                ? to / from
                : real::exp(real::log(2.0) * (drag.to_px.x - drag.from_px.x) / px_for_factor_two);
        return glm::dvec3(std::max(least, by));
    }
    const glm::dvec3 axis = axis_of(handled, drag.grip);
    const double from = along_axis(camera, handled, axis, drag.from_px);
    const double to = along_axis(camera, handled, axis, drag.to_px);
    factors[static_cast<int>(drag.grip)] = std::max(least, from != 0.0 ? to / from : 1.0);
    return factors;
}

namespace {

constexpr double angle_step = 0.1;   // degrees
constexpr double share_step = 1e-3;  // of a size

const Crop* chosen_crop(const Scene& now, const ViewState& view) {
    if (view.handle_target != HandleTarget::crop || view.layer >= now.layers.size()) return nullptr;
    const std::vector<Crop>& crops = now.layers[view.layer].look.crop;
    return view.handle_crop < crops.size() ? &crops[view.handle_crop] : nullptr;
}

glm::dmat3 axes_of(const Crop& crop) {
    const bool turns = crop.shape != Crop::Shape::sphere;
    return turns ? rotation_from_degrees(glm::dvec3(crop.rotate)) : glm::dmat3(1.0);
}

/// Where `now` differs from `before`, rounded; the rest stays as it was.
Value rounded_list(const glm::dvec3& before, const glm::dvec3& now, double step) {
    Value::List list;
    for (int i = 0; i < 3; ++i) {
        const bool stays = std::fabs(now[i] - before[i]) < 1e-3 * step;
        list.emplace_back(stays ? before[i] : rounded_to_step(now[i], step));
    }
    return list;
}

Value rounded_product(double size, double factor) {
    return rounded_to_step(size * factor, std::max(1e-9, size * factor * share_step));
}

NewValue dragged_layer(const LayerParams& layer, HandleTool tool, const Camera& camera,
                       const Handled& handled, const HandleDrag& drag) {
    const std::string at = layer_key(layer.name) / "transform";
    const LayerTransform& t = layer.transform;
    if (tool == HandleTool::rotate)
        return {at + ".rotate",
                rounded_list(
                    t.rotate,
                    degrees_of(turned_by(camera, handled, drag) * rotation_from_degrees(t.rotate), t.rotate),
                    angle_step)};
    if (tool == HandleTool::scale)
        return {at + ".scale", rounded_product(t.scale, scaled_by(camera, handled, drag).x)};
    return {at + ".translate", rounded_list(t.translate, t.translate + moved_by(camera, handled, drag),
                                            units_per_px(camera, handled.origin))};
}

NewValue dragged_crop(const LayerParams& layer, std::size_t index, HandleTool tool, const Camera& camera,
                      const Handled& handled, const HandleDrag& drag) {
    const std::string at = layer_key(layer.name) / "look.crop" / index;
    const Crop& crop = layer.look.crop[index];
    const LayerPlacement placement = placement_of(layer.transform);
    const double step = units_per_px(camera, handled.origin) / placement.scale;
    if (tool == HandleTool::rotate) {
        const glm::dmat3 in_world = turned_by(camera, handled, drag) * placement.rotation * axes_of(crop);
        const glm::dvec3 before(crop.rotate);
        return {at + ".rotate",
                rounded_list(before, degrees_of(glm::transpose(placement.rotation) * in_world, before),
                             angle_step)};
    }
    if (tool == HandleTool::scale) {
        const glm::dvec3 factors = scaled_by(camera, handled, drag), before(crop.size);
        if (crop.shape == Crop::Shape::sphere)
            return {at + ".radius", rounded_product(double(crop.radius), factors.x)};
        return {at + ".size", rounded_list(before, before * factors, step)};
    }
    const glm::dvec3 before(crop.center);
    const glm::dvec3 after =
        to_layer(placement, to_world(placement, before) + moved_by(camera, handled, drag));
    return {at + ".center", rounded_list(before, after, step)};
}

}  // namespace

std::optional<Handled> handled_in(const Scene& now, const ViewState& view) {
    if (view.tool == HandleTool::none) return std::nullopt;
    Handled handled;
    if (view.handle_target == HandleTarget::camera_target) {
        if (view.tool != HandleTool::move || now.camera.rotation || !now.camera.position) return std::nullopt;
        handled.origin = now.camera.target;
        return handled;
    }
    if (view.layer >= now.layers.size()) return std::nullopt;
    const LayerParams& layer = now.layers[view.layer];
    if (view.handle_target == HandleTarget::layer) {
        handled.origin = layer.transform.translate;
        handled.uniform = true;
        return handled;
    }
    const Crop* crop = chosen_crop(now, view);
    const bool is_sphere = crop && crop->shape == Crop::Shape::sphere;
    if (!crop || (is_sphere && view.tool == HandleTool::rotate)) return std::nullopt;
    if (crop->shape == Crop::Shape::outline && view.tool == HandleTool::scale) return std::nullopt;
    const LayerPlacement placement = placement_of(layer.transform);
    handled.origin = to_world(placement, glm::dvec3(crop->center));
    handled.axes = placement.rotation * axes_of(*crop);
    handled.uniform = is_sphere;
    return handled;
}

NewValue dragged_value(const Scene& pressed, const ViewState& view, const Camera& camera,
                       const HandleDrag& drag) {
    const Handled handled = *handled_in(pressed, view);
    if (view.handle_target == HandleTarget::camera_target) {
        const glm::dvec3& before = pressed.camera.target;
        return {"camera.target", rounded_list(before, before + moved_by(camera, handled, drag),
                                              units_per_px(camera, handled.origin))};
    }
    const LayerParams& layer = pressed.layers[view.layer];
    if (view.handle_target == HandleTarget::layer)
        return dragged_layer(layer, view.tool, camera, handled, drag);
    return dragged_crop(layer, view.handle_crop, view.tool, camera, handled, drag);
}

std::vector<std::vector<glm::dvec3>> crop_outline(const LayerParams& layer, std::size_t index) {
    const Crop& crop = layer.look.crop[index];
    const LayerPlacement placement = placement_of(layer.transform);
    const glm::dmat3 axes = axes_of(crop);
    const auto at = [&](const glm::dvec3& from_center) {
        return to_world(placement, glm::dvec3(crop.center) + axes * from_center);
    };
    std::vector<std::vector<glm::dvec3>> lines;
    if (crop.shape == Crop::Shape::box) {
        const Bounds box{-0.5 * glm::dvec3(crop.size), 0.5 * glm::dvec3(crop.size)};
        for (const MarkLine& edge : box_edges(box, {})) lines.push_back({at(edge.from), at(edge.to)});
        return lines;
    }
    if (crop.shape == Crop::Shape::outline) {  // as it is beside the middle of the layer
        const double depth = std::max(1e-3, glm::dot(axes[2], glm::dvec3(crop.center)));
        const double scale = crop.parallel ? 1.0 : depth;
        for (const std::vector<glm::vec2>& line : outline_lines(crop.outline)) {
            lines.emplace_back();
            for (const glm::vec2& p : line) lines.back().push_back(at({scale * glm::dvec2(p), -depth}));
            if (crop.width == 0.0f) lines.back().push_back(lines.back().front());
        }
        return lines;
    }
    const glm::dmat3 radii(double(crop.radius));  // along x, y and z
    for (int axis = 0; axis < 3; ++axis) {
        lines.push_back(circle(radii[(axis + 1) % 3], radii[(axis + 2) % 3]));
        for (glm::dvec3& point : lines.back()) point = at(point);
    }
    return lines;
}

}  // namespace astrosplat
