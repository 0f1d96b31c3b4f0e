// The preview's picture at full count against the offline renderer's.
#include "gl/preview.h"

#include <gtest/gtest.h>

#include "gl/gl_fixture.h"
#include "gl/picture_scenes.h"

namespace astrosplat {
namespace {

using testing::GlTest;

constexpr int width = 320, height = 200;

class PreviewPicture : public GlTest {
  protected:
    Image draw(const std::vector<PreviewLayer>& layers, const Camera& camera,
               const Environment* environment = nullptr) {
        GlPreview preview;
        preview.draw(layers, camera, environment, width, height, 0.5f);
        preview.wait_for_order();
        preview.draw(layers, camera, environment, width, height, 0.5f);
        EXPECT_FALSE(preview.sorting());
        return preview.read();
    }

    void expect_like_offline(const std::vector<PreviewLayer>& layers, const Camera& camera,
                             const Environment* environment = nullptr) {
        const Image offline = testing::offline(layers, camera, environment, width, height);
        const testing::Likeness likeness = testing::compare_shown(draw(layers, camera, environment), offline);
        EXPECT_GE(likeness.psnr_db, 45.0);
        EXPECT_LE(likeness.difference_999, 1.0 / 255.0);
        EXPECT_NEAR(likeness.brightness, 1.0, 2e-3);
        RecordProperty("psnr_db", std::to_string(likeness.psnr_db));
        if (::testing::Test::HasFailure() || std::getenv("ASTROSPLAT_PRINT_LIKENESS"))
            std::printf("psnr %.1f dB, 99.9%% %.2f/255, brightness %.5f\n", likeness.psnr_db,
                        likeness.difference_999 * 255.0, likeness.brightness);
    }
};

LayerRender render_with(Falloff::Shape shape, Blend blend = Blend::over) {
    LayerRender render;
    render.falloff.shape = shape;
    render.blend = blend;
    return render;
}

TEST_F(PreviewPicture, EveryFalloff) {
    for (const auto shape : {Falloff::Shape::constant, Falloff::Shape::linear, Falloff::Shape::trapezoid,
                             Falloff::Shape::gaussian, Falloff::Shape::exponential}) {
        SCOPED_TRACE(static_cast<int>(shape));
        for (float radius : {0.004f, 0.03f, 0.15f})
            expect_like_offline({testing::cloud_layer(3000, 5, radius, render_with(shape))},
                                testing::perspective_camera(width, height));
    }
}

TEST_F(PreviewPicture, EveryBlend) {
    for (const auto blend : {Blend::over, Blend::add, Blend::screen, Blend::lighten, Blend::hybrid}) {
        for (bool isolate : {false, true}) {
            SCOPED_TRACE(static_cast<int>(blend));
            LayerRender render = render_with(Falloff::Shape::gaussian, blend);
            render.isolate = isolate;
            const std::vector<PreviewLayer> layers = {
                testing::cloud_layer(1500, 9, 0.06f, render_with(Falloff::Shape::linear)),
                testing::cloud_layer(1500, 5, 0.06f, render),
                testing::cloud_layer(500, 7, 0.1f, render_with(Falloff::Shape::constant))};
            expect_like_offline(layers, testing::perspective_camera(width, height));
        }
    }
}

}  // namespace
}  // namespace astrosplat
