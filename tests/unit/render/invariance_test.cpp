// The same bits whatever shares the work, and the reference renderer's picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "core/real.h"
#include "core/rotation.h"
#include "core/shared_maths.h"
#include "render/frame.h"
#include "render/render.h"
#include "support/printing.h"
#include "support/reference_renderer.h"
#include "unit/render/scenes.h"
#include "unit/render/sphere_scenes.h"

namespace astrosplat::test {
namespace {

struct RandomScene {
    std::vector<ShadedSplats> sets;  // one a layer
    std::vector<RenderLayer> layers;
    Camera camera;
    RenderSettings settings;

    RandomScene(const RandomScene&) = delete;  // layers point to sets
    RandomScene& operator=(const RandomScene&) = delete;

    /// The same scene for the same seed on every machine: 1 to 4 layers of `splats` splats, 48x36 px.
    RandomScene(std::uint32_t seed, int splats) : random_(seed), dust_(seed + 1000) {
        const std::size_t count = 1 + random_() % 4;
        sets.resize(count);
        for (std::size_t l = 0; l < count; ++l) add_layer(l, splats);
        settings.width = 48;
        settings.height = 36;
        settings.pixel_filter = pick({0.3f, 0.5f, 1.0f});
        camera.projection = random_() % 3 == 0 ? Projection::orthographic : Projection::perspective;
        camera.eye = {between(-1, 1), between(-1, 1), 9.0};
        const glm::dvec3 back = glm::normalize(camera.eye),
                         right = glm::normalize(glm::cross({0.1, 1.0, 0.0}, back));
        camera.world_from_camera = {right, glm::cross(back, right), back};
        camera.focal_px = camera.projection == Projection::orthographic ? 6.0 : 50.0;
        camera.center_x_px = 24.0;
        camera.center_y_px = 18.0;
        camera.near = pick({0.01f, 0.01f, 8.0f});
        camera.far = pick({0.0f, 0.0f, 10.0f});
        camera.near_fade = pick({0.0f, 1.5f});
        camera.aspect = 48.0 / 36.0;
    }

  private:
    double between(double lo, double hi) {
        return lo + (hi - lo) * static_cast<double>(random_() >> 8) / 16777216.0;
    }
    float pick(const std::vector<float>& values) { return values[random_() % values.size()]; }

    void add_layer(std::size_t number, int splats) {
        ShadedSplats& set = sets[number];
        for (int i = 0; i < splats; ++i) {
            set.id.push_back(random_());
            set.position.push_back({between(-3, 3), between(-2, 2), between(-2, 2)});
            set.radius.push_back(static_cast<float>(std::exp2(between(-5, 1))));
            set.alpha.push_back(static_cast<float>(between(0.05, 1)));
            set.color.push_back({between(0, 1.5), between(0, 1.5), between(0, 1.5)});
        }
        RenderLayer& layer = layers.emplace_back();
        layer.name = "layer " + std::to_string(number);
        layer.splats = &set;
        layer.render.falloff = {static_cast<Falloff::Shape>(random_() % 5), pick({0.2f, 0.5f, 0.9f}),
                                pick({2.0f, 4.5f, 12.0f})};
        layer.render.blend = static_cast<Blend>(random_() % 5);
        layer.render.opacity = pick({1.0f, 0.6f});
        layer.render.holdout = random_() % 6 == 0;
        layer.render.isolate = random_() % 4 == 0;
        layer.scale = between(0.6, 1.2);
        const double c = std::cos(between(0, 6)), s = std::sqrt(1.0 - c * c);
        layer.world_from_layer = {glm::dvec3(c, 0, -s), glm::dvec3(0, 1, 0), glm::dvec3(s, 0, c)};
        layer.translate = {between(-0.5, 0.5), between(-0.5, 0.5), between(-0.5, 0.5)};
        layer.axis = glm::normalize(glm::dvec3(between(-1, 1), 1.0, between(-1, 1)));
        if (dust_() % 4 == 0) layer.render.blend = Blend::absorb;
        layer.render.absorb = exponents();
        layer.absorbs = layer.render.blend != Blend::lighten && dust_() % 3 == 0;
        for (std::size_t i = 0; layer.absorbs && i < set.color.size(); i += 3) set.color[i] = -exponents();
    }

