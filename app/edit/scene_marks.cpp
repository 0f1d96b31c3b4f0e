#include "edit/scene_marks.h"

#include <algorithm>
#include <cmath>

#include "camera/camera.h"
#include "edit/placement.h"

namespace astrosplat {
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

std::array<MarkLine, 3> axis_lines(const Bounds& box) {
    std::array<MarkLine, 3> axes{};
    for (int axis = 0; axis < 3; ++axis)
        axes[static_cast<std::size_t>(axis)].to[axis] = 0.5 * longest_side(box);
    return axes;
}

}  // namespace astrosplat
