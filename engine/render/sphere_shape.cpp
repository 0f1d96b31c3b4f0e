#include "render/sphere_shape.h"

#include <glm/geometric.hpp>

#include "core/real.h"
#include "render/sphere_sums.h"

namespace astrosplat {
namespace {

/// Second derivative of a coordinate along the needle.
double bend_of(const glm::dvec3& bend, const Ellipse& e) {
    return e.x * e.x * bend.x + 2.0 * e.x * e.y * bend.y + e.y * e.y * bend.z;
}

/// Light of needles on a frame whose great circles are not straight: what the pixels that one crosses add up
/// to beyond what they would for a straight one. A thin gaussian on the map around a place, by its variances
/// along and across, the pixel filter's included: a needle follows a row of pixels only as far as it is
/// straight on the frame, which great circles are not.
struct BentNeedle {
    const SphereAxes& axes;
    const Ellipse& e;
    double along, across;  // variances
    glm::dvec2 along_px = e.x * axes.first_px + e.y * axes.second_px;
    glm::dvec2 across_px = e.x * axes.second_px - e.y * axes.first_px;
    glm::dvec2 bend{bend_of(axes.bend_x, e), bend_of(axes.bend_y, e)};

    /// By how much the relative excess of its sum over pixels differs from that of a straight one.
    double excess(float x_px, float y_px) const {
        const double turns = 2.0 * real::pi * along * (std::fabs(bend.x) + std::fabs(bend.y));
        if (across > 1.0 || turns < 0.02) return 0.0;  // wide ones have none; short ones do not bend
        const double cx = pixel_cosine(x_px), cy = pixel_cosine(y_px);
        const double sx = pixel_cosine(x_px - 0.25f), sy = pixel_cosine(y_px - 0.25f);
        return 2.0 * (excess_at(1, 0, cx, sx) + excess_at(0, 1, cy, sy) +
                      excess_at(1, 1, cx * cy - sx * sy, sx * cy + cx * sy) +
                      excess_at(1, -1, cx * cy + sx * sy, sx * cy - cx * sy) +
                      excess_at(2, 0, cx * cx - sx * sx, 2.0 * sx * cx) +
                      excess_at(0, 2, cy * cy - sy * sy, 2.0 * sy * cy));
    }

