// Stars of pictures close by: points that keep the light of their dots, and nothing else changes.
#include "render/lod.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "camera/camera.h"
#include "splats/splat_set.h"
#include "unit/render/scenes.h"

namespace astrosplat {
namespace {

using namespace astrosplat::test;

constexpr std::uint64_t star_number = star_band << 48 | 12;
constexpr int side_px = 96;

/// One splat at the origin, seen by a camera so far away.
struct OneDot {
    std::uint64_t id = star_number;
    float alpha = 0.01f;
    double from = 2.0;           // scene units
    float star_distance = 0.0f;  // the key
    Blend blend = Blend::over;
    Projection projection = Projection::perspective;
    LevelOfDetail lod{};
    bool absorbs = false;

    Image render() const {
        ShadedSplats dot = make_splats({{{0.0f, 0.0f, 0.0f}, 0.05f, alpha, {1.0f, 0.8f, 0.6f}}});
        dot.id[0] = id;
        RenderLayer layer = layer_of("star", dot, blend, Falloff::Shape::gaussian);
        layer.render.lod = lod;
        layer.render.lod.star_distance = star_distance;
        CameraParams params;
        params.projection = projection;
        params.position = {0.0, 0.0, from};
        params.fov = 8.0;
        params.height = 0.5;
        return astrosplat::render({&layer, 1}, make_camera(params, side_px, side_px, {}), nullptr,
                                  settings_of(side_px, side_px))
            .beauty;
    }
};

double light_of(const Image& image) {
    double sum = 0.0;
    for (std::size_t i = 0; i < image.pixels.size(); i += static_cast<std::size_t>(image.channels))
        sum += double(image.pixels[i]);
    return sum;
}

float brightest_of(const Image& image) { return *std::max_element(image.pixels.begin(), image.pixels.end()); }

TEST(NearStar, ItsSizeGoesFromThatOfADotToAPoints) {
    EXPECT_EQ(near_star_size(1.0f), 1.0f);
    EXPECT_FLOAT_EQ(near_star_size(0.5f), std::pow(0.5f, 0.75f));
    EXPECT_EQ(near_star_size(1e-6f), 0.25f);
    for (float nearness = 0.01f; nearness < 1.0f; nearness += 0.01f)
        EXPECT_LE(near_star_size(nearness), near_star_size(nearness + 0.01f));
}

TEST(NearStar, ItKeepsItsLightAndIsSharper) {
    for (const Blend blend : {Blend::over, Blend::add}) {
        OneDot star{.blend = blend};
        const Image disc = star.render();
        star.star_distance = 8.0f;
        const Image point = star.render();
        EXPECT_NEAR(light_of(point), light_of(disc), 0.005 * light_of(disc));
        // a fourth as near: an eighth as dense, but for the pixel filter
        EXPECT_GT(brightest_of(point), 6.0f * brightest_of(disc));
        EXPECT_LT(brightest_of(point), 8.0f * brightest_of(disc));
    }
}

TEST(NearStar, OnlyStarsThatAreNearChange) {
    const auto changes = [](OneDot dot, float distance) {
        const Image before = dot.render();
        dot.star_distance = distance;
        return dot.render().pixels != before.pixels;
    };
    EXPECT_TRUE(changes({}, 8.0f));
    EXPECT_FALSE(changes({}, 2.0f));
    EXPECT_FALSE(changes({.id = 12}, 8.0f));
    EXPECT_FALSE(changes({.id = dust_band << 48 | 12}, 8.0f));
    EXPECT_FALSE(changes({.projection = Projection::orthographic}, 8.0f));
    for (const Blend blend : {Blend::screen, Blend::lighten, Blend::hybrid})
        EXPECT_FALSE(changes({.blend = blend}, 8.0f));
}

TEST(NearStar, ItIsNotSplit) {
    OneDot star{.star_distance = 8.0f};
    const Image whole = star.render();
    star.lod.max_px = 8.0f;
    EXPECT_EQ(star.render().pixels, whole.pixels);
}

/// Its light is behind nothing that closes a pixel too early, however bright it is.
TEST(NearStar, ItIsSeenThroughWhatIsNearlyOpaque) {
    const ShadedSplats dots = [] {
        std::vector<OneSplat> all(30, {{0.0f, 0.0f, 1.0f}, 0.5f, 0.32f, {0.0f, 0.0f, 0.0f}});
        all.push_back({{0.0f, 0.0f, 0.0f}, 0.05f, 0.9f, {1.0f, 1.0f, 1.0f}});
        ShadedSplats made = make_splats(all);
        made.id.back() = star_number;
        return made;
    }();
    CameraParams params;
    params.position = {0.0, 0.0, 2.0};
    params.fov = 20.0;
    const Camera camera = make_camera(params, side_px, side_px, {});
    RenderLayer layer = layer_of("star", dots, Blend::over, Falloff::Shape::gaussian);
    const auto seen = [&](float star_distance) {
        layer.render.lod.star_distance = star_distance;
        return double(render({&layer, 1}, camera, nullptr, settings_of(side_px, side_px))
                          .beauty.at(side_px / 2, side_px / 2)[0]);
    };
    EXPECT_GT(seen(20.0f), 10.0 * seen(0.0f));
}

TEST(NearStar, AFlightPastItHasNoPops) {
    OneDot star{.star_distance = 3.0f};
    double before = 0.0;
    for (int t = 0; t <= 40; ++t) {
        star.from = 4.0 - 0.05 * t;  // farther and nearer than that
        const double now = double(brightest_of(star.render()));
        if (t > 0) {
            EXPECT_GT(now, 0.97 * before);
            EXPECT_LT(now, 1.08 * before);
        }
        before = now;
    }
}

}  // namespace
}  // namespace astrosplat
