// The same bits for any number of threads, tile size, instruction set, memory limit, region, and with the C
// library's FMA variants out of reach (the command-line tests do that one).
#include <gtest/gtest.h>

#include "core/rotation.h"
#include "core/shared_maths.h"
#include "unit/render/scenes.h"

namespace astrosplat {
namespace {

using namespace astrosplat::test;

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
    ShadedSplats sets[6] = {cloud(4000, 1), cloud(3000, 2), cloud(2000, 3),
                            cloud(1000, 4), cloud(500, 5),  cloud(800, 6)};
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
                        settings_of(width_px, height_px), 200000, {37, 21, 90, 71});
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

}  // namespace
}  // namespace astrosplat
