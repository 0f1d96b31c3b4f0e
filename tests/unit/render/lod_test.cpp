// Level of detail, and the structure of children.
#include "render/lod.h"

#include "camera/camera.h"
#include "render/shared_render.h"
#include "splats/splat_set.h"
#include "support/printing.h"
#include "support/test.h"
#include "unit/render/scenes.h"

namespace astrosplat {
namespace {

// Level of detail: the light of a splat equals that of its children, at every level and every stage
// of the fade.

using namespace astrosplat::test;

TEST(ChooseLevels, SmallestCountThatGetsTheChildrenUnderTheLimit) {
    EXPECT_EQ(choose_levels(10.0f, 0.0f, 4096).fine, 0);
    EXPECT_EQ(choose_levels(10.0f, 10.0f, 4096).fine, 0);
    for (const float diameter : {10.1f, 19.9f, 20.1f, 39.0f, 41.0f, 75.0f, 90.0f, 159.0f, 200.0f, 300.0f}) {
        const LevelChoice choice = choose_levels(diameter, 10.0f, 4096);
        EXPECT_LE(diameter * shared::child_radius_scale(choice.fine), 10.0f) << diameter;
        EXPECT_GT(diameter * shared::child_radius_scale(choice.fine - 1), 10.0f) << diameter;
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
    shared::ChildTables tables(table.numbers());
    glm::vec3 mean(0.0f);
    for (std::uint32_t i = 0; i < 4000; ++i) {
        const glm::vec3 p = tables.child_offset(3, i % 64, 5, i / 64, 0);
        EXPECT_LE(std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z), 1.0f - 0.125f + 1e-6f);
        EXPECT_EQ(p, tables.child_offset(3, i % 64, 5, i / 64, 0));
        mean += p / 4000.0f;
    }
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], 0.0f, 0.025f);
}

