// Layers that stay on disk render to the bits of layers in memory: through looks that drop, move and recolour
// splats, at frames whose looks differ, with several of them among each other.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/error.h"
#include "pipeline.h"
#include "scene/layer_setup.h"
#include "sets/load_source.h"
#include "splat_files/native.h"
#include "streamed/streamed_set.h"
#include "support/frames.h"
#include "support/quiet.h"
#include "support/small_scene.h"

namespace astrosplat {
namespace {

class Streamed : public testing::Test {
  protected:
    Streamed() {
        folder = std::filesystem::temp_directory_path() / ("astrosplat-streamed-" + std::to_string(getpid()));
        std::filesystem::create_directories(folder);
        Scene& scene = small.scene;
        scene.output.width = 96;
        scene.output.height = 60;
        scene.output.aovs = {"depth", "coverage", "count", "layers"};
        for (LayerParams& layer : scene.layers) {
            layer.source.count = 90000;  // two blocks
            const std::filesystem::path file = folder / (layer.name + ".splats");
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
    ~Streamed() override { std::filesystem::remove_all(folder); }

    Quiet quiet;
    SmallScene small;
    std::filesystem::path folder;
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
    try {
        Pipeline pipeline(small.scene, {}, {}, names);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("needs all splats at once"), std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace astrosplat
