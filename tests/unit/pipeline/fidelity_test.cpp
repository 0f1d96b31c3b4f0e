// Fidelity of whole scenes: what is rendered, what it is compared with, and what must not matter.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "core/error.h"
#include "core/parallel.h"
#include "image/resample.h"
#include "measure_fidelity.h"
#include "support/errors.h"
#include "support/small_scene.h"

namespace astrosplat {
namespace {

class Fidelity : public testing::Test {
  protected:
    Fidelity() {
        scene.layers.erase(scene.layers.begin());  // the sphere
        scene.layers[0].look.grade.gain = 1.0f;
        scene.layers[0].render.blend = Blend::over;
        scene.layers[0].source.count = 10000;
    }

    FidelityReport measured(const std::optional<std::filesystem::path>& reference = {}) const {
        FidelitySettings settings;
        settings.width_px = 160;
        return measure_fidelity(scene, fidelity_reference(scene, reference), settings);
    }

    SmallScene small;
    Scene& scene = small.scene;
};

TEST_F(Fidelity, APlaneOfSoftDotsIsItsPicture) {
    const FidelityReport report = measured();
    EXPECT_EQ(report.layer, "dust");
    EXPECT_EQ(report.front.width_px, 160);
    EXPECT_EQ(report.front.height_px, 160);
    EXPECT_EQ(report.full.width_px, 64);
    EXPECT_GT(report.front.psnr_db, 25.0);
    EXPECT_NEAR(report.front.flux.frame, 1.0, 0.05);
    std::string mirrored = SmallScene::picture();
    for (std::size_t row = 13; row < mirrored.size(); row += 64 * 3)
        for (std::size_t x = 0; x < 32; ++x)
            std::swap_ranges(&mirrored[row + 3 * x], &mirrored[row + 3 * x] + 3,
                             &mirrored[row + 3 * (63 - x)]);
    EXPECT_GT(report.full.psnr_db, measured(small.folder.file("mirrored.ppm", mirrored)).full.psnr_db + 10.0);
    EXPECT_EQ(report.front_view.width, 160);
    EXPECT_EQ(report.side_view.height, 90);
    EXPECT_EQ(report.edge_view.height, 50);
    EXPECT_GT(report.edge.fwhm_over_length, 0.01);
}

TEST_F(Fidelity, LightOfAnAddedLayerDoublesWithItsGain) {
    scene.layers[0].render.blend = Blend::add;
    const FluxRatios once = measured().full.flux;
    scene.layers[0].look.grade.gain = 2.0f;
    const FluxRatios twice = measured().full.flux;
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(twice.channels[c] / once.channels[c], 2.0, 1e-3);
}

TEST_F(Fidelity, DoesNotDependOnCameraSkyThreadsOrPlace) {
    const FidelityReport before = measured();
    scene.camera.position = glm::dvec3(0.0, -3.0, 1.0);
    scene.environment.image = small.folder / "picture.ppm";
    scene.output.width = 17;
    set_thread_count(1);
    const FidelityReport alone = measured();
    set_thread_count(0);
    EXPECT_EQ(alone.front.psnr_db, before.front.psnr_db);
    EXPECT_EQ(alone.full.ssim, before.full.ssim);
    EXPECT_EQ(alone.needles.share, before.needles.share);
    EXPECT_EQ(alone.edge.body_srgb, before.edge.body_srgb);
    scene.layers[0].transform = {{3.0, 1.0, -2.0}, {30.0, 50.0, 70.0}, 1.5};
    const FidelityReport elsewhere = measured();
    EXPECT_NEAR(elsewhere.front.psnr_db, before.front.psnr_db, 0.05);
    EXPECT_NEAR(elsewhere.front.flux.frame, before.front.flux.frame, 1e-3);
}

TEST_F(Fidelity, ThePictureIsSeenThroughThePixelFilter) {
    scene.output.pixel_filter = 4.0;
    const Image picture = fidelity_reference(scene, std::nullopt).picture;
    const Image filtered = resampled(picture, map_to_width(picture, 160, 160), 160, 160, 4.0);
    EXPECT_EQ(measured().front_reference.pixels, filtered.pixels);
}

TEST_F(Fidelity, AnotherPictureTakesThePlaceOfTheLayersOwn) {
    const double own = measured().full.psnr_db;
    const auto against = [&](const std::string& name, const std::string& text) {
        return measured(small.folder.file(name, text));
    };
    EXPECT_NEAR(against("same.ppm", SmallScene::picture()).full.psnr_db, own, 1e-3);
    const FidelityReport black = against("black.ppm", "P6\n64 64\n255\n" + std::string(64 * 64 * 3, '\0'));
    EXPECT_LT(black.full.psnr_db, 12.0);
    EXPECT_EQ(black.reference.filename(), "black.ppm");
    const std::string wide = message_of<InputError>(
        [&] { against("wide.ppm", "P6\n64 32\n255\n" + std::string(64 * 32 * 3, 'x')); });
    EXPECT_NE(wide.find("wide.ppm: expected the proportions of layer 'dust'"), std::string::npos) << wide;
}

TEST_F(Fidelity, ALayerThatIsNotVisibleCanNameThePicture) {
    scene.layers[0].visible = false;
    small.add_layer("seen", "plane", 20000);
    EXPECT_EQ(fidelity_reference(scene, std::nullopt).layer, "seen");
    scene.layers[1].source.kind = SourceKind::splats;
    EXPECT_EQ(fidelity_reference(scene, std::nullopt).layer, "dust");
    scene.layers.erase(scene.layers.begin());
    const std::string none = message_of<InputError>([&] { fidelity_reference(scene, std::nullopt); });
    EXPECT_NE(none.find("a layer of kind \"mesh\""), std::string::npos) << none;
}

TEST_F(Fidelity, AStripIsNotBlownUpToTheWidthOfAPicture) {
    FidelityReference strip;
    strip.frame.width = 3.0;
    strip.frame.height = 2000.0;
    strip.picture = make_image(3, 2000, 3);
    EXPECT_EQ(strip.front_width_px(1280), 7);
    EXPECT_EQ(strip.front_width_px(3), 3);
    strip.picture = make_image(10, 6667, 3);
    EXPECT_EQ(strip.front_width_px(1280), 10);
    strip.frame.height = 2.0;
    EXPECT_EQ(strip.front_width_px(1280), 1280);
}

TEST_F(Fidelity, StopsWhenAsked) {
    const FidelityReference reference = fidelity_reference(scene, std::nullopt);
    const std::atomic<bool> stop{true};
    FidelitySettings settings;
    settings.begin_step = [&](const std::string&) { return Progress{{}, &stop}; };
    EXPECT_THROW(measure_fidelity(scene, reference, settings), Cancelled);
}

}  // namespace
}  // namespace astrosplat
