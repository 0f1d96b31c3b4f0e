// Level of detail: the light of a splat equals that of its children, at every level and every stage of the
// fade.
#include "render/lod.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/real.h"
#include "core/shared_maths.h"
#include "support/printing.h"
#include "unit/render/scenes.h"

namespace astrosplat {
namespace {

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

// 200 parents, each alone on black (far apart), as the limit moves through every stage of the fade and
// several levels.
TEST_P(LodLight, OfTwoHundredParentsIsKept) {
    const LodCase& test = GetParam();
    const float radius = 24.0f;
    const ShadedSplats one = make_splats({{{0.0f, 0.0f, 0.0f}, radius, test.alpha, {0.9f, 0.5f, 0.2f}}});
    const auto light_of = [&](float limit_px, std::uint64_t id, RenderCache& cache) {
        ShadedSplats splats = one;
        splats.id[0] = id;
        RenderLayer layer = layer_of("one", splats, test.blend, test.shape);
        layer.axis = {0.0, 0.6, 0.8};
        layer.render.lod.max_px = limit_px * 1080.0f / 72.0f;  // the limit is for 1080 lines
        const Image image =
            render({&layer, 1}, pixel_camera(72, 72), nullptr, settings_of(72, 72), {}, &cache).beauty;
        return glm::dvec3(total(image, 0), total(image, 1), total(image, 2));
    };
    RenderCache cache;
    const glm::dvec3 expected = light_of(0.0f, 0, cache);
    for (const float size : {1.02f, 1.1f, 1.2f, 1.3f, 1.4f, 1.5f, 1.9f, 2.1f, 2.5f, 3.0f, 4.3f, 5.2f, 7.9f}) {
        glm::dvec3 mean(0.0);
        for (std::uint64_t id = 0; id < 200; ++id) mean += light_of(2.0f * radius / size, id, cache) / 200.0;
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(mean[k] / expected[k], 1.0, 0.01)
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

}  // namespace
}  // namespace astrosplat
