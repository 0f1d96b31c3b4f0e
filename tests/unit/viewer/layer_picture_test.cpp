// The badge's words on the front: the measures of the engine; and before and after in the panel: what the
// engine prepares, small. Both of the last request and of no other.
#include "viewer/comparison.h"

#include "core/color.h"
#include "measure_fidelity.h"
#include "sets/load_source.h"
#include "source/prepared_picture.h"
#include "support/fits_text.h"
#include "support/pixmap.h"
#include "support/small_scene.h"
#include "support/test.h"

namespace astrosplat {
namespace {

/// The result for the request.
template <class Work, class Request>
auto asked(Work& work, const Request& request) {
    work.want(request);
    while (work.working()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return work.found(request);
}

class FrontCheckTest : public testing::Test {
  protected:
    FrontCheckTest() {
        scene.layers.erase(scene.layers.begin());  // the sphere
        scene.layers[0].look.grade.gain = 1.0f;
        scene.layers[0].render.blend = Blend::over;
        scene.layers[0].source.count = 10000;
        const LayerParams& layer = scene.layers[0];
        sets = {std::make_shared<const SplatSet>(load_source(layer.source, layer.name))};
    }

    FrontRequest request() const { return front_request(scene, sets, 0); }

    SmallScene small;
    Scene& scene = small.scene;
    std::vector<std::shared_ptr<const SplatSet>> sets;
};

TEST_F(FrontCheckTest, FindsWhatTheEngineMeasures) {
    FrontCheck check{front_check()};
    EXPECT_FALSE(check.working());
    const auto found = asked(check, request());
    ASSERT_TRUE(found);
    const FrontComparison expected = compare_front(scene, sets, fidelity_reference(scene, {}), 64);
    EXPECT_EQ(found->error, "");
    EXPECT_EQ(found->fidelity.psnr_db, expected.fidelity.psnr_db);
    EXPECT_EQ(found->fidelity.ssim, expected.fidelity.ssim);
    EXPECT_EQ(found->fidelity.flux.frame, expected.fidelity.flux.frame);
    EXPECT_EQ(found->difference.width, 64);
    EXPECT_EQ(found->difference.channels, 4);
}

TEST_F(FrontCheckTest, WhatIsFoundBelongsToItsRequest) {
    FrontCheck check{front_check(32)};
    const FrontRequest before = request();
    const auto found = asked(check, before);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->fidelity.width_px, 32);
    scene.camera.position = {1.0, 2.0, 3.0};
    scene.output.exposure = 2.0;
    check.want(request());
    EXPECT_EQ(check.found(request()), found) << "no front depends on camera and exposure";
    scene.layers[0].look.grade.gain = 0.5f;
    EXPECT_FALSE(check.found(request()));
    ASSERT_TRUE(asked(check, request()));
    EXPECT_FALSE(check.found(before));
    EXPECT_LT(check.found(request())->fidelity.flux.frame, 0.6 * found->fidelity.flux.frame);
}

TEST_F(FrontCheckTest, CancelledItHasFoundNothingAndCanBeAskedAgain) {
    FrontCheck check{front_check()};
    check.want(request());
    check.cancel();
    EXPECT_FALSE(check.working());
    EXPECT_FALSE(check.found(request()));
    EXPECT_TRUE(asked(check, request()));
    check.cancel();
    EXPECT_TRUE(check.found(request())) << "nothing was under way";
}

TEST_F(FrontCheckTest, ALayerWithoutAPictureSaysSo) {
    scene.layers[0].source.meshes[0].texture = {small.folder / "missing.ppm"};
    FrontCheck check{front_check()};
    const auto found = asked(check, request());
    ASSERT_TRUE(found);
    EXPECT_NE(found->error.find("missing.ppm"), std::string::npos) << found->error;
}

TEST_F(FrontCheckTest, KnowsLooksThatChangeTheFront) {
    scene.layers[0].look = {};
    scene.layers[0].render = {};
    scene.layers[0].render.lod.max_px = 60.0f;
    EXPECT_TRUE(has_front_picture(scene));
    EXPECT_FALSE(front_changed_by_look(scene));
    scene.layers[0].look.alpha.power = 2.0f;
    EXPECT_TRUE(front_changed_by_look(scene));
    scene.layers[0].visible = false;
    EXPECT_FALSE(front_changed_by_look(scene));
    EXPECT_FALSE(has_front_picture(scene));
    scene.layers[0] = LayerParams{};
    scene.layers[0].render.blend = Blend::add;
    EXPECT_TRUE(front_changed_by_look(scene));
    scene.layers[0].source.kind = SourceKind::splats;
    EXPECT_FALSE(has_front_picture(scene));
}

TEST_F(FrontCheckTest, OnlyPicturesHaveAFront) {
    scene.layers[0].source.meshes[0].mesh = "plane";
    EXPECT_TRUE(has_front_picture(scene));
    scene.layers[0].source.meshes[0].mesh = "/meshes/cow.obj";
    scene.layers[0].source.uv = UvMode::mesh;
    EXPECT_FALSE(has_front_picture(scene)) << "it has texture coordinates of its own";
    for (const UvMode onto : {UvMode::planar_xz, UvMode::camera}) {
        scene.layers[0].source.uv = onto;
        EXPECT_TRUE(has_front_picture(scene));
    }
}

// Twelve stars on a grey ground.
std::string stars_on_grey() { return test::starry_pixmap({256, 192, 64, 64, 150.0, 9.0, 0.0, 1.0}); }

class PreparePreviewTest : public testing::Test {
  protected:
    PreparePreviewTest() {
        layer.source.meshes = {{"plane", {folder.file("p.ppm", stars_on_grey())}}};
        layer.source.texture.prepare.stars = PrepareParams::Stars::remove;
    }
    PrepareRequest request(std::uint64_t changes = 0) const {
        return prepare_request(layer, changes).value();
    }
    TempFolder folder;
    LayerParams layer;
};

TEST_F(PreparePreviewTest, ShowsThePictureBeforeAndAfter) {
    PreparePreview preview{prepare_preview()};
    const auto found = asked(preview, request());
    ASSERT_TRUE(found);
    EXPECT_EQ(found->error, "");
    EXPECT_EQ(found->stars, 12);
    EXPECT_EQ(found->before.width, 256);
    const float seen = found->before.at(32, 31)[0], removed = found->after.at(32, 31)[0];
    EXPECT_NEAR(seen, 210.0 / 255.0, 0.02) << "display values";
    EXPECT_LT(removed, 0.35f);
    EXPECT_EQ(found->after.at(32, 31)[3], 1.0f);
    const Image exact = prepare_picture(layer.source.meshes[0].texture, layer.source.texture).image;
    EXPECT_NEAR(removed, real::linear_to_srgb(double(exact.at(32, 31)[0])), 1e-6);
}

TEST_F(PreparePreviewTest, IsSmallAndCutsWhereThePictureIsCut) {
    layer.source.texture.prepare.stars = PrepareParams::Stars::keep;
    layer.source.texture.prepare.ellipse = glm::dvec4(128.0, 96.0, 64.0, 48.0);
    const PreparedView view = prepared_view(request(), 100, {});
    ASSERT_EQ(view.after.width, 64);
    ASSERT_EQ(view.after.height, 48);
    ASSERT_EQ(view.before.width, 64);
    EXPECT_EQ(view.after.at(1, 24)[0], 0.0f);
    EXPECT_EQ(view.after.at(32, 1)[0], 0.0f);
    EXPECT_GT(view.after.at(32, 24)[0], 0.1f);
    EXPECT_GT(view.before.at(1, 24)[0], 0.1f);
}

// A picture of 20 x 20 px with a bright upper half, seen upside down and half as fine by the one it
// is put on.
TEST_F(PreparePreviewTest, BothSidesAreAligned) {
    const auto bright_above = [](int, int y) { return y >= 10 ? 900.0 : 100.0; };
    const auto own = folder.file(
        "own.fits", fits_file(20, 20, fits_sky(10.5, 10.5, 10.0, 41.0, 0.001, 180.0), bright_above));
    layer.source.texture.prepare = {};
    layer.source.texture.prepare.align = folder.file(
        "other.fits", fits_file(20, 12, fits_sky(10.5, 6.5, 10.0, 41.0, 0.002, 0.0), bright_above));
    layer.source.texture.stretch = TextureSettings::Stretch::linear;
    layer.source.texture.black = 0.0;
    layer.source.texture.white = 1000.0;
    layer.source.meshes[0].texture = {own};
    const PreparedView view = prepared_view(request(), 400, {});
    for (const Image* side : {&view.before, &view.after}) {
        ASSERT_EQ(side->width, 20);
        ASSERT_EQ(side->height, 12);
        EXPECT_GT(side->at(10, 8)[0], 0.8f) << "below the middle";
        EXPECT_NEAR(side->at(10, 3)[0], 0.35f, 0.02f) << "above";
        EXPECT_EQ(side->at(2, 6)[0], 0.0f) << "what the picture does not show";
    }
}

TEST_F(PreparePreviewTest, WhatComesLaterIsLeftOut) {
    layer.source.texture.derive = Derived::dust;
    layer.source.texture.smooth = 9.0;
    layer.source.texture.mask.emplace_back().luminance = glm::dvec2(0.9, 1.0);
    const PrepareRequest plain = request();
    EXPECT_EQ(plain.texture.derive, Derived::none);
    EXPECT_EQ(plain.texture.smooth, 0.0);
    EXPECT_TRUE(plain.texture.mask.empty());
}

TEST_F(PreparePreviewTest, SaysWhyNothingCanBeShown) {
    PreparePreview preview{prepare_preview()};
    layer.source.meshes[0].texture = {folder / "missing.png"};
    ASSERT_TRUE(asked(preview, request()));
    EXPECT_NE(preview.found(request())->error.find("missing.png"), std::string::npos);
    EXPECT_FALSE(preview.found(request(1))) << "of another request nothing is known";
}

TEST_F(PreparePreviewTest, OnlyPicturesOfTheSceneArePrepared) {
    layer.source.meshes[0].texture.clear();
    EXPECT_FALSE(prepare_request(layer, 0));
    layer.source.kind = SourceKind::splats;
    EXPECT_FALSE(prepare_request(layer, 0));
}

}  // namespace
}  // namespace astrosplat