    /// The part of the frequency (kx, ky) cycles per px, whose phase at the middle has this cosine and sine:
    /// the spectrum of a gaussian whose places go with the square of the way is that of one with a complex
    /// variance, along / (1 + i t).
    double excess_at(double kx, double ky, double cosine, double sine) const {
        const double turn = 2.0 * real::pi * real::pi;
        const double g = kx * along_px.x + ky * along_px.y, h = kx * across_px.x + ky * across_px.y;
        const double t = 2.0 * real::pi * along * (kx * bend.x + ky * bend.y), size = 1.0 + t * t;
        const double thin = real::exp(-turn * h * h * across), exponent = turn * g * g * along;
        // 1 / sqrt(1 + i t): half the angle, the root of the length.
        const double root = std::sqrt(size), re = std::sqrt(0.5 * (1.0 + 1.0 / root) / root),
                     im = -0.5 * t / (size * re);
        const double phase = exponent * t / size, c = real::cos(phase), s = real::sin(phase);
        const double bent = thin * real::exp(-exponent / size);
        return bent * ((re * c - im * s) * cosine + (re * s + im * c) * sine) -
               thin * real::exp(-exponent) * cosine;
    }
};

constexpr double least_sine = 1e-3;  // stretching around poles and rims ends there

SphereAxes fisheye_axes(double focal, double x, double y) {
    const double angle = std::sqrt(x * x + y * y), sine = real::sin(angle), cosine = real::cos(angle);
    const bool axis = !(angle > 1e-9);
    const double right = axis ? 1.0 : x / angle, up = axis ? 0.0 : y / angle;
    const double least = std::fmax(std::fabs(sine), least_sine);
    const double across = axis ? 1.0 : angle / least;
    // A great circle's second derivative towards the middle, and around it.
    const bool close = angle < 1e-3;
    const double inwards = close ? -2.0 * angle / 3.0 : (cosine - angle / least) / least,
                 around = close ? angle / 3.0 : (1.0 - cosine * angle / least) / least;
    return {{sine * right, sine * up, -cosine},
            {cosine * right, cosine * up, sine},
            {-up, right, 0.0},
            {right, -up},
            {-up * across, -right * across},
            glm::dvec3(0.0, -up * around, right * inwards) / focal,
            glm::dvec3(0.0, -right * around, -up * inwards) / focal};
}

SphereAxes panorama_axes(const Lens& lens, double longitude, double height) {
    const double focal = lens.focal_px;
    const bool cylinder = lens.projection == shared::PROJECTION_CYLINDRICAL;
    const double latitude = cylinder ? real::atan2(height, 1.0) : height;
    const double right = real::sin(longitude), ahead = real::cos(longitude);
    const double sine = real::sin(latitude), cosine = real::cos(latitude);
    const double across = 1.0 / std::fmax(std::fabs(cosine), least_sine), tangent = sine * across;
    const double upwards = cylinder ? 1.0 + height * height : 1.0;
    return {{cosine * right, sine, -cosine * ahead},
            {ahead, 0.0, right},
            {-sine * right, cosine, sine * ahead},
            {across, 0.0},
            {0.0, -upwards},
            glm::dvec3(0.0, tangent * across, 0.0) / focal,
            glm::dvec3(upwards * tangent, 0.0, cylinder ? -2.0 * upwards * tangent : 0.0) / focal};
}

/// A footprint that is not round at a place of the frame, and what its pixels add up to.
class ShapeOnMap {
  public:
    ShapeOnMap(const FootprintTable& table, const Lens& lens, const Shape& shape, float x_px, float y_px)
        : table_(table),
          lens_(lens),
          x_px_(x_px),
          y_px_(y_px),
          e_(ellipse_of(shape)),
          filter_(table.pixel_filter_px),
          stretch_(stretch_of(e_, table.variance, filter_)),
          least_(std::fmax(e_.smaller, double(shared::SMALLEST_RADIUS_PX))),
          along_(e_.larger * e_.larger * double(table.variance) + filter_ * filter_),
          across_(least_ * least_ * double(table.variance) + filter_ * filter_),
          support_(shape_support_px(shape, {table.reach, 4.0f * table.pixel_filter_px, table.variance})),
          axes_(sphere_axes(lens, x_px, y_px)),
          rows_{(e_.x * axes_.first + e_.y * axes_.second) / stretch_,
                e_.x * axes_.second - e_.y * axes_.first},
          has_poles_(lens.projection == shared::PROJECTION_EQUIRECTANGULAR),
          pole_(near_pole(lens, y_px)) {
        footprint_at(table, radius_px(), x_px, y_px, plain_);
        plain_.amplitude = 1.0f;
        plain_.edge_gain = 0.0f;
    }

    float radius_px() const { return float(e_.smaller); }
    glm::vec3 row(int i) const { return glm::vec3(rows_[i]); }
    double light() const { return double(table_.integral) * e_.larger * e_.smaller; }

    /// Whether pixels around a pole or a rim are looked at one by one: of what is small enough
    /// that they matter.
    bool is_counted() const {
        return has_poles_ ? along_ * across_ < excessive_px && pole_.from_pole_px < support_ + near_pole_px
                          : is_at_rim();
    }

    /// Over all pixels, px of the sphere.
    StretchedSums sums() const {
        const bool small = along_ * across_ < small_px;
        if (is_at_rim())
            return both([&](const auto& weight) {
                const auto near = [&](const glm::dvec3& away, double px) { return is_near(away, px); };
                return RimPixels{lens_, axes_.toward, support_, near, weight}.sum();
            });
        if (!is_counted()) return straight_sums();
        if (small) return both([&](const auto& weight) { return rows(weight).sum(); });
        const StretchedSums all = straight_sums(),
                            more = both([&](const auto&weight) { return rows(weight).excess(); });
        return {all.profile + more.profile, table_.flat_core ? all.edge + more.edge : 1.0};
    }

  private:
    static constexpr double small_px = 36.0, excessive_px = 2500.0;  // variances along times across

