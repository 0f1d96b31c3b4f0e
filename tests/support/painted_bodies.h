// Bodies of revolution as a telescope would see them, painted by integrating what shines along every
// line of sight.
#pragma once

#include <glm/glm.hpp>

#include "core/real.h"
#include "image/channels.h"
#include "support/painted_picture.h"

namespace astrosplat::painted {

constexpr std::int64_t body_width = 240, body_height = 150;  // px, of their pictures
constexpr double body_x = 0.52, body_y = 0.3;                // of their middle, picture widths

inline double bell(double value) { return std::exp(-0.5 * value * value); }

/// Light at a radius and a height about the axis, lengths in picture widths.
using BodyLight = std::function<double(double radius, double height)>;

inline BodyLight shell(double length, double radius) {
    return [=](double r, double h) {
        const double at = std::hypot(r / radius, h / length);
        return bell((at - 1.0) / 0.1) + (at < 1.0 ? 0.05 : 0.0);
    };
}

/// And a ring about their waist.
inline BodyLight lobes(double size) {
    return [=](double r, double h) {
        const double from = std::hypot(r, h) + 1e-9, upright = std::fabs(h) / from;
        const double wall = size * (0.35 + 0.65 * upright * std::sqrt(upright));
        return bell((from - wall) / 0.018) * (0.15 + 0.85 * bell(from / (0.6 * size))) +
               bell(std::hypot((r - 0.2 * size) / 0.015, h / 0.02));
    };
}

inline BodyLight ring(double radius) {
    return [=](double r, double h) { return bell(std::hypot(r - radius, h) / 0.035); };
}

struct Body {
    BodyLight light;
    double angle_deg, tilt_deg;
};

/// Seen from so many degrees aside, about the upright of the picture.
inline Image seen(const Body& body, double aside_deg) {
    constexpr int samples = 160;
    constexpr double deep = 1.1;  // picture widths
    const double a = real::radians(body.angle_deg), t = real::radians(body.tilt_deg),
                 c = std::cos(real::radians(aside_deg)), s = std::sin(real::radians(aside_deg));
    const glm::dvec3 axis(std::cos(a) * std::cos(t), std::sin(a) * std::cos(t), std::sin(t));
    Image image = make_image(body_width, body_height, 3);
    for_each_pixel(image, [&](std::int64_t x, std::int64_t y) {
        const double across = (double(x) + 0.5) / body_width - body_x,
                     up = body_y - (double(y) + 0.5) / body_width;
        double sum = 0.0;
        for (int k = 0; k < samples; ++k) {
            const double deep_in = ((k + 0.5) / samples - 0.5) * deep;
            const glm::dvec3 p(across * c + deep_in * s, up, deep_in * c - across * s);
            const double h = glm::dot(p, axis);
            sum += body.light(std::sqrt(std::max(0.0, glm::dot(p, p) - h * h)), h) * deep / samples;
        }
        std::fill_n(image.at(x, y), 3, float(sum));
    });
    return image;
}

inline Image times(Image image, float factor) {
    for (float& value : image.pixels) value *= factor;
    return image;
}

/// With knots that no symmetry explains, and noise.
inline Image with_knots_and_noise(Image image) {
    for (std::uint32_t i = 0; i < 30; ++i) {
        const double x = double(image.width) * random(i, 11), y = double(image.height) * random(i, 12);
        const double light = 0.5 * *image.at(std::int64_t(x), std::int64_t(y));
        add_point(image, x, y, 1.0 + random(i, 13), light, light, light);
    }
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const auto n = std::uint32_t(i / 3);
        const double noise = random(n, 14) + random(n, 15) + random(n, 16) - 1.5;
        const float value = image.pixels[i];
        image.pixels[i] = std::max(0.0f, value + 0.04f * float(noise) * std::sqrt(value + 0.01f));
    }
    return image;
}

/// Clouds without any symmetry: so many, of sigmas so large in px.
inline Image clouds(std::uint32_t count, double least, double most, std::uint32_t seed) {
    Image picture = make_image(body_width, body_height, 3);
    for (std::uint32_t i = 0; i < count; ++i) {
        const double part = random(i, seed + 3), size = std::lerp(least, most, part * part * part);
        add_point(picture, body_width * random(i, seed + 1), body_height * random(i, seed + 2), size,
                  10.0 / size, 8.0 / size, 6.0 / size);
    }
    return picture;
}

/// A bubble in front of clouds that are no part of it.
inline Image shell_among_clouds(std::uint32_t seed) {
    Image picture = clouds(40, 8.0, 40.0, seed);
    const Image bubble = seen({shell(0.13, 0.13), 30.0, 0.0}, 0.0);
    const float share = 0.3f * std::ranges::max(picture.pixels) / std::ranges::max(bubble.pixels);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i] += share * bubble.pixels[i];
    return picture;
}

}  // namespace astrosplat::painted
