// Level of detail, and stars of pictures close by.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "camera/camera.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "render/lod.h"
#include "splats/splat_set.h"
#include "support/printing.h"
#include "unit/render/scenes.h"

namespace astrosplat {
namespace {

// Level of detail: the light of a splat equals that of its children, at every level and every stage of the
// fade.

using namespace astrosplat::test;

TEST(ChooseLevels, SmallestCountThatGetsTheChildrenUnderTheLimit) {
    EXPECT_EQ(choose_levels(10.0f, 0.0f, 4096).fine, 0);
    EXPECT_EQ(choose_levels(10.0f, 10.0f, 4096).fine, 0);
    for (const float diameter : {10.1f, 19.9f, 20.1f, 39.0f, 41.0f, 75.0f, 90.0f, 159.0f, 200.0f, 300.0f}) {
        const LevelChoice choice = choose_levels(diameter, 10.0f, 4096);
        EXPECT_LE(diameter * child_radius_scale(choice.fine), 10.0f) << diameter;
        EXPECT_GT(diameter * child_radius_scale(choice.fine - 1), 10.0f) << diameter;
    }
    EXPECT_EQ(choose_levels(1e6f, 10.0f, 4096).fine, 6);
    EXPECT_EQ(choose_levels(1e6f, 10.0f, 100).fine, 3);
    EXPECT_EQ(choose_levels(1e6f, 10.0f, 8).fine, 0);  // four children would be as large as their parent
}

TEST(ChooseLevels, FadesOverAFactorOfOneAndAHalf) {
    EXPECT_NEAR(choose_levels(10.001f, 10.0f, 4096).fade, 0.0f, 1e-3f);
    EXPECT_NEAR(choose_levels(12.5f, 10.0f, 4096).fade, 0.5f, 1e-6f);
    EXPECT_EQ(choose_levels(15.0f, 10.0f, 4096).fade, 1.0f);
    EXPECT_EQ(choose_levels(25.0f, 10.0f, 4096).coarse, 2);
    EXPECT_NEAR(choose_levels(25.0f, 10.0f, 4096).fade, 0.5f, 1e-6f);
}

TEST(Children, LieInTheBallAndStayWhereTheyAre) {
    LodTable table({Falloff::Shape::gaussian, 0.5f, 4.5f});
    table.prepare(3);
    glm::vec3 mean(0.0f);
    for (std::int64_t i = 0; i < 4000; ++i) {
        const glm::vec3 p = table.child_offset(3, i % 64, 5, static_cast<std::uint64_t>(i / 64));
        EXPECT_LE(std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z), 1.0f - 0.125f + 1e-6f);
        EXPECT_EQ(p, table.child_offset(3, i % 64, 5, static_cast<std::uint64_t>(i / 64)));
        mean += p / 4000.0f;
    }
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], 0.0f, 0.025f);
}

/// The defining equation with centres drawn by chance in place of their density: where N children of alpha
/// alone cover a point with weight q on average, the light is Integral[1 - (1 - alpha q)^N].
TEST(Children, AloneHaveTheLightOfTheirParent) {
    constexpr int level = 2, places = 500, steps = 60;
    const auto children = static_cast<double>(children_of_level(level));
    for (const Falloff::Shape shape : {Falloff::Shape::linear, Falloff::Shape::gaussian}) {
        const Falloff falloff{shape, 0.5f, 4.5f};
        LodTable table(falloff);
        table.prepare(level);
        std::vector<double> weight(steps, 0.0);
        for (std::uint64_t id = 0; id < places; ++id)
            for (std::int64_t child = 0; child < children_of_level(level); ++child) {
                const glm::vec3 p = table.child_offset(level, child, 3, id);
                for (int i = 0; i < steps; ++i) {
                    const double t = 1.5 * (i + 0.5) / steps, r = child_radius_scale(level);
                    weight[std::size_t(i)] +=
                        falloff_value(falloff, std::hypot(p.x - t, double(p.y)) / r) / (places * children);
                }
            }
        for (const float alpha : {0.1f, 0.6f, 1.0f}) {
            const LodTable::Alphas found = table.alphas({level - 1, level, 1.0f}, alpha);
            EXPECT_EQ(found.coarse, 0.0f);
            double light = 0.0;
            for (int i = 0; i < steps; ++i) {
                const double t = 1.5 * (i + 0.5) / steps;
                light += 2.0 * real::pi * t * (1.5 / steps) *
                         (1.0 - std::pow(1.0 - found.fine * weight[std::size_t(i)], children));
            }
            EXPECT_NEAR(light / (alpha * falloff_integral(falloff)), 1.0, 0.02) << alpha;
        }
    }
}

struct LodCase {
    Falloff::Shape shape;
    Blend blend;
    float alpha;
    friend void PrintTo(const LodCase& given, std::ostream* out) {
        *out << testing::PrintToString(given.shape) << " " << testing::PrintToString(given.blend)
             << ", alpha " << given.alpha;
    }
};

class LodLight : public ::testing::TestWithParam<LodCase> {};