    bool is_at_rim() const {
        return along_ * across_ < small_px && shows_all_round(lens_) &&
               is_near_rim(lens_, axes_.toward, support_ + near_rim_shaped_px);
    }

    template <class Weight>
    PoleRows<Weight> rows(const Weight& weight) const {
        return {lens_, pole_, axes_.toward, support_, std::clamp(1.5 * filter_, 0.25, 1.0), weight};
    }

    /// P at a pixel, `away` from the middle, both of length focal_px.
    double profile(const glm::dvec3& away) const {
        const double x = glm::dot(rows_[0], away), y = glm::dot(rows_[1], away), focal = lens_.focal_px;
        const double half_cosine = 1.0 - glm::dot(away, away) / (4.0 * focal * focal);  // squared
        const double squared = (x * x + y * y) / std::fmax(half_cosine, 1e-6);
        return double(footprint_weight(table_, plain_, float(std::sqrt(squared))));
    }

    /// Whether any place so near to one has weight.
    bool is_near(const glm::dvec3& away, double within_px) const {
        const double x = std::fmax(0.0, std::fabs(glm::dot(rows_[0], away)) - within_px / stretch_),
                     y = std::fmax(0.0, std::fabs(glm::dot(rows_[1], away)) - within_px);
        return x * x + y * y <= double(plain_.support_px) * double(plain_.support_px);
    }

    /// A sum of P and, where it is asked for, of P (1 - P).
    template <class Sum>
    StretchedSums both(const Sum& sum) const {
        const auto weight = [&](const glm::dvec3& away) { return profile(away); };
        const auto edge = [&](const glm::dvec3& away) {
            const double p = profile(away);
            return p * (1.0 - p);
        };
        return {sum(weight), table_.flat_core ? sum(edge) : 1.0};
    }

    /// By the spectrum on a frame of one stretch, and the bend of needles.
    StretchedSums straight_sums() const {
        const double gain = stretch_ * stretch_ - 1.0;
        const glm::dvec2 longer = e_.x * axes_.first_px + e_.y * axes_.second_px;
        const auto product = [&](int i, int j) {
            return axes_.first_px[i] * axes_.first_px[j] + axes_.second_px[i] * axes_.second_px[j] +
                   gain * longer[i] * longer[j];
        };
        const FootprintMass mass = footprint_mass(table_, radius_px());
        const Spectrum spectrum(table_, least_, {product(0, 0), product(0, 1), product(1, 1)});
        // At a pole itself nothing is straight or of one stretch.
        const bool at_pole = has_poles_ && pole_.from_pole_px < near_pole_px;
        const auto ripple = [&](bool of_edge) {
            return at_pole ? 0.0 : spectrum.ripple(of_edge, x_px_, y_px_);
        };
        const auto bent = [&](double share) {
            const BentNeedle needle{axes_, e_, share * along_, share * across_};
            return at_pole ? 0.0 : needle.excess(x_px_, y_px_);
        };
        const double bent_profile = bent(1.0);
        StretchedSums found{mass.profile * stretch_ * (1.0 + ripple(false) + bent_profile), 1.0};
        if (table_.flat_core) {  // P (1 - P): P^2 is a gaussian of half the variances
            const double rest = double(mass.edge) / double(mass.profile);
            const double bent_edge = (bent_profile - (1.0 - rest) * bent(0.5)) / rest;
            found.edge = mass.edge * stretch_ * (1.0 + ripple(true) + bent_edge);
        }
        return found;
    }

