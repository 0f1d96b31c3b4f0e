// Sums over the pixels of a frame that shows the sphere, each weighted by its solid angle: where pixels are
// few and unlike each other, at a panorama's poles and at the rim of a fisheye that sees all round, no
// spectrum tells what a footprint adds up to. In: a lens, a place, weights. Out: px of the sphere.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "camera/projection.h"
#include "core/quadrature.h"
#include "core/real.h"

namespace astrosplat {

/// So near pixels are counted one by one; around a rim more of them where splats are not round.
constexpr double near_pole_px = 12.0, near_rim_px = 4.0, near_rim_shaped_px = 20.0;

inline ExactLens exact_lens(const Lens& lens) {
    return {lens.projection, lens.focal_px,  lens.center_x_px, lens.center_y_px, lens.near,
            lens.far,        lens.near_fade, lens.edge,        lens.parallax};
}

/// A fisheye whose rim is one direction.
inline bool shows_all_round(const Lens& lens) {
    return lens.projection == shared::PROJECTION_FISHEYE && double(lens.edge) > 3.14159;
}

/// From the view axis, px.
inline double focal_angle(const Lens& lens, const glm::dvec3& toward) {
    return double(lens.focal_px) * real::acos(-toward.z);
}

inline bool is_near_rim(const Lens& lens, const glm::dvec3& toward, double within_px) {
    return focal_angle(lens, toward) > real::pi * double(lens.focal_px) - within_px;
}

/// Over the pixels near the rim of such a fisheye: weight(from `toward` to the pixel, px of the middle).
template <class Weight>
double rim_sum(const Lens& lens, const glm::dvec3& toward, double support_px, const Weight& weight) {
    const ExactLens exact_one = exact_lens(lens);
    const double focal = lens.focal_px, rim = real::pi * focal;
    const double inner = std::fmax(0.0, focal_angle(lens, toward) - support_px - 1.0);
    const auto middles_from = [](double px) { return std::ceil(px - 0.5) + 0.5; };
    const double sine = std::sqrt(toward.x * toward.x + toward.y * toward.y);
    double sum = 0.0;
    const auto add = [&](double from_px, double to_px, double y_px) {
        for (double x_px = middles_from(from_px); x_px <= to_px; x_px += 1.0) {
            const double x = x_px - double(lens.center_x_px), y = y_px - double(lens.center_y_px);
            const double angle = std::sqrt(x * x + y * y) / focal;
            // Too far around the axis, for which no angle has to be known: the chord's square is no less than
            // 2 (1 - cosine) of the turn times both sines, and a sine than its own chord.
            const double least_sine = 2.0 / real::pi * std::fmin(angle, std::fmax(real::pi - angle, 0.0));
            const double cosine = sine > 0.0 ? (x * toward.x - y * toward.y) / (angle * focal * sine) : 1.0;
            if (focal * focal * 2.0 * (1.0 - cosine) * sine * least_sine > support_px * support_px) continue;
            if (!exact::shows(exact_one, x_px, y_px)) continue;
            const glm::dvec3 ray = exact::ray_through(exact_one, x_px, y_px), away = focal * (ray - toward);
            sum += weight(away) * real::sin(angle) / angle;
        }
    };
    for (double y_px = middles_from(double(lens.center_y_px) - rim); y_px <= double(lens.center_y_px) + rim;
         y_px += 1.0) {
        const double y = y_px - double(lens.center_y_px);
        const double outside = std::sqrt(std::fmax(0.0, rim * rim - y * y)),
                     inside = std::sqrt(std::fmax(0.0, inner * inner - y * y));
        add(double(lens.center_x_px) - outside, double(lens.center_x_px) - inside, y_px);
        add(double(lens.center_x_px) + std::fmax(inside, 1e-9), double(lens.center_x_px) + outside, y_px);
    }
    return sum;
}

/// The pole of an equirectangular frame that is nearer to a row.
struct NearPole {
    double side;          // 1: the north pole, above
    double row_px;        // of the pole itself
    double from_pole_px;  // the row asked for
};
inline NearPole near_pole(const Lens& lens, double y_px) {
    const double quarter = 0.5 * real::pi * double(lens.focal_px);
    const double top = double(lens.center_y_px) - quarter, bottom = double(lens.center_y_px) + quarter;
    const bool north = y_px - top < bottom - y_px;
    return {north ? 1.0 : -1.0, north ? top : bottom, std::fabs(y_px - (north ? top : bottom))};
}

/// Weights of pixels around a pole as far as `support_px` from `toward`; weight as in rim_sum, smooth over
/// step_px.
template <class Weight>
class PoleRows {
  public:
    PoleRows(const Lens& lens, const NearPole& pole, const glm::dvec3& toward, double support_px,
             double step_px, const Weight& weight)
        : focal_(lens.focal_px),
          pole_(pole),
          toward_(toward),
          support_px_(support_px),
          step_px_(step_px),
          weight_(weight),
          // Rows are those of the frame, whose pixels' middles are at halves.
          first_(pole.side > 0.0 ? std::ceil(pole.row_px - 0.5) + 0.5 - pole.row_px
                                 : pole.row_px - (std::floor(pole.row_px - 0.5) + 0.5)) {}

