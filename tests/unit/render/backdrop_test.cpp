// Environments as pictures: the backdrop, and cube maps in one file.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "core/error.h"
#include "core/real.h"
#include "render/environment.h"
#include "render/render.h"
#include "support/cube_map.h"
#include "support/printing.h"
#include "support/temp_folder.h"

// fmt first: OpenImageIO's copy of it would turn exceptions off.

namespace astrosplat {
namespace {

// The backdrop against the environment's own colours: smooth pictures must agree to interpolation, across the
// seam and over the poles, and a frame with a backdrop must treat it as the environment.

/// An equirectangular picture of one level whose colours say the direction, with the border that load makes.
Environment directions(std::int64_t width) {
    const std::int64_t height = width / 2;
    Image level = make_image(width + 2, height + 2, 3);
    for (std::int64_t y = -1; y <= height; ++y)
        for (std::int64_t x = -1; x <= width; ++x) {
            const double longitude = (0.5 - (double(x) + 0.5) / double(width)) * 2.0 * real::pi;
            const double latitude = (0.5 - (double(y) + 0.5) / double(height)) * real::pi;
            const double ring = real::cos(latitude);
            const double d[3] = {ring * real::sin(longitude), real::sin(latitude),
                                 ring * real::cos(longitude)};
            for (int k = 0; k < 3; ++k) level.at(x + 1, y + 1)[k] = float(0.5 + 0.5 * d[k]);
        }
    Environment environment;
    environment.faces = std::make_shared<const EnvironmentFaces>(EnvironmentFaces{{level}});
    environment.gain = 1.5f;
    environment.largest_texel = 1.0f;
    environment.largest = 1.5f;
    return environment;
}

Camera looking(const glm::dvec3& target) {
    CameraParams params;
    params.position = {0.0, 0.0, 0.0};
    params.target = target;
    params.fov = 70.0;
    Bounds box;
    box.add({-1.0, -1.0, -1.0});
    box.add({1.0, 1.0, 1.0});
    return make_camera(params, 400.0, 240.0, box);
}

class Backdrop : public testing::TestWithParam<glm::dvec3> {};

TEST_P(Backdrop, IsWhatTheEnvironmentShows) {
    const Environment environment = directions(512);
    const Camera camera = looking(GetParam());
    Image picture;
    draw_backdrop(environment, camera, 400, 240, picture);
    ASSERT_EQ(picture.channels, 4);
    for (std::int64_t y = 0; y < 240; ++y)
        for (std::int64_t x = 0; x < 400; ++x) {
            const glm::dvec3 ray = ray_direction(camera, double(x) + 0.5, double(y) + 0.5);
            const glm::vec3 exact = sample_environment(environment, ray, 0.0);
            for (int k = 0; k < 3; ++k)
                ASSERT_NEAR(picture.at(x, y)[k], exact[k], 3e-3f) << x << " " << y << " channel " << k;
        }
}

INSTANTIATE_TEST_SUITE_P(Directions, Backdrop,
                         testing::Values(glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(0.0, 0.0, -1.0),  // the seam
                                         glm::dvec3(0.1, 1.0, 0.0), glm::dvec3(0.1, -1.0, 0.2),  // poles
                                         glm::dvec3(1.0, 0.6, -1.0)));

TEST(BackdropFrame, StandsForTheEnvironment) {
    const Environment environment = directions(256);
    const Camera camera = looking({0.3, 0.2, 1.0});
    RenderSettings settings;
    settings.width = 400;
    settings.height = 240;
    const RenderedFrame exact = render({}, camera, &environment, settings);
    Image picture;
    draw_backdrop(environment, camera, 400, 240, picture);
    settings.backdrop = &picture;
    const RenderedFrame frame = render({}, camera, nullptr, settings);
    for (std::size_t i = 0; i < frame.beauty.pixels.size(); ++i) {
        const float wanted = i % 4 == 3 ? 1.0f : picture.pixels[i];
        ASSERT_EQ(frame.beauty.pixels[i], wanted);
        ASSERT_NEAR(frame.beauty.pixels[i], exact.beauty.pixels[i], 3e-3f);
    }
}

// A cube map in one file, from the file to the colour seen along a direction.

class CubeMapFile : public testing::Test {
  protected:
    void SetUp() override {
        params_.image = folder_ / "sky.exr";
        write_cube_map(params_.image, 8, [](int, int y) { return static_cast<float>(1 + y / 8) / 8.0f; });
    }
    TempFolder folder_;
    EnvironmentParams params_;
};

TEST_F(CubeMapFile, IsAnEnvironmentOfSixFaces) {
    const Environment environment = load_environment(params_);
    ASSERT_EQ(environment.faces->size(), 6u);
    const glm::dvec3 axes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int face = 0; face < 6; ++face)
        for (const double spread : {0.0, 0.1}) {
            const glm::vec3 color = sample_environment(environment, axes[face], spread);
            EXPECT_FLOAT_EQ(color.r, static_cast<float>(1 + face) / 8.0f) << face << " " << spread;
        }
}

TEST_F(CubeMapFile, IsNotOneFaceOfSix) {
    params_.cube.assign(6, params_.image);
    params_.image.clear();
    EXPECT_THROW(load_environment(params_), InputError);
}

TEST_F(CubeMapFile, LoadingCanBeCancelled) {
    const std::atomic<bool> cancelled{true};
    EXPECT_THROW(load_environment(params_, Progress{{}, &cancelled}), Cancelled);
}

}  // namespace
}  // namespace astrosplat