    const FootprintTable& table_;
    const Lens& lens_;
    float x_px_, y_px_;
    Ellipse e_;
    double filter_, stretch_, least_, along_, across_, support_;
    SphereAxes axes_;
    glm::dvec3 rows_[2];
    bool has_poles_;
    NearPole pole_;
    Footprint plain_;
};

}  // namespace

SphereAxes sphere_axes_by_differences(const Lens& lens, double x_px, double y_px) {
    constexpr double angle = 1e-3;  // between neighbours, radians
    const ExactLens exact = exact_lens(lens);
    const double step_px = angle * exact.focal_px;
    SphereAxes axes;
    axes.toward = glm::normalize(exact::ray_through(exact, x_px, y_px));
    const glm::dvec3 right = glm::normalize(exact::ray_through(exact, x_px + 0.5, y_px)) - axes.toward;
    axes.first = glm::normalize(right - glm::dot(right, axes.toward) * axes.toward);
    axes.second = glm::cross(axes.first, axes.toward);
    // Along the great circle that begins in the direction of `across`, to both of its sides.
    const auto neighbours = [&](const glm::dvec3& across) {
        const auto place = [&](double sine) {
            const exact::Instance at =
                exact::instance_of(exact, real::cos(angle) * axes.toward + sine * across);
            return glm::dvec2(at.x_px, at.y_px);
        };
        const glm::dvec2 before = place(-real::sin(angle)), after = place(real::sin(angle));
        struct Derivatives {
            glm::dvec2 first, second;
        };
        return Derivatives{(after - before) / (2.0 * step_px),
                           (after + before - 2.0 * glm::dvec2(x_px, y_px)) / (step_px * step_px)};
    };
    const auto along = neighbours(axes.first), across = neighbours(axes.second),
               between = neighbours(glm::normalize(axes.first + axes.second));
    axes.first_px = along.first;
    axes.second_px = across.first;
    const glm::dvec2 mixed = between.second - 0.5 * (along.second + across.second);
    axes.bend_x = {along.second.x, mixed.x, across.second.x};
    axes.bend_y = {along.second.y, mixed.y, across.second.y};
    return axes;
}

SphereAxes sphere_axes(const Lens& lens, double x_px, double y_px) {
    const double focal = lens.focal_px, period = shared::period_px(lens);
    double x = x_px - double(lens.center_x_px);
    if (period > 0.0) x -= period * std::floor(x / period + 0.5);  // the same at all of its places
    const double y = double(lens.center_y_px) - y_px;
    if (lens.projection == shared::PROJECTION_FISHEYE) return fisheye_axes(focal, x / focal, y / focal);
    if (shared::is_panorama(lens)) return panorama_axes(lens, x / focal, y / focal);
    return sphere_axes_by_differences(lens, x_px, y_px);
}

Shape project_onto_sphere(const SphereAxes& axes, const glm::mat3& ellipsoid, float px_per_unit) {
    const glm::dmat3 m(ellipsoid);
    return outline_of(double(px_per_unit) * (axes.first * m), double(px_per_unit) * (axes.second * m));
}

double frame_area(const SphereAxes& axes) {
    return std::fabs(axes.first_px.x * axes.second_px.y - axes.first_px.y * axes.second_px.x);
}

Shape onto_sphere(const SphereAxes& axes, const Shape& on_frame) {
    const glm::dvec2 a = axes.first_px, b = axes.second_px;
    const double area = a.x * b.y - a.y * b.x;
    const auto along_first = [&](double x, double y) { return (b.y * x - b.x * y) / area; };
    const auto along_second = [&](double x, double y) { return (a.x * y - a.y * x) / area; };
    const Shape& s = on_frame;
    return outline_of({along_first(s.xx, s.yx), along_first(s.xy, s.yy), 0.0},
                      {along_second(s.xx, s.yx), along_second(s.xy, s.yy), 0.0});
}

SphereFootprint shaped_sphere_footprint_at(const FootprintTable& table, const Lens& lens, const Shape& shape,
                                           float x_px, float y_px) {
    const ShapeOnMap ellipse(table, lens, shape, x_px, y_px);
    SphereFootprint f;
    footprint_at(table, ellipse.radius_px(), x_px, y_px, f.round);
    for (int i = 0; i < 2; ++i) f.rows[i] = ellipse.row(i);
    if (!shared::is_tabulated(shared::node_of_radius(ellipse.radius_px()))) return f;
    const auto set = [&] { set_gains(table, ellipse.light(), ellipse.sums(), f.round); };
    if (ellipse.is_counted())
        CountedGains::set(
            CountedGains::key_of(table, lens, {shape.xx, shape.xy, shape.yx, shape.yy, x_px, y_px}), f.round,
            set);
    else
        set();
    return f;
}

}  // namespace astrosplat
