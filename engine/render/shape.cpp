#include "render/shape.h"

#include <glm/geometric.hpp>

#include "core/real.h"
#include "render/shared_render.h"

namespace astrosplat {

/// Beyond this radius a table has no spectrum: footprint.cpp's ripple_limit_px and a node more.
static constexpr double spectrum_end_px = 33.0;

Spectrum::Spectrum(const FootprintTable& table, double radius_px, const PixelStretch& stretch)
    : table_(table),
      radius_(radius_px),
      stretch_(stretch),
      filter_(2.0 * real::pi * real::pi * double(table.pixel_filter_px) * table.pixel_filter_px) {}

double Spectrum::ripple(bool of_edge, float x_px, float y_px) const {
    const double cx = pixel_cosine(x_px), cy = pixel_cosine(y_px);
    const double sx = pixel_cosine(x_px - 0.25f), sy = pixel_cosine(y_px - 0.25f);
    const auto at = [&](double kx, double ky) { return value(of_edge, kx, ky); };
    return 2.0 *
           (at(1, 0) * cx + at(0, 1) * cy + at(1, 1) * (cx * cy - sx * sy) + at(1, -1) * (cx * cy + sx * sy) +
            at(2, 0) * (2.0 * cx * cx - 1.0) + at(0, 2) * (2.0 * cy * cy - 1.0));
}

/// At (kx, ky) cycles per px. That of the edge is not the same shape at all radii: only the filter's part is.
double Spectrum::value(bool of_edge, double kx, double ky) const {
    const double squared = kx * kx * stretch_.xx + 2.0 * kx * ky * stretch_.xy + ky * ky * stretch_.yy;
    const double exponent = filter_ * (1.0 - squared);
    if (exponent < -16.0) return 0.0;  // 1e-7
    const double radius = of_edge ? radius_ : radius_ * std::sqrt(squared);
    if (radius > spectrum_end_px) return 0.0;
    const FootprintNodes nodes = footprint_nodes(table_, float(radius));
    const auto spectrum = [&](const FootprintNode* node) {
        return double(of_edge ? node->moments.edge_ripple[0] : node->moments.ripple[0]);
    };
    const double a = spectrum(nodes.a), b = spectrum(nodes.b);
    return (a + (b - a) * double(nodes.t)) * real::exp(exponent);
}

namespace {

/// A profile of the smaller radius stretched along the larger one.
Spectrum spectrum_of(const FootprintTable& table, const Ellipse& e, double stretch) {
    const double gain = stretch * stretch - 1.0;
    return {table, std::max(e.smaller, double(shared::SMALLEST_RADIUS_PX)),
            PixelStretch{1.0 + gain * e.x * e.x, gain * e.x * e.y, 1.0 + gain * e.y * e.y}};
}

}  // namespace

Ellipse ellipse_of(const Shape& s) {
    const double xx = double(s.xx) * s.xx + double(s.xy) * s.xy,
                 yy = double(s.yx) * s.yx + double(s.yy) * s.yy;
    const double xy = double(s.xx) * s.yx + double(s.xy) * s.yy;
    const double half = 0.5 * (xx - yy), size = std::sqrt(half * half + xy * xy);
    const double larger = std::sqrt(0.5 * (xx + yy) + size);
    const double area = std::fabs(double(s.xx) * s.yy - double(s.xy) * s.yx);
    Ellipse e{larger, larger > 0.0 ? area / larger : 0.0, 1.0, 0.0};
    const double x = half >= 0.0 ? half + size : xy, y = half >= 0.0 ? xy : size - half;
    const double length = std::sqrt(x * x + y * y);
    if (length > 0.0) e.x = x / length, e.y = y / length;
    return e;
}

double stretch_of(const Ellipse& e, double variance, double filter_px) {
    const double tabulated = std::max(e.smaller, double(shared::SMALLEST_RADIUS_PX));
    return std::sqrt((e.larger * e.larger * variance + filter_px * filter_px) /
                     (tabulated * tabulated * variance + filter_px * filter_px));
}

Shape outline_of(const glm::dvec3& across, const glm::dvec3& down) {
    // A lower triangular matrix of the same product with its transpose.
    const double width = glm::length(across);
    if (!(width > 0.0)) return {0.0f, 0.0f, 0.0f, float(glm::length(down))};
    return {float(width), 0.0f, float(glm::dot(across, down) / width),
            float(glm::length(glm::cross(across, down)) / width)};
}

Shape project_affine(const glm::vec2& slope, const glm::mat3& ellipsoid, float px_per_unit) {
    const glm::dmat3 m(ellipsoid);
    const glm::dvec3 x(1.0, 0.0, slope.x), y(0.0, 1.0, slope.y);  // z points to the eye
    return outline_of(double(px_per_unit) * (x * m), -double(px_per_unit) * (y * m));
}

Shape project_ellipsoid(const Lens& lens, const glm::vec3& p, const glm::mat3& ellipsoid, float px_per_unit) {
    // The frame's axes at p, across the ray there: the view's axes turned the shortest way.
    glm::dvec3 x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0);
    if (!shared::has_parallel_rays(lens)) {
        const glm::dvec3 ray = glm::normalize(glm::dvec3(p)), axis(0.0, 0.0, -1.0);
        const double scale = 1.0 / (1.0 + glm::dot(axis, ray));
        x -= (axis + ray) * (ray.x * scale);
        y -= (axis + ray) * (ray.y * scale);
    }
    const glm::dmat3 m(ellipsoid);
    return outline_of(double(px_per_unit) * (x * m), -double(px_per_unit) * (y * m));
}

