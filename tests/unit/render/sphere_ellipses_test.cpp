// Many splats that are not round, onto the sphere, all around the eye: the same bits for every tile size,
// number of threads, region and instruction set, those of round splats beside them, and no seam.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <vector>

#include "core/real.h"
#include "core/rotation.h"
#include "core/shared_maths.h"
#include "unit/render/sphere_scenes.h"

namespace astrosplat {
namespace {

using namespace astrosplat::test;

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
                        settings_of(wide_px, high_px), 100000, {401, 10, 111, 200});
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

// The seam of one is in the middle of the other.
TEST(SphereEllipses, HasNoSeam) {
    const EllipsesAround scene(Blend::over, Falloff::Shape::gaussian);
    for (const Projection projection : {Projection::equirectangular, Projection::cylindrical}) {
        CameraParams params = params_of(projection);
        const Image ahead = scene.picture(make_camera(params, wide_px, high_px, {}));
        params.target = {0.0, 0.0, 1.0};
        const Image behind = scene.picture(make_camera(params, wide_px, high_px, {}));
        double worst = 0.0;
        for (std::int64_t y = 0; y < high_px; ++y)
            for (std::int64_t x = 0; x < wide_px; ++x)
                for (int k = 0; k < 4; ++k)
                    worst = std::max(worst, std::fabs(double(ahead.at(x, y)[k]) -
                                                      double(behind.at((x + wide_px / 2) % wide_px, y)[k])));
        EXPECT_LT(worst, 0.012) << name_of(projection);
    }
}

}  // namespace
}  // namespace astrosplat
