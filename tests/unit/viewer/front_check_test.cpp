// What the badge says of the front: the measures of the engine, of the last request and of no other.
#include "viewer/layer_picture.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "measure_fidelity.h"
#include "sets/load_source.h"
#include "support/small_scene.h"

namespace astrosplat {
namespace {

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

    static void wait(const FrontCheck& check) {
        while (check.working()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }

    SmallScene small;
    Scene& scene = small.scene;
    std::vector<std::shared_ptr<const SplatSet>> sets;
};

TEST_F(FrontCheckTest, FindsWhatTheEngineMeasures) {
    FrontCheck check{front_check()};
    EXPECT_FALSE(check.working());
    check.want(request());
    wait(check);
    const auto found = check.found(request());
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
    check.want(before);
    wait(check);
    const auto found = check.found(before);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->fidelity.width_px, 32);
    scene.camera.position = {1.0, 2.0, 3.0};
    scene.output.exposure = 2.0;
    check.want(request());
    EXPECT_EQ(check.found(request()), found) << "no front depends on camera and exposure";
    scene.layers[0].look.grade.gain = 0.5f;
    EXPECT_FALSE(check.found(request()));
    check.want(request());
    wait(check);
    EXPECT_FALSE(check.found(before));
    ASSERT_TRUE(check.found(request()));
    EXPECT_LT(check.found(request())->fidelity.flux.frame, 0.6 * found->fidelity.flux.frame);
}

TEST_F(FrontCheckTest, CancelledItHasFoundNothingAndCanBeAskedAgain) {
    FrontCheck check{front_check()};
    check.want(request());
    check.cancel();
    EXPECT_FALSE(check.working());
    EXPECT_FALSE(check.found(request()));
    check.want(request());
    wait(check);
    EXPECT_TRUE(check.found(request()));
    check.cancel();
    EXPECT_TRUE(check.found(request())) << "nothing was under way";
}

TEST_F(FrontCheckTest, ALayerWithoutAPictureSaysSo) {
    scene.layers[0].source.meshes[0].texture = {small.folder / "missing.ppm"};
    FrontCheck check{front_check()};
    check.want(request());
    wait(check);
    const auto found = check.found(request());
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

}  // namespace
}  // namespace astrosplat
