// Gauss-Legendre over pieces that end where a profile has a corner. The profiles are the shared float
// functions, so that what is integrated is what is drawn; sums are in double.
#include "look/columns.h"

#include <algorithm>
#include <vector>

#include "core/quadrature.h"
#include "look/shared_look.h"

namespace astrosplat {
namespace {

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