// 225 parents far apart on black, as the limit moves through every stage of the fade and several levels.
TEST_P(LodLight, OfManyParentsIsKept) {
    const LodCase& test = GetParam();
    constexpr float radius = 24.0f, cell_px = 72.0f;
    std::vector<OneSplat> parents;
    for (int n = 0; n < 225; ++n)
        parents.push_back({{cell_px * float(n % 15 - 7), cell_px * float(n / 15 - 7), 0.0f},
                           radius,
                           test.alpha,
                           {0.9f, 0.5f, 0.2f}});
    const ShadedSplats splats = make_splats(parents);
    RenderLayer layer = layer_of("parents", splats, test.blend, test.shape);
    layer.axis = {0.0, 0.6, 0.8};
    const auto light_of = [&](float limit_px) {
        layer.render.lod.max_px = limit_px;  // for 1080 lines
        const Image image =
            render({&layer, 1}, pixel_camera(1080, 1080), nullptr, settings_of(1080, 1080)).beauty;
        return glm::dvec3(total(image, 0), total(image, 1), total(image, 2));
    };
    const glm::dvec3 expected = light_of(0.0f);
    for (const float size : {1.02f, 1.1f, 1.2f, 1.3f, 1.4f, 1.5f, 1.9f, 2.1f, 2.5f, 3.0f, 4.3f, 5.2f, 7.9f}) {
        const glm::dvec3 found = light_of(2.0f * radius / size);
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(found[k] / expected[k], 1.0, 0.01)
                << "diameter over limit " << size << " channel " << k;
    }
}

INSTANTIATE_TEST_SUITE_P(All, LodLight,
                         ::testing::Values(LodCase{Falloff::Shape::gaussian, Blend::over, 0.1f},
                                           LodCase{Falloff::Shape::gaussian, Blend::over, 0.9f},
                                           LodCase{Falloff::Shape::gaussian, Blend::add, 0.5f},
                                           LodCase{Falloff::Shape::gaussian, Blend::screen, 0.8f},
                                           LodCase{Falloff::Shape::gaussian, Blend::hybrid, 0.5f},
                                           LodCase{Falloff::Shape::linear, Blend::over, 0.6f},
                                           LodCase{Falloff::Shape::exponential, Blend::over, 0.8f},
                                           LodCase{Falloff::Shape::trapezoid, Blend::over, 0.4f},
                                           LodCase{Falloff::Shape::constant, Blend::over, 0.45f}));

// Stars of pictures close by: points that keep the light of their splats, and nothing else changes.

constexpr std::uint64_t star_number = star_band << 48 | 12;
constexpr int side_px = 96;

/// One splat at the origin, seen by a camera so far away.
struct OneStar {
    std::uint64_t id = star_number;
    float alpha = 0.01f;
    double from = 2.0;           // scene units
    float star_distance = 0.0f;  // the key
    Blend blend = Blend::over;
    Projection projection = Projection::perspective;
    LevelOfDetail lod{};
    bool absorbs = false;

    Image render() const {
        ShadedSplats splat = make_splats({{{0.0f, 0.0f, 0.0f}, 0.05f, alpha, {1.0f, 0.8f, 0.6f}}});
        splat.id[0] = id;
        RenderLayer layer = layer_of("star", splat, blend, Falloff::Shape::gaussian);
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

TEST(NearStar, ItsSizeGoesFromThatOfASplatToAPoints) {
    EXPECT_EQ(near_star_size(1.0f), 1.0f);
    EXPECT_FLOAT_EQ(near_star_size(0.5f), std::pow(0.5f, 0.75f));
    EXPECT_EQ(near_star_size(1e-6f), 0.25f);
    for (float nearness = 0.01f; nearness < 1.0f; nearness += 0.01f)
        EXPECT_LE(near_star_size(nearness), near_star_size(nearness + 0.01f));
}

TEST(NearStar, ItKeepsItsLightAndIsSharper) {
    for (const Blend blend : {Blend::over, Blend::add}) {
        OneStar star{.blend = blend};
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
    const auto changes = [](OneStar star, float distance) {
        const Image before = star.render();
        star.star_distance = distance;
        return star.render().pixels != before.pixels;
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
    OneStar star{.star_distance = 8.0f};
    const Image whole = star.render();
    star.lod.max_px = 8.0f;
    EXPECT_EQ(star.render().pixels, whole.pixels);
}

/// Its light is behind nothing that closes a pixel too early, however bright it is.
TEST(NearStar, ItIsSeenThroughWhatIsNearlyOpaque) {
    const ShadedSplats splats = [] {
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
    RenderLayer layer = layer_of("star", splats, Blend::over, Falloff::Shape::gaussian);
    const auto seen = [&](float star_distance) {
        layer.render.lod.star_distance = star_distance;
        return double(render({&layer, 1}, camera, nullptr, settings_of(side_px, side_px))
                          .beauty.at(side_px / 2, side_px / 2)[0]);
    };
    EXPECT_GT(seen(20.0f), 10.0 * seen(0.0f));
}

TEST(NearStar, AFlightPastItHasNoPops) {
    OneStar star{.star_distance = 3.0f};
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