    glm::vec3 exponents() {
        const auto one = [this] { return 0.2f + 1.8f * static_cast<float>(dust_() >> 8) / 16777216.0f; };
        const float r = one(), g = one();
        return {r, g, one()};
    }

    std::mt19937 random_, dust_;
};

// The same bits for any number of threads, tile size, instruction set, memory limit, region, and with the C
// library's FMA variants out of reach (the command-line tests do that one).

constexpr int width_px = 211, height_px = 133;

float random(std::uint32_t n, std::uint32_t purpose) {
    return shared::as_uniform(shared::as_hash(7u, n, 0u, purpose));
}

/// A cloud seen in perspective: sizes from far below a pixel to half the picture, many equal depths.
ShadedSplats cloud(std::uint32_t count, std::uint32_t seed) {
    std::vector<OneSplat> splats;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t n = i + seed * 1000003u;
        const float size = random(n, 5);
        OneSplat s;
        s.position = {random(n, 1) * 8.0f - 4.0f, random(n, 2) * 6.0f - 3.0f,
                      std::floor(random(n, 3) * 24.0f) / 4.0f};
        s.radius = 0.005f + 1.5f * size * size * size * size * size;
        s.alpha = random(n, 4);
        s.color = {random(n, 6) * 1.5f, random(n, 7), random(n, 8)};
        splats.push_back(s);
    }
    return make_splats(splats);
}

struct CloudScene {
    ShadedSplats sets[6] = {cloud(1000, 1), cloud(800, 2), cloud(600, 3),
                            cloud(400, 4),  cloud(300, 5), cloud(400, 6)};
    std::vector<RenderLayer> layers;
    Camera camera;

    explicit CloudScene(bool only_over = false) {
        const Blend blends[6] = {Blend::over,   Blend::add,     Blend::screen,
                                 Blend::hybrid, Blend::lighten, Blend::absorb};
        for (int i = 0; i < 6; ++i) {
            RenderLayer layer =
                layer_of("layer", sets[i], only_over ? Blend::over : blends[i], all_shapes[i % 5]);
            layer.axis = {0.3, 0.9, 0.1};
            layer.render.lod.max_px = i == 1 || i == 3 ? 40.0f : 0.0f;
            layer.render.lod.max_children = 256;
            layers.push_back(layer);
        }
        camera.eye = {0.0, 0.0, 9.0};
        camera.focal_px = 160.0;
        camera.center_x_px = width_px * 0.5;
        camera.center_y_px = height_px * 0.5;
    }