/// The defining equation with centres drawn by chance in place of their density: where N children of alpha
/// alone cover a point with weight q on average, the light is Integral[1 - (1 - alpha q)^N].
TEST(Children, AloneHaveTheLightOfTheirParent) {
    constexpr int level = 2, places = 500, steps = 60;
    const auto children = double(children_of_level(level));
    for (const Falloff::Shape shape : {Falloff::Shape::linear, Falloff::Shape::gaussian}) {
        const Falloff falloff{shape, 0.5f, 4.5f};
        LodTable table(falloff);
        table.prepare(level);
        shared::ChildTables tables(table.numbers());
        std::vector<double> weight(steps, 0.0);
        for (std::uint32_t id = 0; id < places; ++id)
            for (std::uint32_t child = 0; child < children_of_level(level); ++child) {
                const glm::vec3 p = tables.child_offset(level, child, 3, id, 0);
                for (int i = 0; i < steps; ++i) {
                    const double t = 1.5 * (i + 0.5) / steps, r = shared::child_radius_scale(level);
                    weight[std::size_t(i)] +=
                        falloff_value(falloff, std::hypot(p.x - t, double(p.y)) / r) / (places * children);
                }
            }
        for (const float alpha : {0.1f, 0.6f, 1.0f}) {
            const shared::ChildAlphas found = tables.child_alphas({level - 1, level, 1.0f}, alpha);
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
    for (std::size_t i = 0; i < image.pixels.size(); i += std::size_t(image.channels))
        sum += double(image.pixels[i]);
    return sum;
}

float brightest_of(const Image& image) { return *std::max_element(image.pixels.begin(), image.pixels.end()); }

TEST(NearStar, ItsSizeGoesFromThatOfASplatToAPoints) {
    EXPECT_EQ(near_star_size(1.0f), 1.0f);
    EXPECT_FLOAT_EQ(near_star_size(0.5f), std::pow(0.5f, 0.75f));
    EXPECT_EQ(near_star_size(1e-6f), 1.0f / std::sqrt(brightest_near_star));
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

// Structure of children: its mean over space, its bounds, what it depends on, and that it keeps the light of
// their parents.

/// A point of a cube of 1000 units around the origin.
glm::vec3 random_point(std::uint32_t i) {
    const auto uniform = [i](std::uint32_t k) { return shared::as_uniform(shared::as_hash(1, i, k, 900)); };
    return 1000.0f * glm::vec3(uniform(0), uniform(1), uniform(2)) - 500.0f;
}

struct FieldStatistics {
    double mean = 0.0, deviation_of_log = 0.0, largest = 0.0;
};

FieldStatistics statistics_of(const ChildNoise& noise) {
    constexpr std::uint32_t points = 200'000;
    FieldStatistics found;
    double sum_of_log = 0.0, square_of_log = 0.0;
    for (std::uint32_t i = 0; i < points; ++i) {
        const double light = child_light(noise, random_point(i));
        found.mean += light / points;
        sum_of_log += std::log(light) / points;
        square_of_log += std::log(light) * std::log(light) / points;
        found.largest = std::max(found.largest, light);
    }
    found.deviation_of_log = std::sqrt(square_of_log - sum_of_log * sum_of_log);
    return found;
}

TEST(ChildNoise, IsOneOnAverageAtEveryStrengthLevelAndSize) {
    for (const float strength : {0.75f, 1.5f, 2.0f})
        for (const int level : {2, 3, 6})
            for (const float radius : {1.0f, 0.013f}) {
                const FieldStatistics found = statistics_of(make_child_noise(strength, radius, level, 7));
                EXPECT_NEAR(found.mean, 1.0, 0.01) << strength << " level " << level << " radius " << radius;
                EXPECT_LE(found.largest, largest_child_light(strength));
                EXPECT_GE(found.largest, 1.5 * std::min(1.0f, strength));
            }
}

TEST(ChildNoise, GrowsTowardsItsStrengthAsChildrenBecomeSmaller) {
    double before = 0.0;
    for (const int level : {2, 3, 4, 6, 8}) {
        const double deviation = statistics_of(make_child_noise(0.8f, 1.0f, level, 7)).deviation_of_log;
        EXPECT_GT(deviation, before) << level;
        before = deviation;
    }
    EXPECT_NEAR(before, 0.8, 0.04);
}

TEST(ChildNoise, LevelNoughtAndStrengthNoughtHaveNone) {
    EXPECT_EQ(make_child_noise(1.0f, 1.0f, 0, 7).count, 0);
    EXPECT_EQ(make_child_noise(0.0f, 1.0f, 4, 7).count, 0);
}

/// The next level adds octaves and keeps the wider ones as they are.
TEST(ChildNoise, FinerLevelsRefineTheField) {
    const ChildNoise coarse = make_child_noise(0.75f, 1.0f, 4, 7), fine = make_child_noise(0.75f, 1.0f, 5, 7);
    ASSERT_EQ(fine.count, coarse.count + 1);
    for (int i = 0; i + 1 < coarse.count; ++i) {
        EXPECT_EQ(fine.octaves[i].amplitude, coarse.octaves[i].amplitude);
        EXPECT_EQ(fine.octaves[i].frequency, coarse.octaves[i].frequency);
        EXPECT_EQ(fine.octaves[i].seed, coarse.octaves[i].seed);
    }
}

/// Radii may be animated: the field of a splat that grows changes without steps,
/// also where an octave comes in.
TEST(ChildNoise, ChangesSmoothlyWithTheRadius) {
    const auto field = [](float radius, std::uint32_t i) {
        return child_light(make_child_noise(1.0f, radius, 4, 7), 0.01f * random_point(i));
    };
    for (float radius = 0.4f; radius < 1.7f; radius *= 1.01f) {
        double change = 0.0;
        for (std::uint32_t i = 0; i < 200; ++i)
            change =
                std::max(change, std::fabs(std::log(double(field(1.01f * radius, i) / field(radius, i)))));
        EXPECT_LT(change, 0.08) << radius;
    }
}

TEST(ChildNoise, PlacesFarOutOfAnyCellsRangeHaveSomeLight) {
    const float light = child_light(make_child_noise(1.0f, 1e-12f, 4, 7), {1e20f, -1e20f, 3.0f});
    EXPECT_GT(light, 0.0f);
    EXPECT_LE(light, largest_child_light(1.0f));
}

constexpr int parents_wide = 70, cell_px = 14, grid_px = parents_wide * cell_px;
constexpr float limit_px = 4.0f;  // at the picture's height

/// A grid of splats that do not touch each other, of `diameter_px`.
ShadedSplats grid_of_parents(float diameter_px, float alpha) {
    std::vector<OneSplat> specs;
    for (int y = 0; y < parents_wide; ++y)
        for (int x = 0; x < parents_wide; ++x)
            specs.push_back({{cell_px * (float(x) + 0.5f) - 0.5f * grid_px,
                              cell_px * (float(y) + 0.5f) - 0.5f * grid_px, 0.0f},
                             0.5f * diameter_px,
                             alpha,
                             {0.9f, 0.5f, 0.2f}});
    return make_splats(specs);
}

glm::dvec3 light_of(const ShadedSplats& splats, Blend blend, float noise) {
    RenderLayer layer = layer_of("parents", splats, blend, Falloff::Shape::gaussian);
    layer.axis = {0.0, 0.6, 0.8};
    layer.render.lod.max_px = limit_px * 1080.0f / grid_px;
    layer.render.lod.noise = noise;
    const Image image =
        render({&layer, 1}, pixel_camera(grid_px, grid_px), nullptr, settings_of(grid_px, grid_px)).beauty;
    return {total(image, 0), total(image, 1), total(image, 2)};
}

/// In the middle of a fade and between fades.
TEST(ChildNoise, KeepsTheLightOfFiveThousandParents) {
    for (const Blend blend : {Blend::over, Blend::add, Blend::screen, Blend::hybrid})
        for (const float alpha : {0.2f, 0.8f})
            for (const float diameter_px : {4.9f, 10.0f}) {
                const ShadedSplats parents = grid_of_parents(diameter_px, alpha);
                const glm::dvec3 plain = light_of(parents, blend, 0.0f),
                                 found = light_of(parents, blend, 0.75f);
                for (int k = 0; k < 3; ++k)
                    EXPECT_NEAR(found[k] / plain[k], 1.0, 0.01)
                        << name_of(blend) << " alpha " << alpha << " " << diameter_px << " px, channel " << k;
            }
}

/// Dust before a white sheet: a splat's colour below 0 is its exponents, which its children's noise varies.
TEST(ChildNoise, DustGetsHalfOfItAndTakesAwayAsMuch) {
    ShadedSplats dust = grid_of_parents(10.0f, 0.6f);
    for (glm::vec3& color : dust.color) color = {-0.8f, -1.0f, -1.35f};
    const ShadedSplats sheet = make_splats({{{0.0f, 0.0f, -50.0f}, 1000.0f, 1.0f, glm::vec3(1.0f)}});
    RenderLayer layers[] = {layer_of("sheet", sheet),
                            layer_of("dust", dust, Blend::over, Falloff::Shape::gaussian)};
    layers[1].absorbs = true;
    layers[1].render.lod.max_px = limit_px * 1080.0f / grid_px;
    const auto picture = [&](float noise) {
        layers[1].render.lod.noise = noise;
        return render(layers, pixel_camera(grid_px, grid_px), nullptr, settings_of(grid_px, grid_px)).beauty;
    };
    const Image plain = picture(0.0f), found = picture(0.75f);
    for (int k = 0; k < 3; ++k) {
        const double white = double(grid_px) * grid_px;
        EXPECT_NEAR((white - total(found, k)) / (white - total(plain, k)), 1.0, 0.01) << k;
    }
    double change = 0.0;
    for (std::size_t i = 0; i < plain.pixels.size(); ++i)
        change += std::fabs(double(found.pixels[i]) - double(plain.pixels[i]));
    const double taken = 3.0 * grid_px * grid_px - total(plain, 0) - total(plain, 1) - total(plain, 2);
    EXPECT_GT(change / taken, 0.05);
    EXPECT_LT(change / taken, 0.25);
}

TEST(ChildNoise, StarsOfPicturesStayWhole) {
    ShadedSplats star = make_splats({{{0.0f, 0.0f, 0.0f}, 20.0f, 0.7f, {1.0f, 0.8f, 0.6f}}});
    const auto picture = [&](std::uint64_t id, float max_px, float noise) {
        star.id[0] = id;
        RenderLayer layer = layer_of("star", star, Blend::over, Falloff::Shape::gaussian);
        layer.render.lod.max_px = max_px;
        layer.render.lod.noise = noise;
        return render({&layer, 1}, pixel_camera(64, 64), nullptr, settings_of(64, 64)).beauty.pixels;
    };
    const std::uint64_t id = std::uint64_t{3} << 56 | star_band << 48 | 12;
    const auto whole = picture(id, 0.0f, 0.0f);
    EXPECT_EQ(picture(id, 10.0f, 0.75f), whole);
    EXPECT_NE(picture(id, 10.0f, 0.0f), whole);
    EXPECT_NE(picture(7, 10.0f, 0.75f), whole);
}

/// A cluster of splats of many sizes, each of them fuzz from afar.
ShadedSplats knot() {
    std::vector<OneSplat> specs;
    for (std::uint32_t i = 0; i < 500; ++i) {
        const glm::vec3 p = random_point(i) / 500.0f;
        const float size = shared::as_uniform(shared::as_hash(2, i, 0, 900));
        specs.push_back({p * dot(p, p), 0.1f + 0.4f * size * size, 0.08f, {1.5f, 0.9f, 0.5f}});
    }
    return make_splats(specs);
}

/// mean |f_t - f_(t-1)| along a flight at constant speed: no frame changes more than its neighbours do.
TEST(ChildNoise, AFlightIntoAKnotHasNeitherFlickerNorPops) {
    constexpr int frames = 24, width = 160, height = 90;
    const ShadedSplats splats = knot();
    RenderLayer layer = layer_of("knot", splats, Blend::over, Falloff::Shape::gaussian);
    layer.render.lod.max_px = 120.0f;
    layer.render.lod.noise = 0.75f;
    Image before;
    std::vector<double> change;
    RenderCache cache;
    for (int t = 0; t < frames; ++t) {
        CameraParams params;
        params.position = glm::dvec3(0.3, 0.2, 2.4 - 0.06 * t);
        params.fov = 40.0;
        Image now = render({&layer, 1}, make_camera(params, width, height, {}), nullptr,
                           settings_of(width, height), {}, &cache)
                        .beauty;
        double sum = 0.0;
        for (std::size_t i = 0; t > 0 && i < now.pixels.size(); ++i)
            sum += std::fabs(double(now.pixels[i]) - double(before.pixels[i]));
        if (t > 0) change.push_back(sum);
        before = std::move(now);
    }
    for (std::size_t t = 1; t + 1 < change.size(); ++t)
        EXPECT_LE(change[t], 1.05 * 0.5 * (change[t - 1] + change[t + 1])) << "frame " << t + 1;
}

// Of many splats some split at any time, and each alone is hardly seen: one splat shows how.
TEST(ChildNoise, ASplatBecomesItsChildrenLittleByLittle) {
    constexpr int frames = 48, side = 120;
    const ShadedSplats splats = make_splats({{glm::vec3(0.0f), 0.5f, 0.3f, {1.5f, 0.9f, 0.5f}}});
    RenderLayer layer = layer_of("splat", splats, Blend::over, Falloff::Shape::gaussian);
    layer.render.lod.max_px = 300.0f;  // at 1080 lines
    layer.render.lod.noise = 0.75f;
    const auto view = [&](int t) {
        CameraParams params;
        params.projection = Projection::orthographic;
        params.position = glm::dvec3(0.0, 0.0, 5.0);
        params.height = 4.5 * std::pow(0.975, t);
        return render({&layer, 1}, make_camera(params, side, side, {}), nullptr, settings_of(side, side), {})
            .beauty;
    };
    std::vector<double> change;
    Image before = view(0);
    for (int t = 1; t < frames; ++t) {
        Image now = view(t);
        double sum = 0.0;
        for (std::size_t i = 0; i < now.pixels.size(); ++i)
            sum += std::fabs(double(now.pixels[i]) - double(before.pixels[i]));
        change.push_back(sum);
        before = std::move(now);
    }
    for (std::size_t t = 1; t + 1 < change.size(); ++t)
        EXPECT_LE(change[t], 1.5 * 0.5 * (change[t - 1] + change[t + 1])) << "frame " << t + 1;
}

}  // namespace
}  // namespace astrosplat
