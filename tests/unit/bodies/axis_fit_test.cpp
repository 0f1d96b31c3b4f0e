// Bodies of revolution, painted by integrating what shines along every line of sight: their axis, their tilt,
// and what they look like from where no picture was taken.
#include "bodies/axis_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <ostream>
#include <string>

#include "bodies/axis_depths.h"
#include "core/real.h"
#include "image/channels.h"
#include "support/painted_picture.h"

namespace astrosplat {
namespace {

constexpr std::int64_t painted_width = 240, painted_height = 150;  // px
constexpr double body_x = 0.52, body_y = 0.3;                      // of a body, picture widths

double bell(double value) { return std::exp(-0.5 * value * value); }

/// Light at a radius and a painted_height about the axis, lengths in picture widths.
using Light = std::function<double(double radius, double painted_height)>;

Light shell(double length, double radius) {
    return [=](double r, double h) {
        const double at = std::hypot(r / radius, h / length);
        return bell((at - 1.0) / 0.1) + (at < 1.0 ? 0.05 : 0.0);
    };
}

/// And a ring about their waist.
Light lobes(double size) {
    return [=](double r, double h) {
        const double from = std::hypot(r, h) + 1e-9, upright = std::fabs(h) / from;
        const double wall = size * (0.35 + 0.65 * upright * std::sqrt(upright));
        return bell((from - wall) / 0.018) * (0.15 + 0.85 * bell(from / (0.6 * size))) +
               bell(std::hypot((r - 0.2 * size) / 0.015, h / 0.02));
    };
}

Light ring(double radius) {
    return [=](double r, double h) { return bell(std::hypot(r - radius, h) / 0.035); };
}

struct Nebula {
    Light light;
    double angle_deg, tilt_deg;
};

/// Seen from so many degrees aside, about the upright of the picture.
Image seen(const Nebula& nebula, double aside_deg) {
    constexpr int samples = 160;
    constexpr double deep = 1.1;  // picture widths
    const double a = real::radians(nebula.angle_deg), t = real::radians(nebula.tilt_deg),
                 c = std::cos(real::radians(aside_deg)), s = std::sin(real::radians(aside_deg));
    const glm::dvec3 axis(std::cos(a) * std::cos(t), std::sin(a) * std::cos(t), std::sin(t));
    Image image = make_image(painted_width, painted_height, 3);
    for_each_pixel(image, [&](std::int64_t x, std::int64_t y) {
        const double across = (static_cast<double>(x) + 0.5) / painted_width - body_x,
                     up = body_y - (static_cast<double>(y) + 0.5) / painted_width;
        double sum = 0.0;
        for (int k = 0; k < samples; ++k) {
            const double deep_in = ((k + 0.5) / samples - 0.5) * deep;
            const glm::dvec3 p(across * c + deep_in * s, up, deep_in * c - across * s);
            const double h = glm::dot(p, axis);
            sum += nebula.light(std::sqrt(std::max(0.0, glm::dot(p, p) - h * h)), h) * deep / samples;
        }
        std::fill_n(image.at(x, y), 3, static_cast<float>(sum));
    });
    return image;
}

Image times(Image image, float factor) {
    for (float& value : image.pixels) value *= factor;
    return image;
}

float brightest(const Image& image) { return *std::ranges::max_element(image.pixels); }

/// With knots that no symmetry explains, and noise.
Image telescopes(Image image) {
    for (std::uint32_t i = 0; i < 30; ++i) {
        const double x = painted_width * painted::random(i, 11), y = painted_height * painted::random(i, 12);
        const double light = 0.5 * *image.at(static_cast<std::int64_t>(x), static_cast<std::int64_t>(y));
        painted::add_point(image, x, y, 1.0 + painted::random(i, 13), light, light, light);
    }
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const auto n = static_cast<std::uint32_t>(i / 3);
        const double noise = painted::random(n, 14) + painted::random(n, 15) + painted::random(n, 16) - 1.5;
        const float value = image.pixels[i];
        image.pixels[i] =
            std::max(0.0f, value + 0.04f * static_cast<float>(noise) * std::sqrt(value + 0.01f));
    }
    return image;
}

struct Found {
    Image picture, truth[2];  // from 60 degrees aside
    AxisFit fit;
};
constexpr double aside_deg[2] = {60.0, -60.0};

Found found(const Nebula& nebula, const GivenAxis& given = {}) {
    Found found;
    const Image clean = seen(nebula, 0.0);
    const float exposure = 0.9f / brightest(clean);
    found.picture = telescopes(times(clean, exposure));
    for (int i = 0; i < 2; ++i) found.truth[i] = times(seen(nebula, aside_deg[i]), exposure);
    found.fit = fit_axis(found.picture, given);
    return found;
}

/// The picture's light at its depths, as if nothing hid anything.
Image from_aside(const Image& picture, const AxisDepths& depths, double degrees) {
    constexpr int splats = 32;  // of a pixel
    const double c = std::cos(real::radians(degrees)), s = std::sin(real::radians(degrees));
    Image image = make_image(picture.width, picture.height, 3);
    for (std::int64_t y = 0; y < picture.height; ++y)
        for (std::int64_t x = 0; x < picture.width; ++x)
            for (int k = 0; k < splats; ++k) {
                const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
                const double jitter = painted::random(static_cast<std::uint32_t>(y * painted_width + x), 20u);
                const float z = depths.depth(px, py, static_cast<float>((k + jitter) / splats));
                const glm::vec3 tint = depths.tint(px, py, z);
                const double at = (px - body_x * painted_width) * c - static_cast<double>(z) * s +
                                  body_x * painted_width - 0.5;
                const auto left = static_cast<std::int64_t>(std::floor(at));
                const auto part = static_cast<float>(at - std::floor(at));
                for (int i = 0; i < 3; ++i) {
                    const float light = picture.at(x, y)[i] * tint[i] / splats;
                    if (left >= 0 && left < painted_width) image.at(left, y)[i] += light * (1.0f - part);
                    if (left + 1 >= 0 && left + 1 < painted_width) image.at(left + 1, y)[i] += light * part;
                }
            }
    return image;
}

double srgb(float light) {
    const double v = std::clamp(static_cast<double>(light), 0.0, 1.0);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
}

double psnr_db(const Image& a, const Image& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        sum += std::pow(srgb(a.pixels[i]) - srgb(b.pixels[i]), 2.0);
    return -10.0 * std::log10(sum / static_cast<double>(a.pixels.size()));
}

double turn_between(double a_deg, double b_deg) { return std::fabs(std::remainder(a_deg - b_deg, 180.0)); }

struct AxisCase {
    const char* name;
    Nebula nebula;
    bool tilt_shows;
};

void PrintTo(const AxisCase& one, std::ostream* out) { *out << one.name; }

class PaintedNebula : public testing::TestWithParam<AxisCase> {};

TEST_P(PaintedNebula, HasItsAxisItsTiltAndItsOtherSides) {
    const auto& [name, nebula, tilt_shows] = GetParam();
    const Found f = found(nebula);
    EXPECT_LE(turn_between(real::degrees(f.fit.angle), nebula.angle_deg), 2.0) << real::degrees(f.fit.angle);
    EXPECT_NEAR(f.fit.x, body_x, 0.01);
    EXPECT_NEAR(f.fit.y, body_y, 0.01);
    EXPECT_GT(f.fit.explained, 0.9);
    EXPECT_GT(f.fit.alike, 0.85);
    EXPECT_TRUE(is_about_axis(f.fit));
    EXPECT_LE(f.fit.tilt_from_deg, f.fit.tilt_deg);
    EXPECT_GE(f.fit.tilt_to_deg, f.fit.tilt_deg);
    if (!tilt_shows) {
        EXPECT_FALSE(f.fit.tilt_is_sure());
        EXPECT_LE(f.fit.tilt_deg, 30.0);
        return;
    }
    EXPECT_NEAR(f.fit.tilt_deg, nebula.tilt_deg, 10.0);
    const AxisDepths depths = make_axis_depths(f.fit, f.picture);
    for (int i = 0; i < 2; ++i)
        EXPECT_GE(psnr_db(from_aside(f.picture, depths, aside_deg[i]), f.truth[i]), 28.0) << aside_deg[i];
}

INSTANTIATE_TEST_SUITE_P(AxisFit, PaintedNebula,
                         testing::Values(AxisCase{"ring", {ring(0.2), 71.0, 30.0}, true},
                                         AxisCase{"lobes", {lobes(0.26), 112.0, 40.0}, true},
                                         AxisCase{"upright_lobes", {lobes(0.26), 90.0, 5.0}, true},
                                         AxisCase{"shell", {shell(0.22, 0.15), 37.0, 20.0}, false}),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(AxisFit, WhatIsGivenIsTaken) {
    const Image picture = seen({shell(0.2, 0.15), 30.0, 0.0}, 0.0);
    const AxisFit fit = fit_axis(picture, {real::radians(30.0), -25.0});
    EXPECT_DOUBLE_EQ(fit.angle, real::radians(30.0));
    EXPECT_EQ(fit.tilt_deg, -25.0);
    EXPECT_TRUE(fit.tilt_is_sure());
    EXPECT_GT(fit.explained, 0.9);
}

/// Clouds without any symmetry: so many, of sigmas so large in px.
Image clouds(std::uint32_t count, double least, double most, std::uint32_t seed) {
    Image picture = make_image(painted_width, painted_height, 3);
    for (std::uint32_t i = 0; i < count; ++i) {
        const double part = painted::random(i, seed + 3), size = std::lerp(least, most, part * part * part);
        painted::add_point(picture, painted_width * painted::random(i, seed + 1),
                           painted_height * painted::random(i, seed + 2), size, 10.0 / size, 8.0 / size,
                           6.0 / size);
    }
    return picture;
}

// Of few clouds rings are too little. Many that fill the frame they nearly are, as of anything smooth; but
// their sides are not alike.
TEST(AxisFit, TakesNoCloudsForABody) {
    for (std::uint32_t seed = 10; seed < 50; seed += 10) {
        const AxisFit few = fit_axis(clouds(12, 4.0, 5.0, seed)),
                      many = fit_axis(clouds(300, 3.0, 30.0, seed));
        EXPECT_FALSE(is_about_axis(few)) << few.explained << ' ' << few.alike;
        EXPECT_FALSE(is_about_axis(many)) << many.explained << ' ' << many.alike;
        EXPECT_GT(many.explained, 0.75);
        EXPECT_LT(many.alike, 0.4);
    }
}

TEST(AxisFit, OfNoLightIsStillAFit) {
    const AxisFit fit = fit_axis(make_image(40, 30, 3));
    EXPECT_TRUE(std::isfinite(fit.angle) && std::isfinite(fit.tilt_deg) && std::isfinite(fit.explained));
}

TEST(AxisDepths, GrowAndKeepTheColourOfTheirLine) {
    // Blue inside, red outside.
    Image picture = times(seen({shell(0.2, 0.16), 60.0, 0.0}, 0.0), 1.0f);
    const Image inner = seen({shell(0.1, 0.08), 60.0, 0.0}, 0.0);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = i % 3 == 2 ? inner.pixels[i] : picture.pixels[i];
    const AxisDepths depths = make_axis_depths(fit_axis(picture), picture);
    const auto x = static_cast<float>(body_x * painted_width), y = static_cast<float>(body_y * painted_width);
    constexpr int shares = 200;
    glm::vec3 mean(0.0f);
    float before = -1e9f;
    for (int k = 0; k < shares; ++k) {
        const float z = depths.depth(x, y, (static_cast<float>(k) + 0.5f) / shares);
        EXPECT_GE(z, before);
        before = z;
        mean += depths.tint(x, y, z) / static_cast<float>(shares);
    }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], 1.0f, 0.12f) << c;
    const glm::vec3 wall = depths.tint(x, y, 0.16f * painted_width),
                    core = depths.tint(x, y, 0.08f * painted_width);
    EXPECT_GT(wall.x / wall.z, 3.0f * core.x / core.z);
    EXPECT_NEAR(depths.depth(x, y, 0.5f), 0.0f, 0.02f * painted_width);
    EXPECT_LT(depths.residue_at(x, y), 0.1f);
}

}  // namespace
}  // namespace astrosplat
