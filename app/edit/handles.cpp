#include "edit/handles.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/real.h"
#include "edit/placement.h"
#include "edit/project_line.h"

namespace astrosplat {
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

}  // namespace

std::vector<glm::dvec3> handle_line(const Camera& camera, const Handled& handled, HandleTool tool, int axis,
                                    const HandleSizes& sizes) {
    const double length = sizes.length * units_per_px(camera, handled.origin);
    if (tool != HandleTool::rotate) return {handled.origin, handled.origin + handled.axes[axis] * length};
    constexpr int pieces = 64;
    std::vector<glm::dvec3> ring;
    const glm::dvec3 a = handled.axes[(axis + 1) % 3], b = handled.axes[(axis + 2) % 3];
    for (int i = 0; i <= pieces; ++i) {
        const double turn = 2.0 * real::pi * i / pieces;
        ring.push_back(handled.origin + (a * real::cos(turn) + b * real::sin(turn)) * length);
    }
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

}  // namespace astrosplat
