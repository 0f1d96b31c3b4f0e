// Sums over the pixels of a frame that shows the sphere, each weighted by its solid angle: where pixels are
// few and unlike each other, at a panorama's poles and at the rim of a fisheye that sees all round, no
// spectrum says what a footprint adds up to. In: a lens, a place, weights. Out: px of the sphere; and the
// gains that came of such sums, kept for the next time.
#pragma once

#include <mutex>
#include <unordered_map>

#include "camera/projection.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "render/footprint.h"

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

/// Over the pixels near the rim of such a fisheye, a share of which a needle crosses: its pole is all around.
/// `near`(from `toward`, within_px) is false only where weights are 0 at all places so close to that one;
/// `weight`(from `toward` to the pixel, px of the middle).
template <class Near, class Weight>
struct RimPixels {
    const Lens& frame;
    glm::dvec3 toward;
    double support_px;
    const Near& near;
    const Weight& weight;
    ExactLens lens = exact_lens(frame);
    double focal = frame.focal_px, rim = real::pi * focal;
    double inner = std::fmax(0.0, focal_angle(frame, toward) - support_px - 1.0);
    double total = 0.0;

    /// Row by row; blocks that nothing reaches would add zeros.
    double sum() {
        const double first = first_middle(double(lens.center_y_px) - rim);
        for (double top = first; top <= double(lens.center_y_px) + rim; top += block_px) {
            const std::vector<double> blocks = blocks_of(top);
            for (double y = top; y < top + block_px; y += 1.0)
                for (const double left : blocks) add_row(left, y);
        }
        return total;
    }

    static constexpr double block_px = 16.0;

    static double first_middle(double px) { return std::ceil(px - 0.5) + 0.5; }

    /// From `toward` to what a fisheye shows there, within its rim.
    glm::dvec3 away(double x, double y) const {
        const double px = std::sqrt(x * x + y * y), angle = std::fmin(px / focal, real::pi);
        const double across = px > 0.0 ? real::sin(angle) / px : 0.0;
        return focal * (glm::dvec3(across * x, -across * y, -real::cos(angle)) - toward);
    }

    /// The left middles of those in the band below `top` that may have weight. What is nearer on the frame is
    /// no farther on the sphere, so half a diagonal is enough.
    std::vector<double> blocks_of(double top) const {
        constexpr double half = 0.5 * (block_px - 1.0), reach_px = 1.5 * half + 0.1;
        std::vector<double> blocks;
        const double y = top + half - double(lens.center_y_px);
        for (double left = first_middle(double(lens.center_x_px) - rim);
             left <= double(lens.center_x_px) + rim; left += block_px) {
            const double x = left + half - double(lens.center_x_px), px = std::sqrt(x * x + y * y);
            if (px + reach_px < inner || px - reach_px > rim) continue;
            if (near(away(x, y), reach_px)) blocks.push_back(left);
        }
        return blocks;
    }

    /// The same from the rim, with which a series is good enough to see what is far.
    bool is_near(double x, double y, double px) const {
        const double e = real::pi - px / focal;
        if (!(e < 0.5)) return true;
        const double q = e * e, sine = e * (1.0 - q * (1.0 / 6.0 - q / 120.0));
        const double cosine = 1.0 - q * (0.5 - q * (1.0 / 24.0 - q / 720.0));
        return near(focal * (glm::dvec3(sine * x / px, -sine * y / px, cosine) - toward), 0.05);
    }

    void add_row(double left, double y_px) {
        const double y = y_px - double(lens.center_y_px);
        for (double x_px = left; x_px < left + block_px; x_px += 1.0) {
            const double x = x_px - double(lens.center_x_px), px = std::sqrt(x * x + y * y);
            if (px < inner || px > rim || !(px > 0.0) || !is_near(x, y, px)) continue;
            if (!exact::shows(lens, x_px, y_px)) continue;
            const glm::dvec3 ray = exact::ray_through(lens, x_px, y_px);
            const double angle = px / focal;
            total += weight(focal * (ray - toward)) * real::sin(angle) / angle;
        }
    }
};

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

/// How far from the pole its first row is: rows are those of the frame, whose pixels' middles are at halves.
inline double first_row_px(const NearPole& pole) {
    return pole.side > 0.0 ? std::ceil(pole.row_px - 0.5) + 0.5 - pole.row_px
                           : pole.row_px - (std::floor(pole.row_px - 0.5) + 0.5);
}

/// Of a row so far from the pole, px of the sphere.
inline double row_area(double focal, double row_px) {
    return 2.0 * real::pi * focal * focal *
           (real::cos(std::fmax(0.0, row_px - 0.5) / focal) - real::cos((row_px + 0.5) / focal));
}