    Image picture(RenderSettings settings = settings_of(width_px, height_px)) const {
        return render(layers, camera, nullptr, settings).beauty;
    }
};

class Invariance : public ::testing::TestWithParam<bool> {};

TEST_P(Invariance, HoweverThePictureIsMade) {
    const CloudScene scene(GetParam());
    expect_same_picture([&](const RenderSettings& settings) { return scene.picture(settings); },
                        settings_of(width_px, height_px), 200000, {{37, 21, 90, 71}});
}

TEST_P(Invariance, BandsDrawTheSplatsOfTheWhole) {
    const CloudScene scene(GetParam());
    RenderSettings settings = settings_of(width_px, height_px);
    const auto drawn = [&] {
        return render(scene.layers, scene.camera, nullptr, settings).statistics.splats_drawn;
    };
    const auto whole = drawn();
    settings.memory_limit_bytes = 200000;
    EXPECT_EQ(drawn(), whole);
}

TEST_P(Invariance, CacheKeepsNothingThatShows) {
    const CloudScene scene(GetParam());
    RenderCache cache;
    const RenderSettings settings = settings_of(width_px, height_px);
    const Image first = render(scene.layers, scene.camera, nullptr, settings, {}, &cache).beauty;
    Camera moved = scene.camera;
    moved.eye.x = 2.0;
    render(scene.layers, moved, nullptr, settings, {}, &cache);
    EXPECT_EQ(first.pixels, render(scene.layers, scene.camera, nullptr, settings, {}, &cache).beauty.pixels);
}

INSTANTIATE_TEST_SUITE_P(AllBlendsAndOverAlone, Invariance, ::testing::Bool());

// Turning the camera in place changes neither order nor hybrid: a picture seen through two cameras turned
// against each other has the same light.
TEST(Camera, TurningInPlaceKeepsTheLight) {
    const ShadedSplats set = cloud(2000, 9);
    RenderLayer layer = layer_of("one", set, Blend::hybrid, Falloff::Shape::gaussian);
    Camera camera;
    camera.eye = {0.0, 0.0, 60.0};
    camera.focal_px = 800.0;
    camera.center_x_px = camera.center_y_px = 128.0;
    const Image straight = render({&layer, 1}, camera, nullptr, settings_of(256, 256)).beauty;
    camera.world_from_camera = rotation_from_degrees({0.4, -0.3, 35.0});
    const Image turned = render({&layer, 1}, camera, nullptr, settings_of(256, 256)).beauty;
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(total(turned, k) / total(straight, k), 1.0, 2e-3);
}

// The tile renderer against the reference renderer, which is the method on one page.

/// Relative to the larger of 1 and the reference.
struct Differences {
    double mean = 0.0, largest = 0.0;
    std::string place;
};

Differences differences(const Image& got, const Image& reference) {
    Differences d;
    for (std::size_t i = 0; i < got.pixels.size(); ++i) {
        const double here =
            std::fabs(got.pixels[i] - reference.pixels[i]) / std::max(1.0f, reference.pixels[i]);
        d.mean += here / static_cast<double>(got.pixels.size());
        if (here <= d.largest) continue;
        d.largest = here;
        const auto n = static_cast<std::int64_t>(i) / got.channels;
        d.place = "channel " + std::to_string(i % 4) + " of pixel " + std::to_string(n % got.width) + ", " +
                  std::to_string(n / got.width) + ": " + std::to_string(got.pixels[i]) + " instead of " +
                  std::to_string(reference.pixels[i]);
    }
    return d;
}

Environment sky() {
    auto faces = std::make_shared<EnvironmentFaces>();
    Image one = make_image(4, 2, 3);
    for (std::size_t i = 0; i < one.pixels.size(); ++i)
        one.pixels[i] = 0.1f + 0.05f * static_cast<float>(i % 7);
    faces->push_back({one});
    return {faces, glm::dmat3(1.0), 1.0f, 0.4f, 0.4f};
}

std::string describe(const RandomScene& scene) {
    std::string text;
    for (const RenderLayer& layer : scene.layers) {
        const LayerRender& r = layer.render;
        text += " | " + testing::PrintToString(r.falloff.shape) + " " + testing::PrintToString(r.blend) +
                (r.holdout ? " holdout" : "") + (r.isolate ? " isolated" : "");
    }
    return text;
}

/// Splats with a hard rim: there a table is least like what it stands for.
bool has_rims(const RandomScene& scene) {
    return std::any_of(scene.layers.begin(), scene.layers.end(), [](const RenderLayer& layer) {
        const Falloff& falloff = layer.render.falloff;
        return falloff.shape == Falloff::Shape::constant ||
               (falloff.shape == Falloff::Shape::trapezoid && falloff.core > 0.6f);
    });
}

void expect_agreement(std::uint32_t first_seed, std::uint32_t last_seed) {
    const Environment environment = sky();
    for (std::uint32_t seed = first_seed; seed <= last_seed; ++seed) {
        const RandomScene scene(seed, 10);
        const Environment* const behind = seed % 3 == 0 ? &environment : nullptr;
        const Image reference = reference_render(scene.layers, scene.camera, behind, scene.settings);
        const Image got = render(scene.layers, scene.camera, behind, scene.settings).beauty;
        const Differences d = differences(got, reference);
        EXPECT_LT(d.mean, 1e-4) << "seed " << seed << describe(scene);
        EXPECT_LT(d.largest, has_rims(scene) ? 5e-3 : 1e-3) << "seed " << seed << describe(scene) << "\n"
                                                            << d.place;
    }
}

TEST(Reference, RandomScenesAreThoseOfTheTileRenderer) { expect_agreement(1, 12); }

TEST(Reference, MoreRandomScenesAreThoseOfTheTileRendererNightly) { expect_agreement(13, 120); }

// Many splats that are not round, onto the sphere, all around the eye: the same bits for every tile size,
// number of threads, region and instruction set, those of round splats beside them, and no seam.

float drawn(std::uint32_t n, std::uint32_t purpose) {
    return shared::as_uniform(shared::as_hash(13u, n, 0u, purpose));
}

/// Ellipsoids and balls of all sizes all around the eye, some across every seam and pole.
struct EllipsesAround {
    ShadedSplats stretched, round;
    std::vector<RenderLayer> layers;

