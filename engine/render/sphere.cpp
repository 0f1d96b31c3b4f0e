#include "render/sphere_shape.h"

#include <glm/geometric.hpp>

#include "camera/projection.h"
#include "core/real.h"
#include "render/shape.h"
#include "render/sphere_sums.h"

namespace astrosplat {
namespace {

/// The stretch of the frame at a place: its px per px of the sphere there, as a matrix times its transpose.
PixelStretch stretch_at(const Lens& lens, double x_px, double y_px) {
    const double x = (x_px - double(lens.center_x_px)) / double(lens.focal_px);
    const double y = (y_px - double(lens.center_y_px)) / double(lens.focal_px);
    if (lens.projection == shared::PROJECTION_FISHEYE) {
        const double angle = std::sqrt(x * x + y * y), sine = real::sin(angle);
        if (!(angle > 1e-6)) return {};
        const double across = angle / std::fmax(std::fabs(sine), 1e-3);
        const double gain = (across * across - 1.0) / (angle * angle);
        return {1.0 + gain * y * y, -gain * x * y, 1.0 + gain * x * x};
    }
    if (lens.projection == shared::PROJECTION_CYLINDRICAL) {
        const double squared = 1.0 + y * y;
        return {squared, 0.0, squared * squared};
    }
    if (lens.projection == shared::PROJECTION_EQUIRECTANGULAR) {
        const double cosine = std::fmax(std::fabs(real::cos(y)), 1e-3);
        return {1.0 / (cosine * cosine), 0.0, 1.0};
    }
    const SphereAxes axes = sphere_axes(lens, x_px, y_px);
    const auto product = [&](int i, int j) {
        return axes.first_px[i] * axes.first_px[j] + axes.second_px[i] * axes.second_px[j];
    };
    return {product(0, 0), product(0, 1), product(1, 1)};
}

/// Of weight(squared distance, px) over the pixels of a row around a pole, `own`: the latitude of the middle,
/// both from the pole.
template <class Weight>
double mean_along_row(double focal, double own, double colatitude, const Weight& weight) {
    constexpr int longitudes = 64;
    const double along = real::cos(own) * real::cos(colatitude),
                 across = real::sin(own) * real::sin(colatitude);
    double sum = 0.0;
    for (int i = 0; i < longitudes; ++i) {
        const double cosine = along + across * real::cos(2.0 * real::pi * (i + 0.5) / longitudes);
        sum += weight(2.0 * focal * focal * std::fmax(0.0, 1.0 - cosine));
    }
    return sum / longitudes;
}

/// The sum of weights over the rows around a pole of an equirectangular frame, each times its pixels' solid
/// angle, px of the sphere: there rows are few and unlike each other, and no spectrum gives their sum.
template <class Weight>
double sum_at_pole(const Lens& lens, const NearPole& pole, double support_px, const Weight& weight) {
    const double focal = lens.focal_px;
    double sum = 0.0;
    for (double row = first_row_px(pole); row < pole.from_pole_px + support_px + 1.0; row += 1.0)
        if (row >= pole.from_pole_px - support_px - 1.0)
            sum +=
                row_area(focal, row) * mean_along_row(focal, pole.from_pole_px / focal, row / focal, weight);
    return sum;
}

void normalise(const FootprintTable& table, float radius_px, double found, double edge_found, Footprint& f) {
    const double wanted = double(table.integral) * radius_px * radius_px;
    f.amplitude = 1.0f;
    f.edge_gain = 0.0f;
    if (radius_px < shared::SMALLEST_RADIUS_PX || !table.flat_core)
        f.amplitude = float(wanted / found);
    else
        f.edge_gain = float((wanted - found) / edge_found);
}

}  // namespace

void set_directions(const Lens& lens, TilePlanes& planes) {
    const ExactLens exact_one = exact_lens(lens);
    constexpr float nowhere = 1e9f;
    for (Buffer<float>& plane : planes.toward) plane.assign(planes.alpha.size(), nowhere);
    for (int y = 0; y < planes.height; ++y)
        for (int x = 0; x < planes.width; ++x) {
            const double x_px = double(planes.x0 + x) + 0.5, y_px = double(planes.y0 + y) + 0.5;
            if (!exact::shows(exact_one, x_px, y_px)) continue;
            const glm::dvec3 ray =
                exact_one.focal_px * glm::normalize(exact::ray_through(exact_one, x_px, y_px));
            for (int k = 0; k < 3; ++k) planes.toward[k][planes.at(x, y)] = float(ray[k]);
        }
}

Footprint sphere_footprint_at(const FootprintTable& table, const Lens& lens, float radius_px, float x_px,
                              float y_px) {
    Footprint f;
    footprint_at(table, radius_px, x_px, y_px, f);
    const float drawn_px = std::max(radius_px, shared::SMALLEST_RADIUS_PX);
    if (drawn_px > sphere_spectrum_px) return f;
    Footprint plain = f;
    plain.amplitude = 1.0f;
    plain.edge_gain = 0.0f;
    const auto profile = [&](double squared) {
        return double(footprint_weight(table, plain, float(std::sqrt(squared))));
    };
    const auto edge_of = [&](double squared) {
        const double p = profile(squared);
        return p * (1.0 - p);
    };
    const auto set_counted = [&](const auto& sum) {
        CountedGains::set(CountedGains::key_of(table, lens, {radius_px, x_px, y_px, -1.0f}), f, [&] {
            normalise(table, radius_px, sum(profile), table.flat_core ? sum(edge_of) : 1.0, f);
        });
        return f;
    };
    if (shows_all_round(lens)) {
        const glm::dvec3 toward =
            glm::normalize(exact::ray_through(exact_lens(lens), double(x_px), double(y_px)));
        if (is_near_rim(lens, toward, double(f.support_px) + near_rim_px))
            return set_counted([&](const auto& weight) {
                const auto near = [&](const glm::dvec3& away, double px) {
                    const double reach = double(f.support_px) + px;
                    return glm::dot(away, away) <= reach * reach;
                };
                const auto at = [&](const glm::dvec3& away) { return weight(glm::dot(away, away)); };
                return RimPixels{lens, toward, f.support_px, near, at}.sum();
            });
    }
    if (lens.projection == shared::PROJECTION_EQUIRECTANGULAR) {
        const NearPole pole = near_pole(lens, y_px);
        if (pole.from_pole_px < double(f.support_px) + near_pole_px)
            return set_counted(
                [&](const auto& weight) { return sum_at_pole(lens, pole, f.support_px, weight); });
    }
    const FootprintMass mass = footprint_mass(table, drawn_px);
    const Spectrum spectrum(table, drawn_px, stretch_at(lens, x_px, y_px));
    normalise(table, radius_px, double(mass.profile) * (1.0 + spectrum.ripple(false, x_px, y_px)),
              double(mass.edge) * (1.0 + spectrum.ripple(true, x_px, y_px)), f);
    return f;
}

}  // namespace astrosplat
