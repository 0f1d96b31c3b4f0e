// Fritsch-Carlson tangents: averages of the neighbouring slopes, cut back where the cubic would not be
// monotone. Gauss-Legendre over pieces that end where a profile has a corner. The profiles are the shared
// float functions, so that what is integrated is what is drawn; sums are in double.
#include "look/prepare.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/real.h"
#include "look/shared_look.h"

namespace astrosplat {
namespace {

using shared_types::LOOK_MAX_POINTS;

void check_points(std::span<const glm::vec2> points, const std::string& key) {
    if (points.size() > std::size_t(LOOK_MAX_POINTS))
        bad_input(key, fmt::format("at most {} points", LOOK_MAX_POINTS), fmt::format("{}", points.size()));
    for (std::size_t i = 1; i < points.size(); ++i)
        if (!(points[i].x > points[i - 1].x))
            bad_input(key, "points in ascending order of x",
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

constexpr int panels_per_piece = 8;

// Where a profile may have a corner or a jump, in its own x.
std::vector<double> corners(const LookProfile& profile) {
    if (profile.shape == shared_types::PROFILE_S106) return {0.33, 0.66, 1.0};
    if (profile.shape != shared_types::PROFILE_CURVE) return {1.0};
    std::vector<double> xs;
    for (int i = 0; i < profile.curve.count; ++i) xs.push_back(double(profile.curve.knots[i].x));
    return xs;
}

std::vector<double> piece_ends(const ColumnProfile& column) {
    std::vector<double> ends = {0.0, column.end};
    for (double x : corners(column.pdf)) ends.push_back(x);
    for (double x : corners(column.vertical)) ends.push_back(x / column.vertical_ratio);
    std::ranges::sort(ends);
    ends.erase(
        std::remove_if(ends.begin(), ends.end(), [&](double x) { return !(x >= 0.0 && x <= column.end); }),
        ends.end());
    return ends;
}

double integrand(const ColumnProfile& column, double vertical_scale, double x) {
    const double p = double(shared::look_profile(column.pdf, float(x)));
    const double f = double(shared::look_profile(column.vertical, float(x * column.vertical_ratio)));
    const double v = 1.0 + (vertical_scale - 1.0) * x;
    return std::clamp(column.density * p, 0.0, 1.0) * f * v * v;
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

double column_integral(const ColumnProfile& column, double vertical_scale) {
    const std::vector<double> ends = piece_ends(column);
    double sum = 0.0;
    for (std::size_t i = 1; i < ends.size(); ++i) {
        const double step = (ends[i] - ends[i - 1]) / panels_per_piece;
        for (int panel = 0; panel < panels_per_piece; ++panel)
            sum += integrate_panel(ends[i - 1] + step * panel, ends[i - 1] + step * (panel + 1),
                                   [&](double x) { return integrand(column, vertical_scale, x); });
    }
    return sum;
}

double mean_square(double min, double max) { return (min * min + min * max + max * max) / 3.0; }

}  // namespace astrosplat