float shape_support_px(const Shape& shape, const FootprintExtent& extent) {
    const Ellipse e = ellipse_of(shape);
    const double stretch = stretch_of(e, extent.variance, 0.25 * double(extent.margin_px));
    const double round_px =
        std::max(e.smaller, double(shared::SMALLEST_RADIUS_PX)) * extent.reach + extent.margin_px;
    return float(round_px * std::max(1.0, stretch));
}

ShapedFootprint shaped_footprint_at(const FootprintTable& table, const Shape& shape, float x_px, float y_px) {
    const Ellipse e = ellipse_of(shape);
    const double stretch = stretch_of(e, table.variance, table.pixel_filter_px);
    const auto radius_px = float(e.smaller);
    ShapedFootprint f;
    footprint_at(table, radius_px, x_px, y_px, f.round);
    const double shrink = 1.0 / stretch - 1.0;
    f.xx = float(1.0 + shrink * e.x * e.x);
    f.xy = float(shrink * e.x * e.y);
    f.yy = float(1.0 + shrink * e.y * e.y);
    if (!shared::is_tabulated(shared::node_of_radius(radius_px))) return f;
    const FootprintMass mass = footprint_mass(table, radius_px);
    const Spectrum spectrum = spectrum_of(table, e, stretch);
    const double wanted = double(table.integral) * e.larger * e.smaller;
    set_gains(table, wanted,
              {mass.profile * stretch * (1.0 + spectrum.ripple(false, x_px, y_px)),
               table.flat_core ? mass.edge * stretch * (1.0 + spectrum.ripple(true, x_px, y_px)) : 1.0},
              f.round);
    return f;
}

void set_gains(const FootprintTable& table, double wanted, const StretchedSums& found, Footprint& f) {
    f.amplitude = 1.0f;
    f.edge_gain = 0.0f;
    if (table.flat_core && (wanted >= found.profile || f.lo > 0.0f))
        f.edge_gain = float((wanted - found.profile) / found.edge);
    else
        f.amplitude = float(wanted / found.profile);
}

NodeRange node_range(const Shape& shape) {
    const Ellipse e = ellipse_of(shape);
    // Spectra are looked up for up to twice the larger radius.
    const double spectrum =
        std::min(2.0 * std::max(e.larger, double(shared::SMALLEST_RADIUS_PX)), spectrum_end_px);
    return {float(e.smaller), float(std::max(e.smaller, spectrum))};
}

}  // namespace astrosplat
