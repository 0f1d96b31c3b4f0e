// Captures from their file to the picture: against a second renderer, seen from elsewhere, and bit by bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/color.h"
#include "core/rotation.h"
#include "pipeline.h"
#include "scene/scene.h"
#include "support/bits.h"
#include "support/ewa_reference.h"
#include "support/frames.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

using namespace astrosplat::test;

constexpr std::int64_t width = 160, height = 120;

struct CaptureScene {
    TempFolder folder;
    Scene scene;
    std::vector<Trained> all;

    explicit CaptureScene(std::vector<Trained> capture, int degree) : all(std::move(capture)) {
        folder.file("capture.ply", ply_of(all, degree));
        scene.output.width = width;
        scene.output.height = height;
        scene.camera.position = glm::dvec3(2.0, 1.5, 6.0);
        scene.camera.target = glm::dvec3(0.2, 0.1, 0.0);
        scene.camera.fov = 60.0;
        LayerParams layer;
        layer.name = "capture";
        layer.source.kind = SourceKind::splats;
        layer.source.file = folder / "capture.ply";
        layer.render.isolate = true;
        layer.render.space = BlendSpace::display;
        scene.layers.push_back(layer);
    }
    LayerParams& layer() { return scene.layers[0]; }
    Image picture() const {
        Pipeline pipeline(scene);
        return frame_of(pipeline, 1.0).beauty;
    }
    Camera camera() const {
        Pipeline pipeline(scene);
        return pipeline.camera(pipeline.frame_scene(1.0), settings_of(pipeline, 1.0));
    }
};

Image displayed(Image image) {
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        if (i % 4 != 3) image.pixels[i] = static_cast<float>(real::linear_to_srgb(image.pixels[i]));
    return image;
}

/// Of colours between 0 and 1, as a display shows them; the peak is 1.
double display_psnr_db(const Image& a, const Image& b) {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        if (i % 4 == 3) continue;
        const double d =
            std::clamp(double(a.pixels[i]), 0.0, 1.0) - std::clamp(double(b.pixels[i]), 0.0, 1.0);
        sum += d * d;
        count += 1.0;
    }
    return 10.0 * std::log10(count / sum);
}

TEST(Capture, IsWhatAnEwaRendererMakesOfIt) {
    const CaptureScene scene(capture(1000, 3), 3);
    const Image picture = displayed(scene.picture());
    const double psnr = display_psnr_db(picture, ewa_reference(scene.all, scene.camera(), width, height));
    RecordProperty("psnr_db", std::to_string(psnr));
    EXPECT_GT(psnr, 50.0);  // 40 is asked for
    EXPECT_LT(display_psnr_db(picture, displayed(make_image(width, height, 4))), 20.0) << "nothing to see";
}

// The original's 0.3 px, which let what is thin gain light: as good as the same where Gaussians span some
// pixels.
TEST(Capture, IsNearThe3dgsOriginal) {
    for (const double size : {0.25, 2.0}) {
        const CaptureScene scene(capture(400, 3, size), 3);
        const double psnr = display_psnr_db(
            displayed(scene.picture()),
            ewa_reference(scene.all, scene.camera(), width, height, {0.3, false, 1.0 / 255.0}));
        RecordProperty("psnr_db_" + std::to_string(size), std::to_string(psnr));
        EXPECT_GT(psnr, size < 1.0 ? 25.0 : 40.0) << size;
    }
}

// Dust of a fifth of a pixel: their light is what the reference has where its peaks sink, too.
TEST(Capture, KeepsTheLightOfGaussiansBelowAPixel) {
    const CaptureScene scene(capture(1500, 0, 0.02), 0);
    EXPECT_GT(
        display_psnr_db(displayed(scene.picture()), ewa_reference(scene.all, scene.camera(), width, height)),
        45.0);
}

TEST(Capture, InLinearLightIsAnotherPicture) {
    CaptureScene scene(capture(800, 1), 1);
    const Image display = scene.picture();
    scene.layer().render.space = BlendSpace::linear;
    const Image linear = scene.picture();
    EXPECT_LT(display_psnr_db(displayed(display), displayed(linear)), 40.0);
    scene.layer().render.space = BlendSpace::display;
    scene.layer().render.isolate = false;  // without which it does nothing
    EXPECT_EQ(scene.picture().pixels, linear.pixels);
}

// Alpha is what covers in display values; the light is decoded as a whole, over black.
TEST(Capture, OneGaussianIsDecodedAfterMixing) {
    Trained g;
    g.scale = glm::dvec3(1.0, 2.0, 0.5);
    g.opacity = 0.5;
    for (int k = 0; k < 3; ++k) g.harmonics[0][k] = (0.8 - 0.1 * k - 0.5) / 0.28209479177387814;
    CaptureScene scene({g}, 0);
    scene.scene.camera.position = glm::dvec3(0.0, 0.0, 10.0);
    scene.scene.camera.target = glm::dvec3(0.0);
    const Image picture = scene.picture();
    const float* middle = picture.at(width / 2, height / 2);
    EXPECT_NEAR(middle[3], 0.5, 2e-3);
    for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(middle[k], real::srgb_to_linear(0.5 * (0.8 - 0.1 * k)), 2e-3) << k;
}

