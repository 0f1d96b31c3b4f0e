// Fritsch-Carlson tangents: averages of the neighbouring slopes, cut back where the cubic would not be
// monotone.
#include "look/curves.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/error.h"

namespace astrosplat {
namespace {

using shared_types::LOOK_MAX_POINTS;

void check_points(std::span<const glm::vec2> points, const std::string& key) {
    if (points.size() > std::size_t(LOOK_MAX_POINTS))
        bad_input(key, "", fmt::format("at most {} points", LOOK_MAX_POINTS),
                  fmt::format("{}", points.size()));
    for (std::size_t i = 1; i < points.size(); ++i)
        if (!(points[i].x > points[i - 1].x))
            bad_input(key, "", "points in ascending order of x",
                      fmt::format("{} after {}", points[i].x, points[i - 1].x));
}

std::array<double, LOOK_MAX_POINTS> tangents(std::span<const glm::vec2> points) {
    std::array<double, LOOK_MAX_POINTS> slope{}, tangent{};
    const std::size_t last = points.size() - 1;
    for (std::size_t i = 0; i < last; ++i)
        slope[i] = (double(points[i + 1].y) - points[i].y) / (double(points[i + 1].x) - points[i].x);
    tangent[0] = slope[0];
    for (std::size_t i = 1; i < last; ++i)
        tangent[i] = slope[i - 1] * slope[i] > 0.0 ? 0.5 * (slope[i - 1] + slope[i]) : 0.0;
    if (last > 0) tangent[last] = slope[last - 1];
    for (std::size_t i = 0; i < last; ++i) {
        if (slope[i] == 0.0) {
            tangent[i] = tangent[i + 1] = 0.0;
            continue;
        }
        const double a = tangent[i] / slope[i], b = tangent[i + 1] / slope[i];
        const double length_squared = a * a + b * b;
        if (length_squared <= 9.0) continue;
        const double cut = 3.0 / std::sqrt(length_squared);
        tangent[i] = cut * a * slope[i];
        tangent[i + 1] = cut * b * slope[i];
    }
    return tangent;
}

}  // namespace

LookCurve make_curve(std::span<const glm::vec2> points, const std::string& key) {
    check_points(points, key);
    LookCurve curve{};
    curve.count = 1;
    curve.knots[0] = {0.0f, 1.0f, 0.0f, 0.0f};
    if (points.empty()) return curve;
    const auto tangent = tangents(points);
    curve.count = int(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        curve.knots[i] = {points[i].x, points[i].y, float(tangent[i]), 0.0f};
    return curve;
}

}  // namespace astrosplat
