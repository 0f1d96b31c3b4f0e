// Least squares over cells, and a clip that forgets what stands above the sky.
#include "prepare/stages.h"

#include "core/color.h"
#include "core/real.h"
#include "core/sorting.h"
#include "detect/background.h"
#include "image/channels.h"
#include "prepare/least_squares.h"

namespace astrosplat {
namespace {

constexpr std::int64_t most_cells_a_side = 48;  // enough for a surface of six numbers
constexpr int most_sky_clips = 20;
constexpr std::size_t fewest_cells = 12;  // twice the numbers of a surface
constexpr std::int64_t least_cell_px = 8;
constexpr double above = 1.5, below = 4.0;  // times the scatter of the cells, that are left out

Vector<6> terms(double u, double v) { return {1.0, u, v, u * u, u * v, v * v}; }

// The level of a cell in a channel, and where it is.
struct SkyCell {
    double u, v, level;
};

// -1 .. 1 over n px.
double across(double px, std::int64_t n) { return 2.0 * px / double(n) - 1.0; }

std::vector<SkyCell> sky_cells(const Image& image, const Cells& cells, int channel) {
    std::vector<SkyCell> found;
    const auto half = 0.5 * double(cells.cell_px);
    for (std::int64_t j = 0; j < cells.level.height; ++j)
        for (std::int64_t i = 0; i < cells.level.width; ++i)
            found.push_back({across(double(i * cells.cell_px) + half, image.width),
                             across(double(j * cells.cell_px) + half, image.height),
                             double(cells.level.at(i, j)[channel])});
    return found;
}

// Terms above the degree are held at 0.
Vector<6> surface_through(const std::vector<SkyCell>& cells, int degree) {
    LeastSquares<6> sums;
    const std::size_t used = degree == 0 ? 1 : degree == 1 ? 3 : 6;
    for (const SkyCell& cell : cells) {
        Vector<6> row = terms(cell.u, cell.v);
        std::fill(row.begin() + used, row.end(), 0.0);
        sums.add(row, cell.level);
    }
    for (std::size_t i = 0; i < 6; ++i) sums.squares[i][i] += i < used ? 1e-9 : 1.0;
    return solved(sums.squares, sums.products).value_or(Vector<6>{});
}

double value_of(const Vector<6>& surface, double u, double v) {
    const Vector<6> t = terms(u, v);
    double sum = 0.0;
    for (std::size_t i = 0; i < 6; ++i) sum += surface[i] * t[i];
    return sum;
}

// The scatter of the sky is that of the cells below the surface: nothing but noise is darker.
double scatter_below(const std::vector<double>& away) {
    std::vector<double> sizes;
    for (const double d : away)
        if (d <= 0.0) sizes.push_back(-d);
    return sigma_of_median_distance * percentile(std::move(sizes), 0.5);
}

Vector<6> fit_channel(std::vector<SkyCell> cells, int degree) {
    Vector<6> surface = surface_through(cells, degree);
    for (int i = 0; i < most_sky_clips; ++i) {
        std::vector<double> away;
        for (const SkyCell& cell : cells) away.push_back(cell.level - value_of(surface, cell.u, cell.v));
        const double scatter = scatter_below(away);
        std::vector<SkyCell> left;
        for (std::size_t k = 0; k < cells.size(); ++k)
            if (away[k] <= above * scatter && away[k] >= -below * scatter) left.push_back(cells[k]);
        if (left.size() == cells.size() || left.size() < fewest_cells) break;
        cells = std::move(left);
        surface = surface_through(cells, degree);
    }
    return surface;
}

// Multiplies all channels of every pixel by factor(x, y).
template <class Factor>
void fade(Image& image, const Factor& factor) {
    for_each_pixel(image, [&](std::int64_t x, std::int64_t y) {
        const float f = factor(x, y);
        for (int c = 0; c < image.channels; ++c) image.at(x, y)[c] *= f;
    });
}

}  // namespace

double SkySurface::at(double u, double v, int channel) const { return value_of(coefficients[channel], u, v); }

SkySurface fit_sky(const Image& image, int degree) {
    assert(image.channels >= 3 && degree >= 0 && degree <= 2);
    const std::int64_t longest = std::max(image.width, image.height);
    const Cells cells = measure_cells(image, std::max(least_cell_px, longest / most_cells_a_side));
    SkySurface sky;
    for (int c = 0; c < 3; ++c) sky.coefficients[c] = fit_channel(sky_cells(image, cells, c), degree);
    return sky;
}

void subtract_sky(Image& image, const SkySurface& sky) {
    for_each_pixel(image, [&](std::int64_t x, std::int64_t y) {
        float* const p = image.at(x, y);
        const double u = across(double(x) + 0.5, image.width), v = across(double(y) + 0.5, image.height);
        const float alpha = image.channels > 3 ? p[3] : 1.0f;
        for (int c = 0; c < 3; ++c) p[c] -= alpha * float(sky.at(u, v, c));
    });
}

double inside(const CutEllipse& ellipse, double x, double y) {
    const double angle = real::radians(ellipse.angle_deg), c = real::cos(angle), s = real::sin(angle);
    const double dx = x - ellipse.center_px.x, dy = y - ellipse.center_px.y;
    const double u = (c * dx + s * dy) / ellipse.radii_px.x, v = (c * dy - s * dx) / ellipse.radii_px.y;
    const double radius = std::sqrt(u * u + v * v);
    if (!(ellipse.feather > 0.0)) return radius <= 1.0 ? 1.0 : 0.0;
    return real::smoothstep(std::clamp((1.0 - radius) / ellipse.feather, 0.0, 1.0));
}

void cut_ellipse(Image& image, const CutEllipse& ellipse) {
    fade(image, [&](std::int64_t x, std::int64_t y) {
        return float(inside(ellipse, double(x) + 0.5, double(y) + 0.5));
    });
}

void cut_with_mask(Image& image, const Image& mask) {
    assert(mask.width == image.width && mask.height == image.height && mask.channels >= 3);
    fade(image, [&](std::int64_t x, std::int64_t y) {
        const float* const p = mask.at(x, y);
        return std::clamp((p[0] + p[1] + p[2]) / 3.0f, 0.0f, 1.0f);
    });
}

void alpha_from_luminance(Image& image, double low, double high) {
    assert(image.channels == 4 && low < high);
    change_pixels(image, [&](float* p) {
        p[3] *= float(std::clamp((double(luminance(p[0], p[1], p[2])) - low) / (high - low), 0.0, 1.0));
        if (p[3] == 0.0f) std::fill_n(p, 3, 0.0f);
    });
}

}  // namespace astrosplat
