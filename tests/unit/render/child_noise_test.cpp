// Structure of children: its mean over space, its bounds, what it depends on, and that it keeps the light of
// their parents.
#include "render/lod.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "camera/camera.h"
#include "core/shared_maths.h"
#include "splats/splat_set.h"
#include "unit/render/scenes.h"

namespace astrosplat {
namespace {

using namespace astrosplat::test;

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

/// Radii may be animated: the field of a splat that grows changes without steps, also where an octave comes
/// in.
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

constexpr int parents_wide = 70, cell_px = 14, side_px = parents_wide * cell_px;
constexpr float limit_px = 4.0f;  // at the picture's height

/// A grid of splats that do not touch each other, of `diameter_px`.
ShadedSplats grid_of_parents(float diameter_px, float alpha) {
    std::vector<OneSplat> specs;
    for (int y = 0; y < parents_wide; ++y)
        for (int x = 0; x < parents_wide; ++x)
            specs.push_back({{cell_px * (float(x) + 0.5f) - 0.5f * side_px,
                              cell_px * (float(y) + 0.5f) - 0.5f * side_px, 0.0f},
                             0.5f * diameter_px,
                             alpha,
                             {0.9f, 0.5f, 0.2f}});
    return make_splats(specs);
}

glm::dvec3 light_of(const ShadedSplats& splats, Blend blend, float noise) {
    RenderLayer layer = layer_of("parents", splats, blend, Falloff::Shape::gaussian);
    layer.axis = {0.0, 0.6, 0.8};
    layer.render.lod.max_px = limit_px * 1080.0f / side_px;
    layer.render.lod.noise = noise;
    const Image image =
        render({&layer, 1}, pixel_camera(side_px, side_px), nullptr, settings_of(side_px, side_px)).beauty;
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
    layers[1].render.lod.max_px = limit_px * 1080.0f / side_px;
    const auto picture = [&](float noise) {
        layers[1].render.lod.noise = noise;
        return render(layers, pixel_camera(side_px, side_px), nullptr, settings_of(side_px, side_px)).beauty;
    };
    const Image plain = picture(0.0f), found = picture(0.75f);
    for (int k = 0; k < 3; ++k) {
        const double white = double(side_px) * side_px;
        EXPECT_NEAR((white - total(found, k)) / (white - total(plain, k)), 1.0, 0.01) << k;
    }
    double change = 0.0;
    for (std::size_t i = 0; i < plain.pixels.size(); ++i)
        change += std::fabs(double(found.pixels[i]) - double(plain.pixels[i]));
    const double taken = 3.0 * side_px * side_px - total(plain, 0) - total(plain, 1) - total(plain, 2);
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