    EllipsesAround(Blend blend, Falloff::Shape shape) {
        for (ShadedSplats* set : {&stretched, &round}) {
            std::vector<OneSplat> splats;
            for (std::uint32_t i = 0; i < 700; ++i) {
                const std::uint32_t n = i + (set == &round ? 5000u : 0u);
                const double height = 2.0 * drawn(n, 1) - 1.0;
                const float size = drawn(n, 3);
                splats.push_back(
                    {glm::vec3(direction(360.0 * drawn(n, 2), real::degrees(real::asin(height)))) *
                         (2.0f + std::floor(drawn(n, 4) * 8.0f)),
                     0.01f + 1.5f * size * size * size * size,
                     drawn(n, 5),
                     {drawn(n, 6), drawn(n, 7), drawn(n, 8)}});
            }
            *set = make_splats(splats);
        }
        for (std::uint32_t i = 0; i < 700; ++i) {
            glm::mat3 stretch = glm::mat3(
                rotation_from_degrees({360.0 * drawn(i, 20), 360.0 * drawn(i, 21), 360.0 * drawn(i, 23)}));
            stretch[1] *= 0.02f + drawn(i, 22);
            stretch[2] *= 0.3f;
            stretched.stretch.push_back(stretch);
        }
        layers = {layer_of("round", round, Blend::over, Falloff::Shape::gaussian),
                  layer_of("stretched", stretched, blend, shape)};
        for (RenderLayer& layer : layers) layer.render.opacity = 0.6f;
    }
    Image picture(const Camera& camera,
                  const RenderSettings& settings = settings_of(wide_px, high_px)) const {
        return render(layers, camera, nullptr, settings).beauty;
    }
};

class SphereEllipsesBits : public ::testing::TestWithParam<Projection> {
  protected:
    EllipsesAround scene{
        GetParam() == Projection::fisheye ? Blend::screen : Blend::over,
        GetParam() == Projection::cylindrical ? Falloff::Shape::constant : Falloff::Shape::gaussian};
    Camera camera = [] {
        CameraParams params = params_of(GetParam());
        params.fisheye_fov = 240.0;
        return make_camera(params, wide_px, high_px, {});
    }();
};

TEST_P(SphereEllipsesBits, AreTheSameHoweverThePictureIsMade) {
    expect_same_picture([&](const RenderSettings& settings) { return scene.picture(camera, settings); },
                        settings_of(wide_px, high_px), 100000, {{401, 10, 111, 200}});
}

INSTANTIATE_TEST_SUITE_P(All, SphereEllipsesBits, ::testing::ValuesIn(projections));

// Black ellipsoids, too faint to hide anything, change no bit of what is round.
TEST(SphereEllipses, RoundSplatsKeepTheirBitsBesideOthers) {
    for (const Falloff::Shape shape : {Falloff::Shape::gaussian, Falloff::Shape::trapezoid}) {
        EllipsesAround scene(Blend::over, Falloff::Shape::gaussian);
        scene.layers[0].render.falloff.shape = shape;
        scene.layers[1].render.opacity = 1e-30f;
        for (glm::vec3& color : scene.stretched.color) color = glm::vec3(0.0f);
        const Camera camera = camera_of(Projection::equirectangular);
        const Image both = scene.picture(camera);
        scene.layers.pop_back();
        const Image alone = scene.picture(camera);
        for (std::size_t i = 0; i < alone.pixels.size(); i += 4)
            for (std::size_t k = i; k < i + 3; ++k) ASSERT_EQ(both.pixels[k], alone.pixels[k]) << k;
    }
}

TEST(SphereEllipses, HasNoSeam) {
    const EllipsesAround scene(Blend::over, Falloff::Shape::gaussian);
    expect_no_seam([&](const Camera& camera) { return scene.picture(camera); }, 0.012);
}

}  // namespace
}  // namespace astrosplat::test