/// Weights of pixels around a pole as far as `support_px` from `toward`; weight as in RimPixels,
/// smooth over step_px.
template <class Weight>
struct PoleRows {
    const Lens& frame;
    NearPole pole;
    glm::dvec3 toward;
    double support_px, step_px;
    const Weight& weight;
    double focal = frame.focal_px, first = first_row_px(pole);

    /// Over all pixels.
    double sum() const {
        double sum = 0.0;
        for (double row = first; row < pole.from_pole_px + support_px + 1.0; row += 1.0)
            if (row > pole.from_pole_px - support_px - 1.0) sum += row_area(focal, row) * mean(row);
        return sum;
    }

    /// The excess over the integral of the rows close to the pole, each taken for its middle.
    double excess() const {
        constexpr double close_px = 4.0, end_px = 18.0;  // fades out: an end would have an excess of its own
        const auto fade = [](double row) { return real::exp(-0.5 * row * row / (close_px * close_px)); };
        double sum = 0.0;
        for (double row = first; row < end_px; row += 1.0)
            sum += row_area(focal, row) * fade(row) * mean(row);
        for (double from = 0.0; from < end_px; from += 2.0)
            sum -= integrate_panel(from, from + 2.0, [&](double row) {
                return 2.0 * real::pi * focal * real::sin(row / focal) * fade(row) * mean(row);
            });
        return sum;
    }

    /// Over all longitudes, of which as many are looked at as the weight asks for.
    double mean(double row_px) const {
        const double own = pole.from_pole_px / focal;
        const double sine = real::sin(row_px / focal), cosine = real::cos(row_px / focal);
        // How far from its own longitude the row comes as near as the support.
        const double chord = std::fmin(support_px / focal, 2.0);
        const double reach =
            (1.0 - 0.5 * chord * chord - real::cos(own) * cosine) / std::fmax(real::sin(own) * sine, 1e-12);
        if (reach >= 1.0) return 0.0;
        const double half = real::acos(std::fmax(reach, -1.0));
        const double places = std::ceil(16.0 + 2.0 * half * sine * focal / step_px);
        const double longitude = real::atan2(toward.x, -toward.z);
        // From one to the next by a turn: sines and cosines are expensive.
        const double begin = longitude + half * (1.0 / places - 1.0), step = 2.0 * half / places;
        const double turn_sine = real::sin(step), turn_cosine = real::cos(step);
        double right = real::sin(begin), ahead = real::cos(begin), sum = 0.0;
        for (double i = 0.0; i < places; i += 1.0) {
            sum += weight(focal * (glm::dvec3(sine * right, pole.side * cosine, -sine * ahead) - toward));
            const double before = right;
            right = before * turn_cosine + ahead * turn_sine;
            ahead = ahead * turn_cosine - before * turn_sine;
        }
        return sum / places * (half / real::pi);
    }
};

/// Gains of footprints whose pixels were counted one by one, for all threads together: around a panorama's
/// pole a splat touches the cells of whole rows, and would be counted for each.
class CountedGains {
  public:
    using Key = std::array<float, 15>;
    /// `splat`: what the gains depend on besides the table and the lens.
    static Key key_of(const FootprintTable& table, const Lens& lens, const std::array<float, 6>& splat) {
        const auto projection = float(lens.projection), shape = float(int(table.falloff.shape));
        Key key{
            lens.focal_px,      lens.center_x_px,        lens.center_y_px,     lens.edge, projection, shape,
            table.falloff.core, table.falloff.sharpness, table.pixel_filter_px};
        std::ranges::copy(splat, key.end() - splat.size());
        return key;
    }
    /// Sets a footprint's gains to those known of the key, or by find(), which is a function of the key: a
    /// thread may find what another is about to know.
    template <class Find>
    static void set(const Key& key, Footprint& f, const Find& find) {
        Part& part = part_of(key);
        {
            const std::lock_guard lock(part.mutex);
            if (const auto known = part.gains.find(key); known != part.gains.end()) {
                f.amplitude = known->second.first;
                f.edge_gain = known->second.second;
                return;
            }
        }
        find();
        const std::lock_guard lock(part.mutex);
        if (part.gains.size() >= most_kept / parts) part.gains.clear();
        part.gains.emplace(key, std::pair{f.amplitude, f.edge_gain});
    }

  private:
    static constexpr std::size_t most_kept = 1 << 16, parts = 64;  // 8 MB; threads seldom meet

    static std::uint32_t hash_of(const Key& key) {
        std::uint32_t hash = 0;
        for (const float number : key) hash = shared::as_mix(hash ^ std::bit_cast<std::uint32_t>(number));
        return hash;
    }
    struct Hash {
        std::size_t operator()(const Key& key) const { return hash_of(key); }
    };
    struct Part {
        std::mutex mutex;
        std::unordered_map<Key, std::pair<float, float>, Hash> gains;
    };
    static Part& part_of(const Key& key) {
        static std::array<Part, parts> all;
        return all[hash_of(key) >> 26];
    }
};

}  // namespace astrosplat
