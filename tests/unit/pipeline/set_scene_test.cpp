// A pipeline that is given one scene after the other must render what a new one would, and do no work twice.
#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "core/error.h"
#include "output/write.h"
#include "pipeline.h"
#include "sets/load_source.h"
#include "support/frames.h"
#include "support/quiet.h"
#include "support/small_scene.h"

namespace astrosplat {
namespace {

using Sets = std::vector<std::shared_ptr<const SplatSet>>;

class SetScene : public testing::Test {
  protected:
    SetScene() {
        for (const LayerParams& layer : small.scene.layers)
            sets.push_back(std::make_shared<const SplatSet>(load_source(layer.source, layer.name)));
    }

    static std::string picture(Pipeline& pipeline) { return pixel_hash(frame_of(pipeline, 1.0).beauty); }
    static std::string picture_of(const Scene& scene, const Sets& given) {
        Pipeline fresh;
        fresh.set_scene(scene, given);
        return picture(fresh);
    }

    Quiet quiet;
    SmallScene small;
    Sets sets;
};

TEST_F(SetScene, IsWhatLoadingGives) {
    Pipeline loaded(small.scene);
    EXPECT_EQ(picture(loaded), picture_of(small.scene, sets));
}

TEST_F(SetScene, AnyChangeGivesWhatANewPipelineGives) {
    Pipeline kept;
    kept.set_scene(small.scene, sets);
    std::vector<std::string> seen = {picture(kept)};
    const auto changed = [&](const auto& change) {
        change();
        kept.set_scene(small.scene, sets);
        seen.push_back(picture(kept));
        EXPECT_EQ(seen.back(), picture_of(small.scene, sets));
    };
    Scene& scene = small.scene;
    changed([&] { scene.layers[0].look.grade.gain = 0.5f; });
    changed([&] { scene.camera.position = glm::dvec3(0.0, 9.0, 3.0); });
    changed([&] { scene.layers[1].render.blend = Blend::add; });
    changed([&] {
        scene.layers[1].axis = {1.0, 0.0, 0.0};
        scene.layers[1].look.noise.resize(1);
        scene.layers[1].look.noise[0].jitter = 0.3f;
    });
    changed([&] {
        std::swap(scene.layers[0], scene.layers[1]);
        std::swap(sets[0], sets[1]);
        scene.layers[0].render.isolate = true;
    });
    changed([&] {
        scene.layers[0].name = "renamed";
        scene.layers[0].look.density = 0.5f;
    });
    changed([&] {
        scene.layers.push_back(scene.layers[0]);
        scene.layers.back().name = "copy";
        scene.layers.back().transform.translate = {2.0, 0.0, 0.0};
        sets.push_back(sets[0]);
    });
    changed([&] {
        scene.layers.erase(scene.layers.begin());
        sets.erase(sets.begin());
    });
    changed([&] { scene.environment.image = small.folder / "picture.ppm"; });
    changed([&] { scene.environment.gain = 0.3f; });
    for (std::size_t i = 1; i < seen.size(); ++i) EXPECT_NE(seen[i], seen[i - 1]) << "change " << i;
}

TEST_F(SetScene, ShadesOnlyWhatChanged) {
    Pipeline pipeline;
    pipeline.set_scene(small.scene, sets);
    picture(pipeline);
    const std::int64_t drawn = pipeline.statistics()[0].drawn;
    EXPECT_GT(pipeline.statistics()[0].look_seconds, 0.0);
    small.scene.camera.position = glm::dvec3(1.0, 8.0, 1.0);
    small.scene.layers[1].look.grade.gain = 0.3f;
    pipeline.set_scene(small.scene, sets);
    picture(pipeline);
    EXPECT_EQ(pipeline.statistics()[0].look_seconds, 0.0);
    EXPECT_GT(pipeline.statistics()[1].look_seconds, 0.0);
    EXPECT_EQ(pipeline.statistics()[0].drawn, drawn);
}

TEST_F(SetScene, LayersMayShareASet) {
    Pipeline pipeline;
    Scene twice = small.scene;
    twice.layers[1].source = twice.layers[0].source;
    pipeline.set_scene(twice, {sets[0], sets[0]});
    const std::string first = picture(pipeline);
    EXPECT_EQ(first, picture_of(twice, {sets[0], sets[0]}));
    pipeline.set_scene(twice, {sets[0], sets[0]});
    EXPECT_EQ(picture(pipeline), first);
}

TEST_F(SetScene, ALayerWithoutASetIsLeftOut) {
    Pipeline pipeline;
    pipeline.set_scene(small.scene, {sets[0], nullptr});
    EXPECT_EQ(pipeline.layer_names(pipeline.frame_scene(1.0)), std::vector<std::string>{"gas"});
    Scene alone = small.scene;
    alone.layers.pop_back();
    EXPECT_EQ(picture(pipeline), picture_of(alone, {sets[0]}));
}

TEST_F(SetScene, ARefusedSceneLeavesTheOldOne) {
    Pipeline pipeline;
    pipeline.set_scene(small.scene, sets);
    const std::string before = picture(pipeline);
    Scene bad = small.scene;
    bad.environment.image = small.folder / "missing.png";
    EXPECT_THROW(pipeline.set_scene(bad, sets), InputError);
    EXPECT_EQ(picture(pipeline), before);
    // The second set is refused when the first layer has already been found again.
    auto far = std::make_shared<SplatSet>(*sets[1]);
    far->position.front().x = 1e13f;
    bad = small.scene;
    EXPECT_THROW(pipeline.set_scene(bad, {sets[0], far}), InputError);
    EXPECT_EQ(picture(pipeline), before);
}

TEST_F(SetScene, StopsBeforeThePicturesOfTheEnvironment) {
    Pipeline pipeline;
    pipeline.set_scene(small.scene, sets);
    const std::string before = picture(pipeline);
    Scene other = small.scene;
    other.environment.image = small.folder / "picture.ppm";
    const std::atomic<bool> cancelled{true};
    EXPECT_THROW(pipeline.set_scene(other, sets, nullptr, {{}, &cancelled}), Cancelled);
    EXPECT_EQ(picture(pipeline), before);
}

TEST_F(SetScene, AMissingThicknessMapIsRefusedEveryTime) {
    Pipeline pipeline;
    small.scene.layers[0].look.thickness.map = small.folder / "missing.png";
    pipeline.set_scene(small.scene, sets);
    for (int i = 0; i < 2; ++i) EXPECT_THROW(picture(pipeline), InputError);
}

TEST_F(SetScene, TilesCoverThePictureOnce) {
    Pipeline pipeline;
    pipeline.set_scene(small.scene, sets);
    std::atomic<std::int64_t> pixels{0};
    pipeline.frame(1.0, settings_of(pipeline, 1.0), {},
                   [&](const Region& tile, const RenderedFrame&) { pixels += tile.width * tile.height; });
    EXPECT_EQ(pixels, 160 * 100);
}

}  // namespace
}  // namespace astrosplat