    /// Over all pixels.
    double sum() const {
        double sum = 0.0;
        for (double row = first_; row < pole_.from_pole_px + support_px_ + 1.0; row += 1.0)
            if (row > pole_.from_pole_px - support_px_ - 1.0) sum += area(row) * mean(row);
        return sum;
    }

    /// What the rows close to the pole, each taken for its middle, have in excess of the integral.
    double excess() const {
        constexpr double close_px = 4.0, end_px = 18.0;  // fades out: an end would have an excess of its own
        const auto fade = [](double row) { return real::exp(-0.5 * row * row / (close_px * close_px)); };
        double sum = 0.0;
        for (double row = first_; row < end_px; row += 1.0) sum += area(row) * fade(row) * mean(row);
        for (double from = 0.0; from < end_px; from += 2.0)
            sum -= integrate_panel(from, from + 2.0, [&](double row) {
                return 2.0 * real::pi * focal_ * real::sin(row / focal_) * fade(row) * mean(row);
            });
        return sum;
    }

  private:
    /// Of a row so far from the pole, px of the sphere.
    double area(double row_px) const {
        return 2.0 * real::pi * focal_ * focal_ *
               (real::cos(std::fmax(0.0, row_px - 0.5) / focal_) - real::cos((row_px + 0.5) / focal_));
    }

    /// Over all longitudes, of which as many are looked at as the weight asks for.
    double mean(double row_px) const {
        const double own = pole_.from_pole_px / focal_;
        const double sine = real::sin(row_px / focal_), cosine = real::cos(row_px / focal_);
        // How far from its own longitude the row comes as near as the support.
        const double chord = std::fmin(support_px_ / focal_, 2.0);
        const double reach =
            (1.0 - 0.5 * chord * chord - real::cos(own) * cosine) / std::fmax(real::sin(own) * sine, 1e-12);
        if (reach >= 1.0) return 0.0;
        const double half = real::acos(std::fmax(reach, -1.0));
        const double places = std::ceil(16.0 + 2.0 * half * sine * focal_ / step_px_);
        const double longitude = real::atan2(toward_.x, -toward_.z);
        // From one to the next by a turn: sines and cosines are dear.
        const double begin = longitude + half * (1.0 / places - 1.0), step = 2.0 * half / places;
        const double turn_sine = real::sin(step), turn_cosine = real::cos(step);
        double right = real::sin(begin), ahead = real::cos(begin), sum = 0.0;
        for (double i = 0.0; i < places; i += 1.0) {
            sum += weight_(focal_ * (glm::dvec3(sine * right, pole_.side * cosine, -sine * ahead) - toward_));
            const double before = right;
            right = before * turn_cosine + ahead * turn_sine;
            ahead = ahead * turn_cosine - before * turn_sine;
        }
        return sum / places * (half / real::pi);
    }

    double focal_;
    NearPole pole_;
    glm::dvec3 toward_;
    double support_px_, step_px_;
    const Weight& weight_;
    double first_;
};

}  // namespace astrosplat
