// Stars that are too wide and too bright for one Gaussian: taken whole, and in one place in depth.
#include "bodies/picture_stars.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "bodies/bodies.h"
#include "splats/splat_set.h"
#include "support/painted_picture.h"

namespace astrosplat {
namespace {

constexpr float sky_light = 0.03f;

// Stars as a camera records them: flat where they are brighter than white.
Image saturated(Image image) {
    for (float& value : image.pixels) value = std::min(value, 1.0f);
    return image;
}

Image with_star(double x, double y, double sigma) {
    Image image = make_image(320, 200, 3, sky_light);
    painted::add_point(image, x, y, sigma, 4.0, 3.0, 2.5);
    return saturated(std::move(image));
}

TEST(BrightStars, AreTakenWholeWithoutAHole) {
    struct Case {
        double x, y, sigma, half_width;
    };
    // 4 e^(-r^2 / 2 sigma^2) is .5 at sigma sqrt(2 ln 8)
    for (const Case& c : {Case{150.3, 90.7, 1.6, 3.3}, {120.6, 110.2, 3.0, 6.1}, {160.0, 100.4, 5.0, 10.2}}) {
        Image light = with_star(c.x, c.y, c.sigma);
        const Image before = light;
        const std::vector<Star> stars = take_bright_stars(light);
        ASSERT_GE(stars.size(), 1u) << c.sigma;
        double flux = 0.0, taken = 0.0;
        for (const Star& star : stars) {
            EXPECT_EQ(star.body, 0u);
            EXPECT_NEAR(star.x, c.x, 0.3);
            EXPECT_NEAR(star.y, c.y, 0.3);
            EXPECT_LT(star.sigma, 2.5 * c.half_width);
            flux += 6.2831853 * static_cast<double>(star.sigma * star.sigma * star.peak.x);
        }
        for (std::size_t i = 0; i < light.pixels.size(); i += 3) {
            taken += static_cast<double>(before.pixels[i] - light.pixels[i]);
            ASSERT_GE(light.pixels[i], 0.89f * sky_light) << "pixel " << i / 3;
            ASSERT_LE(light.pixels[i], before.pixels[i]);
        }
        EXPECT_NEAR(taken / flux, 1.0, 0.08) << c.sigma;
        double all = 0.0;
        for (std::size_t i = 0; i < light.pixels.size(); i += 3)
            all += static_cast<double>(before.pixels[i] - sky_light);
        EXPECT_GT(taken, 0.4 * all) << c.sigma;  // no sum of Gaussians has an edge so steep
    }
}

// Light of the red channel of the star there, px^2; 0 where none is.
double light_at(const std::vector<Star>& stars, float x, float y) {
    double sum = 0.0;
    for (const Star& star : stars)
        if (std::hypot(star.x - x, star.y - y) < 0.5f)
            sum += 6.2831853 * static_cast<double>(star.sigma * star.sigma * star.peak.x);
    return sum;
}

TEST(BrightStars, TheirSpikesAndNeighboursDoNotHideThem) {
    Image light = with_star(150.5, 90.5, 3.0), alone = light;
    for (std::int64_t i = -40; i <= 40; ++i)
        for (int c = 0; c < 3; ++c) {
            light.at(150 + i, 90)[c] = std::max(light.at(150 + i, 90)[c], 0.4f);
            light.at(150, 90 + i)[c] = std::max(light.at(150, 90 + i)[c], 0.4f);
        }
    for (const double angle : {0.6, 2.0, 3.9, 5.2})
        painted::add_point(light, 150.5 + 18.0 * std::cos(angle), 90.5 + 18.0 * std::sin(angle), 1.8, 2.0,
                           2.0, 2.0);
    light = saturated(std::move(light));
    const double expected = light_at(take_bright_stars(alone), 150.5f, 90.5f);
    ASSERT_GT(expected, 0.0);
    EXPECT_NEAR(light_at(take_bright_stars(light), 150.5f, 90.5f), expected, 0.1 * expected);
}

// Of knots of nebulae and star clusters, threads, faint stars, and those that take_stars() finds.
TEST(BrightStars, NothingElseIsTaken) {
    Image light = make_image(480, 200, 3, sky_light);
    for (std::uint32_t i = 0; i < 60; ++i)  // a cluster
        painted::add_point(light, 90.0 + 14.0 * (painted::random(i, 1) - 0.5),
                           100.0 + 14.0 * (painted::random(i, 2) - 0.5), 0.9, 0.5, 0.5, 0.6);
    for (int i = 0; i < 40; ++i) painted::add_point(light, 170.0 + i, 60.0, 2.5, 0.3, 0.2, 0.2);
    painted::add_point(light, 250.0, 130.0, 3.0, 0.2, 0.2, 0.2);
    painted::add_point(light, 300.0, 60.0, 1.0, 0.9, 0.9, 0.9);
    painted::add_point(light, 390.0, 100.0, 25.0, 0.9, 0.8, 0.6);  // a bulge
    const Image before = light;
    EXPECT_TRUE(take_bright_stars(light).empty());
    for (std::size_t i = 0; i < light.pixels.size(); ++i) ASSERT_EQ(light.pixels[i], before.pixels[i]);
}

// Light of a star that no Gaussian fits would be beads one above the other, seen from the side.
TEST(BrightStars, WhatTheyLeaveIsAtTheirDepth) {
    const std::int64_t width = 480, height = 300;
    Image image = painted::galaxy(width, height);
    const double x = 330.5, y = 205.5;  // where the disk is faint
    painted::add_point(image, x, y, 2.5, 4.0, 3.0, 2.5);
    image = saturated(std::move(image));
    TexturedMesh mesh;
    mesh.mesh = builtin_mesh("plane", static_cast<double>(width) / static_cast<double>(height));
    Texture texture;
    texture.image = make_image(width, height, 4, 1.0f);
    for (std::int64_t i = 0; i < width * height; ++i)
        std::copy_n(image.pixels.data() + 3 * i, 3, texture.image.pixels.data() + 4 * i);
    mesh.textures.push_back(std::move(texture));
    StructureParams params;
    params.kind = StructureKind::disk;
    const SplatSet set = make_bodies({mesh}, params, 5u, "disk");
    const double texel = 10.0 / static_cast<double>(width);
    double depth = 0.0, star = 0.0, near_light = 0.0, far_light = 0.0;
    const auto light_of = [&](std::size_t i) {
        const double r = static_cast<double>(set.radius[i]) / texel;
        return static_cast<double>(std::max(0.0f, set.color[i].x) * set.alpha[i]) * r * r;
    };
    const auto away = [&](std::size_t i) {
        return std::hypot(static_cast<double>(set.position[i].x) / texel + 0.5 * width - x,
                          static_cast<double>(set.position[i].z) / texel + 0.5 * height - y);
    };
    for (std::size_t i = 0; i < set.id.size(); ++i) {
        if (!is_star(set.id[i]) || away(i) > 1.0) continue;
        star += light_of(i);
        depth += light_of(i) * static_cast<double>(set.position[i].y);
    }
    ASSERT_GT(star, 0.0);
    depth /= star;
    for (std::size_t i = 0; i < set.id.size(); ++i) {
        if (is_star(set.id[i]) || away(i) > 3.0 || set.radius[i] > 3.0 * texel) continue;
        const bool near = std::fabs(static_cast<double>(set.position[i].y) - depth) < 6.0 * texel;
        (near ? near_light : far_light) += light_of(i);
    }
    EXPECT_GT(near_light, 0.0);
    EXPECT_LT(far_light, 0.05 * near_light);
}

}  // namespace
}  // namespace astrosplat
