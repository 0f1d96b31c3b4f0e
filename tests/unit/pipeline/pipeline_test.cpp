// A pipeline: one scene after the other, layers that stay on disk, and the ends of every range.
#include "pipeline.h"
#include "output/write.h"
#include "scene/describe.h"
#include "scene/layer_setup.h"
#include "sets/load_source.h"
#include "splat_files/native.h"
#include "streamed/streamed_set.h"
#include "support/frames.h"
#include "support/small_scene.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// A pipeline that is given one scene after the other must render what a new one would, and do no work twice.

using Sets = std::vector<std::shared_ptr<const SplatSet>>;

class SetScene : public testing::Test {
  protected:
    SetScene() {
        for (const LayerParams& layer : small.scene.layers)
            sets.push_back(std::make_shared<const SplatSet>(load_source(layer.source, layer.name)));
        pipeline.set_scene(small.scene, sets);
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
    Pipeline pipeline;  // of the scene
};

TEST_F(SetScene, IsWhatLoadingGives) {
    Pipeline loaded(small.scene);
    EXPECT_EQ(picture(loaded), picture_of(small.scene, sets));
}

TEST_F(SetScene, WhatALookRefusesNamesTheLayer) {
    SplatSet unknown = *sets[1];
    unknown.spacing = glm::dvec3(0.0);
    small.scene.layers[1].look.vertical.match = VerticalAlpha::Match::sum;
    pipeline.set_scene(small.scene, {sets[0], std::make_shared<const SplatSet>(std::move(unknown))});
    EXPECT_EQ(
        ERROR_OF(frame_of(pipeline, 1.0)),
        "layer '" + small.scene.layers[1].name +
            "': look.vertical.match: expected none, since the spacing of the splat file's lattice is not "
            "known, found sum");
}

TEST_F(SetScene, AnyChangeGivesWhatANewPipelineGives) {
    std::vector<std::string> seen = {picture(pipeline)};
    const auto changed = [&](const auto& change) {
        change();
        pipeline.set_scene(small.scene, sets);
        seen.push_back(picture(pipeline));
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
    Scene twice = small.scene;
    twice.layers[1].source = twice.layers[0].source;
    pipeline.set_scene(twice, {sets[0], sets[0]});
    const std::string first = picture(pipeline);
    EXPECT_EQ(first, picture_of(twice, {sets[0], sets[0]}));
    pipeline.set_scene(twice, {sets[0], sets[0]});
    EXPECT_EQ(picture(pipeline), first);
}

TEST_F(SetScene, ALayerWithoutASetIsLeftOut) {
    pipeline.set_scene(small.scene, {sets[0], nullptr});
    EXPECT_EQ(pipeline.layer_names(pipeline.frame_scene(1.0)), std::vector<std::string>{"gas"});
    Scene alone = small.scene;
    alone.layers.pop_back();
    EXPECT_EQ(picture(pipeline), picture_of(alone, {sets[0]}));
}

TEST_F(SetScene, ARefusedSceneLeavesTheOldOne) {
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
    const std::string before = picture(pipeline);
    Scene other = small.scene;
    other.environment.image = small.folder / "picture.ppm";
    const std::atomic<bool> cancelled{true};
    EXPECT_THROW(pipeline.set_scene(other, sets, nullptr, {{}, &cancelled}), Cancelled);
    EXPECT_EQ(picture(pipeline), before);
}

TEST_F(SetScene, AMissingThicknessMapIsRefusedEveryTime) {
    small.scene.layers[0].look.thickness.map = small.folder / "missing.png";
    pipeline.set_scene(small.scene, sets);
    for (int i = 0; i < 2; ++i) EXPECT_THROW(picture(pipeline), InputError);
}

TEST_F(SetScene, TilesCoverThePictureOnce) {
    std::atomic<std::int64_t> pixels{0};
    pipeline.frame(1.0, settings_of(pipeline, 1.0), {},
                   [&](const Region& tile, const RenderedFrame&) { pixels += tile.width * tile.height; });
    EXPECT_EQ(pixels, 160 * 100);
}

// Layers that stay on disk render to the bits of layers in memory: through looks that drop, move and recolour
// splats, at frames whose looks differ, with several of them among each other.

class Streamed : public testing::Test {
  protected:
    Streamed() {
        Scene& scene = small.scene;
        scene.output.width = 96;
        scene.output.height = 60;
        scene.output.aovs = {"depth", "coverage", "count", "layers"};
        for (LayerParams& layer : scene.layers) {
            layer.source.count = 90000;  // two blocks
            const fs::path file = folder / (layer.name + ".splats");
            SplatSet set = load_source(layer.source, layer.name);
            set.max_distance = 0.0;  // as in files that do not say it: it is found in the rows
            write_native(file, set);
            layer.source.kind = SourceKind::splats;
            layer.source.file = file;
            layer.look.density = 0.8f;
            layer.look.noise = {Noise()};
            layer.look.noise[0].jitter = 0.2f;
            layer.look.noise[0].cull = 0.5f;
            layer.look.noise[0].silhouette = 0.3f;
            layer.look.radius.vertical_scale = 0.5f;
            names.push_back(layer.name);
        }
    }

    Quiet quiet;
    SmallScene small;
    TempFolder folder;
    std::vector<std::string> names;
};

TEST_F(Streamed, LooksGiveTheSameBits) {
    Scene scene = small.scene;
    ASSERT_GE(scene.layers.size(), 2u);
    scene.layers[0].render.lod.max_px = 30.0f;
    scene.layers[0].render.lod.max_children = 16;
    Pipeline whole(scene), streamed(scene, {}, {}, names), one(scene, {}, {}, {names[1]});
    for (const double frame : {1.0, 2.0}) {
        RenderSettings settings = settings_of(whole, frame);
        const RenderedFrame expected = whole.frame(frame, settings);
        settings.memory_limit_bytes = 3'000'000;
        for (Pipeline* each : {&streamed, &one}) {
            const RenderedFrame found = each->frame(frame, settings);
            EXPECT_EQ(found.beauty.pixels, expected.beauty.pixels);
            EXPECT_EQ(found.depth.pixels, expected.depth.pixels);
            for (std::size_t i = 0; i < expected.layers.size(); ++i)
                EXPECT_EQ(found.layers[i].pixels, expected.layers[i].pixels) << i;
            EXPECT_EQ(found.statistics.splats_drawn, expected.statistics.splats_drawn);
        }
    }
    for (std::size_t i = 0; i < names.size(); ++i)
        EXPECT_EQ(whole.statistics()[i].drawn, streamed.statistics()[i].drawn);
    EXPECT_GT(streamed.statistics()[0].drawn, 10000);
    EXPECT_LT(streamed.statistics()[0].drawn, streamed.statistics()[0].kept);
}

TEST_F(Streamed, WhatIsSaidOfABlockIsTrue) {
    LayerParams& layer = small.scene.layers[0];
    // The first block is to hold the brightest splat.
    SplatSet file = read_native(layer.source.file);
    file.color[0] = glm::vec3(3.0f);
    file.alpha[0] = 1.0f;
    write_native(layer.source.file, file, {}, RowOrder::space);
    layer.look = {};
    StreamedSet set(layer.source.file);
    set.set_look(look_of(layer), look_inputs(layer), {});
    ASSERT_EQ(set.size(), 2u);
    ShadedSplats block;
    std::int64_t splats = 0;
    float light = 0.0f;
    for (std::size_t i = 0; i < set.size(); ++i) {
        const BlockFacts& facts = set.blocks()[i];
        set.shade(i, block);
        float radius = 0.0f;
        Bounds box;
        for (std::size_t n = 0; n < block.alpha.size(); ++n) {
            const glm::vec3& c = block.color[n];
            box.add(glm::dvec3(block.position[n]));
            radius = std::max(radius, block.radius[n]);
            light = std::max(light, block.alpha[n] * std::max({c.x, c.y, c.z}));
        }
        EXPECT_EQ(facts.splats, block.size());
        EXPECT_EQ(facts.box.lo, box.lo);
        EXPECT_EQ(facts.box.hi, box.hi);
        EXPECT_EQ(facts.radius, radius);
        EXPECT_EQ(set.blocks()[i + 1].first_sample - facts.first_sample, 128);
        splats += block.size();
    }
    EXPECT_EQ(set.splats(), splats);
    EXPECT_EQ(set.largest_light(), light);
}

TEST_F(Streamed, WhatNeedsAllSplatsAtOnceIsRefused) {
    small.scene.layers[0].look.vertical.match = VerticalAlpha::Match::picture;
    EXPECT_HAS(ERROR_OF(Pipeline(small.scene, {}, {}, names)), "needs all splats at once");
}

// Whatever a description allows gives a picture of finite numbers, or one line that says why not.

bool is_finite(const Image& image) {
    return std::all_of(image.pixels.begin(), image.pixels.end(), [](float x) { return std::isfinite(x); });
}

class Extremes : public testing::Test {
  protected:
    Extremes() {
        Scene& scene = small.scene;
        scene.output.width = 32;
        scene.output.height = 20;
        scene.output.aovs = {"depth", "coverage", "count", "layers"};
        for (LayerParams& layer : scene.layers) {
            layer.source.count = 100;
            layer.look.noise = {Noise()};
            layer.look.noise[0].jitter = 0.1f;
            sets.push_back(std::make_shared<const SplatSet>(load_source(layer.source, layer.name)));
        }
    }

    void expect_finite(const Scene& scene, const std::string& what) {
        try {
            Pipeline pipeline;
            pipeline.set_scene(scene, sets);
            const RenderedFrame frame = frame_of(pipeline, 1.0);
            EXPECT_TRUE(is_finite(frame.beauty)) << what;
            EXPECT_TRUE(is_finite(frame.depth)) << what;
            for (const Image& layer : frame.layers) EXPECT_TRUE(is_finite(layer)) << what;
        } catch (const InputError&) {
            // one line with the reason
        } catch (const std::exception& error) {
            ADD_FAILURE() << what << ": " << error.what();
        }
    }

    void put_one_at(float y) {
        SplatSet far_out = *sets[1];
        far_out.position[7].y = y;
        sets[1] = std::make_shared<const SplatSet>(std::move(far_out));
    }

    Quiet quiet;
    SmallScene small;
    Sets sets;
};

Value all_components(const ParameterSpec& spec, double x) {
    if (spec.type == ParameterType::integer) return std::int64_t(x);
    if (spec.components == 1) return x;
    return Value::List(std::size_t(spec.components), Value(x));
}

TEST_F(Extremes, BothEndsOfEveryRangeGiveFinitePictures) {
    Scene original = small.scene;
    int tried = 0;
    for (std::size_t i = 0; i < describe(original).parameters.size(); ++i) {
        Scene scene = original;
        const Parameter parameter = describe(scene).parameters.at(i);
        const ParameterSpec& spec = parameter.spec;
        const bool is_size = spec.key.is_below("output") || spec.generic_key.is_below("layer.source");
        if (!is_numeric(spec.type) || spec.type == ParameterType::curve || is_size) continue;
        const double end = spec.below_max ? std::nextafter(spec.max, 0.0) : spec.max;
        for (const double x : {spec.min, end, std::max(spec.min, 1e-30)}) {
            try {
                parameter.set(all_components(spec, x));
            } catch (const ValueError&) {
                continue;  // the float below 1 is 1
            }
            expect_finite(scene, spec.key.text() + " = " + short_number(x));
            ++tried;
        }
    }
    EXPECT_GT(tried, 150);
}

TEST_F(Extremes, SplatsTooFarOutNameTheirLayer) {
    put_one_at(1e20f);
    Pipeline pipeline;
    EXPECT_EQ(ERROR_OF(pipeline.set_scene(small.scene, sets)),
              "layer.dust: expected splats within 1e+12 scene units of 0, found one at 1e+20");
}

TEST_F(Extremes, SplatsThatTheirTransformPutsTooFarOutNameTheirLayer) {
    put_one_at(1e8f);
    Pipeline pipeline;
    pipeline.set_scene(small.scene, sets);
    EXPECT_NO_THROW(frame_of(pipeline, 1.0));
    small.scene.layers[1].transform.scale = 1e9;
    pipeline.set_scene(small.scene, sets);
    EXPECT_HAS(ERROR_OF(frame_of(pipeline, 1.0)),
               "layer.dust: expected splats within 1e+15 scene units of 0");
}

}  // namespace
}  // namespace astrosplat
