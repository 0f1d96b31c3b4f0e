// Pictures that look like a telescope's, painted by formula: what the real ones are for where they cannot be
// had. Linear light, RGB, about 0..1 with a few brighter points.
#pragma once

#include "core/image.h"
#include "core/parallel.h"
#include "core/shared_maths.h"

namespace astrosplat {
namespace painted {

inline float fbm(double x, double y, double frequency, std::uint32_t seed) {
    return shared::as_fbm(float(x), float(y), 0.5f, float(frequency), 6, 2.0f, 0.55f, 0.5f, seed);
}

inline double random(std::uint32_t i, std::uint32_t purpose) {
    return double(shared::as_uniform(shared::as_hash(20261123u, i, 0u, purpose)));
}

inline void add_point(Image& image, double x, double y, double sigma, double r, double g, double b) {
    const auto reach = std::int64_t(std::ceil(5.0 * sigma));
    const auto cx = std::int64_t(x), cy = std::int64_t(y);
    for (std::int64_t j = std::max<std::int64_t>(0, cy - reach); j <= std::min(image.height - 1, cy + reach);
         ++j) {
        for (std::int64_t i = std::max<std::int64_t>(0, cx - reach);
             i <= std::min(image.width - 1, cx + reach); ++i) {
            const double dx = double(i) + 0.5 - x, dy = double(j) + 0.5 - y;
            const double light = std::exp(-(dx * dx + dy * dy) / (2.0 * sigma * sigma));
            image.at(i, j)[0] += float(r * light);
            image.at(i, j)[1] += float(g * light);
            image.at(i, j)[2] += float(b * light);
        }
    }
}

inline void add_stars(Image& image, int count, double sigma) {
    for (std::uint32_t i = 0; i < std::uint32_t(count); ++i) {
        const double x = 8.0 + random(i, 1) * (double(image.width) - 16.0);
        const double y = 8.0 + random(i, 2) * (double(image.height) - 16.0);
        const double light = 0.1 + 0.8 * std::pow(random(i, 3), 4.0), warm = random(i, 4);
        add_point(image, x, y, sigma, light * (0.7 + 0.3 * warm), light * 0.85, light * (1.0 - 0.3 * warm));
    }
}

/// color(u, v) at the middle of every pixel: places in widths of the picture from its middle.
template <class Color>
Image of_colors(std::int64_t width, std::int64_t height, const Color& color) {
    Image image = make_image(width, height, 3);
    const double w = double(width);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x) {
            const double u = (double(x) + 0.5 - 0.5 * w) / w;
            const double v = (double(y) + 0.5 - 0.5 * double(height)) / w;
            const std::array<double, 3> rgb = color(u, v);
            for (std::size_t k = 0; k < 3; ++k) image.at(x, y)[k] = float(rgb[k]);
        }
    return image;
}

/// Two arms, a warm bulge, blue knots along the arms, dust inside of them and stars before it.
inline Image galaxy(std::int64_t width, std::int64_t height) {
    Image image = of_colors(width, height, [](double u, double v) {
        const double r = std::hypot(u, v), turn = std::atan2(v, u) + 4.5 * std::log(r + 0.05);
        const double clouds = 1.0 + 1.2 * double(fbm(u, v, 14.0, 3u));
        const double arms = std::pow(0.5 + 0.5 * std::cos(2.0 * turn), 2.0) * std::exp(-r / 0.08);
        const double dust =
            1.0 - 0.6 * std::pow(0.5 + 0.5 * std::cos(2.0 * turn + 0.9), 6.0) * std::exp(-r / 0.3);
        const double bulge = 0.8 * std::exp(-r / 0.035), disk = 0.15 * std::exp(-r / 0.07);
        const double young = 0.35 * arms * std::max(0.1, clouds);
        return std::array{dust * (bulge + disk + 0.7 * young) + 0.004,
                          dust * (0.85 * bulge + 0.9 * disk + 0.85 * young) + 0.004,
                          dust * (0.6 * bulge + 0.8 * disk + 1.2 * young) + 0.004};
    });
    const double w = double(width);
    for (std::uint32_t i = 0; i < 400; ++i) {
        const double r = 0.06 + 0.3 * random(i, 11), side = i % 2 == 0 ? 0.0 : 3.14159265;
        const double angle = side - 4.5 * std::log(r + 0.05) + 0.25 * (random(i, 12) - 0.5);
        const double light = 0.15 * random(i, 13), size = 1.5 + 3.0 * random(i, 14);
        add_point(image, 0.5 * w + r * w * std::cos(angle), 0.5 * double(height) + r * w * std::sin(angle),
                  size * w / 1920.0 + 0.8, 0.7 * light, 0.8 * light, 1.3 * light);
    }
    add_stars(image, 120, 1.0);
    return image;
}

/// A galaxy in space, and how it lies: as seen from far away.
struct Tilted {
    double inclination_deg = 60.0;  // 0 face-on
    double angle_deg = 20.0;        // of the major axis, from right counter-clockwise
    bool near_above = true;         // whether its near side is the one counter-clockwise of the major axis
    double bulge = 2.0;             // light in its middle over that of the disk there
    double dust = 1.0;              // optical depth through the disk's middle, from above
    double size = 0.07;             // of the disk's exponential, in picture widths
    double arms = 0.4;              // contrast
};

/// A disk of stars with two winding arms, a spheroid of .7 and a thin layer of dust, by integrals along the
/// lines of sight.
inline Image tilted_galaxy(std::int64_t width, std::int64_t height, const Tilted& t) {
    Image image = make_image(width, height, 3);
    const double w = double(width), degree = 3.14159265358979 / 180.0;
    const double c = std::cos(t.inclination_deg * degree), s = std::sin(t.inclination_deg * degree);
    const double ca = std::cos(t.angle_deg * degree), sa = std::sin(t.angle_deg * degree);
    const double thick = 0.09 * t.size, thin = 0.03 * t.size;
    constexpr int steps = 96;
    const auto squared = [](double value) { return value * value; };
    parallel_for(height, [&](std::int64_t y, int) {
        for (std::int64_t x = 0; x < width; ++x) {
            const double right = (double(x) + 0.5) / w - 0.5;
            const double up = (0.5 * double(height) - double(y) - 0.5) / w;
            const double u = right * ca + up * sa, across = up * ca - right * sa,
                         v = t.near_above ? across : -across;
            double light[3] = {0.0, 0.0, 0.0}, passed = 1.0;
            // From the eye on, along the disk where it is crossed at an angle: denser near its plane.
            for (int k = 0; k < steps; ++k) {
                const double q = 2.0 * (k + 0.5) / steps - 1.0, reach = 5.0 * t.size;
                const double plane = c > 0.08 ? std::clamp(v * s / c, -reach, reach) : 0.0;
                const double z = plane - reach * q * q * q - (c > 0.08 ? 0.0 : reach * 0.3 * q);
                const double step = (3.0 * reach * q * q + 0.3 * reach) * 2.0 / steps;
                const double disk_y = v * c + z * s,
                             h = -v * s + z * c;  // towards the near side, off the plane
                const double r = std::hypot(u, disk_y),
                             turn = std::atan2(disk_y, u) + 3.2 * std::log(r + 0.02);
                const double wave = 1.0 + t.arms * std::cos(2.0 * turn) * std::min(1.0, r / t.size);
                const double stars = std::exp(-r / t.size) * wave / squared(std::cosh(h / thick)) / thick;
                const double b = std::hypot(r, h / 0.7) / (0.35 * t.size);
                const double ball = t.bulge * 1.2 * std::exp(-0.5 * b * b) / t.size;
                const double lanes =
                    std::exp(-r / (1.5 * t.size)) * std::min(1.0, 2.0 * r / t.size) * (0.4 + 0.6 * wave);
                const double tau = 0.5 * t.dust * lanes / squared(std::cosh(h / thin)) / thin * step;
                const double add = 0.25 * step * passed;
                light[0] += add * (0.9 * stars + 1.1 * ball);
                light[1] += add * (0.9 * stars + 0.9 * ball);
                light[2] += add * (1.0 * stars + 0.6 * ball);
                passed *= std::exp(-tau);
            }
            for (int k = 0; k < 3; ++k) image.at(x, y)[k] = float(light[k] + 0.003);
        }
    });
    add_stars(image, 60, 1.0);
    return image;
}

/// Two lobes of glowing gas with filaments and a bright middle.
inline Image nebula(std::int64_t width, std::int64_t height) {
    Image image = of_colors(width, height, [](double u, double v) {
        const double warp = 0.04 * double(fbm(u, v, 6.0, 9u));
        const double waist = 0.03 + 0.5 * std::fabs(u) * (1.2 - std::fabs(u) * 2.0);
        const double inside =
            std::exp(-std::pow(std::fabs(v + warp) / waist, 4.0)) * std::exp(-std::fabs(u) / 0.25);
        const double ridge = 1.0 - std::fabs(2.0 * double(fbm(u + warp, v, 11.0, 5u)));
        const double gas = inside * (0.25 + 0.75 * std::pow(std::max(0.0, ridge), 6.0));
        const double core = std::exp(-std::hypot(u, v) / 0.02);
        return std::array{0.8 * gas + core + 0.003, 0.35 * gas + 0.9 * core + 0.003,
                          0.15 * gas + core + 0.003};
    });
    add_stars(image, 60, 1.1);
    return image;
}

/// A shell of thin filaments about a faint blue glow.
inline Image remnant(std::int64_t width, std::int64_t height) {
    Image image = of_colors(width, height, [](double u, double v) {
        const double edge = 0.26 + 0.05 * double(fbm(u, v, 5.0, 21u));
        const double r = std::hypot(u, 1.3 * v) / edge;
        const double body = r < 1.0 ? std::sqrt(1.0 - r * r) : 0.0,
                     shell = std::exp(-std::pow((r - 0.9) / 0.12, 2.0));
        const double a = std::pow(std::max(0.0, 1.0 - std::fabs(4.0 * double(fbm(u, v, 13.0, 22u)))), 8.0);
        const double b = std::pow(std::max(0.0, 1.0 - std::fabs(4.0 * double(fbm(u, v, 19.0, 23u)))), 8.0);
        const double threads = (0.4 * body + shell);
        return std::array{0.5 * threads * a + 0.05 * body + 0.003,
                          0.3 * threads * (a + b) * 0.7 + 0.10 * body + 0.003,
                          0.35 * threads * b + 0.16 * body + 0.003};
    });
    add_stars(image, 80, 1.0);
    return image;
}

}  // namespace painted
}  // namespace astrosplat