// Turned, moved and doubled with its camera it looks the same: shapes and harmonics turn with the layer.
TEST(Capture, LooksTheSameFromAMovedLayer) {
    CaptureScene scene(capture(600, 3), 3);
    scene.scene.camera.near = 0.5;
    const Image before = displayed(scene.picture());
    LayerTransform& transform = scene.layer().transform;
    transform.rotate = {40.0, -70.0, 110.0};
    transform.scale = 2.0;
    transform.translate = {5.0, -3.0, 8.0};
    const glm::dmat3 turn = rotation_from_degrees(transform.rotate);
    const auto moved = [&](const glm::dvec3& p) { return 2.0 * (turn * p) + transform.translate; };
    scene.scene.camera.position = moved(*scene.scene.camera.position);
    scene.scene.camera.target = moved(scene.scene.camera.target);
    scene.scene.camera.up = turn * scene.scene.camera.up;
    scene.scene.camera.near = 1.0;
    EXPECT_GT(display_psnr_db(displayed(scene.picture()), before), 70.0);
}

TEST(Capture, ColoursFollowTheEye) {
    CaptureScene scene(capture(300, 2), 2);
    Pipeline pipeline(scene.scene);
    const RenderSettings settings = settings_of(pipeline, 1.0);
    const Image first = pipeline.frame(1.0, settings).beauty;
    Scene moved = scene.scene;
    moved.camera.position = glm::dvec3(-5.0, 1.0, 4.0);
    const auto set = std::make_shared<const SplatSet>(load_source({}, moved.layers[0].source, "capture").set);
    Pipeline other;
    other.set_scene(scene.scene, {set});
    EXPECT_EQ(other.frame(1.0, settings).beauty.pixels, first.pixels);
    other.set_scene(moved, {set});
    EXPECT_EQ(other.frame(1.0, settings).beauty.pixels, Pipeline(moved).frame(1.0, settings).beauty.pixels);
    EXPECT_NE(other.frame(1.0, settings).beauty.pixels, first.pixels);
}

TEST(Capture, DroppedSplatsTakeTheirShapesWithThem) {
    CaptureScene scene(capture(500, 0), 0);
    scene.layer().look.density = 0.4f;
    const Image thinned = scene.picture();
    Pipeline pipeline(scene.scene);
    const std::vector<RenderLayer> layers = pipeline.shaded_layers(pipeline.frame_scene(1.0));
    ASSERT_LT(layers[0].splats->size(), 300);
    ASSERT_GT(layers[0].splats->size(), 100);
    std::vector<Trained> kept;
    for (const std::uint64_t id : layers[0].splats->id) kept.push_back(scene.all[id]);
    EXPECT_GT(display_psnr_db(displayed(thinned), ewa_reference(kept, scene.camera(), width, height)), 50.0);
}

TEST(Capture, HasTheSameBitsOnThreadsTilesAndInstructionSets) {
    const CaptureScene scene(capture(700, 3), 3);
    const Image expected = scene.picture();
    test::expect_same_bits([&] { return test::Bits() << scene.picture(); });
    Pipeline pipeline(scene.scene);
    RenderSettings settings = settings_of(pipeline, 1.0);
    settings.tile_px = 16;
    EXPECT_EQ(pipeline.frame(1.0, settings).beauty.pixels, expected.pixels);
    settings.region = {40, 30, 64, 48};
    const Image part = pipeline.frame(1.0, settings).beauty;
    for (std::int64_t y = 0; y < 48; ++y)
        for (std::int64_t x = 0; x < 64; ++x)
            for (int k = 0; k < 4; ++k) ASSERT_EQ(part.at(x, y)[k], expected.at(40 + x, 30 + y)[k]);
}

// Wide and low in the middle of a dome, as it is to the eye.
TEST(Capture, KeepsItsLightAndShapeInDomes) {
    Trained g;
    g.scale = glm::dvec3(0.4, 0.1, 0.2);
    g.opacity = 0.5;
    CaptureScene scene({g}, 0);
    scene.layer().render.isolate = false;
    scene.scene.camera.projection = Projection::fisheye;
    scene.scene.camera.position = glm::dvec3(0.0, 0.0, 5.0);
    scene.scene.camera.target = glm::dvec3(0.0);
    const Camera camera = scene.camera();
    double alpha = 0.0, wide = 0.0, high = 0.0;
    const Image picture = scene.picture();
    for (std::int64_t y = 0; y < picture.height; ++y)
        for (std::int64_t x = 0; x < picture.width; ++x) {
            const double a = picture.at(x, y)[3], right = double(x) + 0.5 - camera.center_x_px,
                         down = double(y) + 0.5 - camera.center_y_px;
            alpha += a;
            wide += a * right * right;
            high += a * down * down;
        }
    const double px = camera.focal_px / 5.0;
    EXPECT_NEAR(alpha / (0.5 * 2.0 * 3.14159265 * 0.4 * 0.1 * px * px), 1.0, 0.02);
    EXPECT_NEAR(wide / alpha / (0.4 * 0.4 * px * px + 0.25), 1.0, 0.03);
    EXPECT_NEAR(high / alpha / (0.1 * 0.1 * px * px + 0.25), 1.0, 0.03);
}

}  // namespace
}  // namespace astrosplat
