// The processor's preview: all splats give the renderer's picture, and what is kept between draws never
// shows.
#include "viewer/cpu_preview.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "output/write.h"
#include "render/render.h"
#include "scene/layer_setup.h"
#include "sets/load_source.h"
#include "splats/stratified.h"
#include "support/small_scene.h"

namespace astrosplat {
namespace {

constexpr int width = 160, height = 100;

class CpuPreviewTest : public testing::Test {
  protected:
    CpuPreviewTest() {
        for (const LayerParams& params : small.scene.layers) {
            const SplatSet set = load_source(params.source, params.name);
            PreviewLayer layer;
            layer.layer = render_layer(params);
            layer.set = std::make_shared<const SplatSet>(take_rows(set, stratified_order(set), set.size()));
            layer.look = params.look;
            layer.inputs = look_inputs(params);
            layers.push_back(layer);
        }
    }

    Camera camera() const {
        Bounds box;
        box.add({-5.0, -5.0, -5.0});
        box.add({5.0, 5.0, 5.0});
        return make_camera(small.scene.camera, width, height, box);
    }
    std::string draw(CpuPreview& preview) const {
        return pixel_hash(preview.draw(layers, camera(), nullptr, width, height, 0.5f));
    }
    std::string rendered(float pixel_filter) const {
        std::vector<ShadedSplats> shaded;
        std::vector<RenderLayer> wanted;
        for (const PreviewLayer& layer : layers) {
            shaded.push_back(apply_look(*layer.set, layer.look, layer.inputs));
            wanted.push_back(layer.layer);
        }
        for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i].splats = &shaded[i];
        RenderSettings settings;
        settings.width = width;
        settings.height = height;
        settings.pixel_filter = pixel_filter;
        return pixel_hash(render(wanted, camera(), nullptr, settings).beauty);
    }
    std::string redrawn() const {
        CpuPreview preview;
        return draw(preview);
    }

    SmallScene small;
    std::vector<PreviewLayer> layers;
};

TEST_F(CpuPreviewTest, AllSplatsGiveTheRenderersPicture) {
    CpuPreview preview;
    for (const float pixel_filter : {0.5f, 0.8f}) {
        const Image& picture = preview.draw(layers, camera(), nullptr, width, height, pixel_filter);
        EXPECT_EQ(pixel_hash(picture), rendered(pixel_filter));
    }
    EXPECT_EQ(preview.shown(), layers[0].set->size() + layers[1].set->size());
}

TEST_F(CpuPreviewTest, WhatIsKeptNeverShows) {
    CpuPreview kept;
    std::vector<std::string> seen = {draw(kept)};
    const auto changed = [&](const auto& change) {
        change();
        seen.push_back(draw(kept));
        EXPECT_EQ(seen.back(), redrawn()) << "change " << seen.size() - 1;
        EXPECT_NE(seen.back(), seen[seen.size() - 2]) << "change " << seen.size() - 1;
    };
    changed([&] { layers[0].share = layers[1].share = 0.3f; });
    changed([&] { layers[0].share = 0.1f; });
    changed([&] { layers[0].look.grade.gain = 0.5f; });
    changed([&] { small.scene.camera.position = glm::dvec3(0.0, 9.0, 2.0); });
    changed([&] { layers[1].layer.render.blend = Blend::add; });
    changed([&] { layers[1].inputs.column = ColumnLaw::sum; });
    changed([&] { layers[0].share = 0.6f; });
    changed([&] {
        std::swap(layers[0], layers[1]);
        layers[0].layer.render.isolate = true;
    });
    changed([&] { layers.erase(layers.begin()); });
    changed([&] { layers.push_back(layers[0]); });
}

TEST_F(CpuPreviewTest, APrefixCountsItsShareOfTheWhole) {
    for (PreviewLayer& layer : layers) layer.share = 0.25f;
    const std::string wanted = redrawn();
    for (PreviewLayer& layer : layers) {
        layer.whole = layer.set->size();
        layer.set = std::make_shared<const SplatSet>(first_rows(*layer.set, layer.set->size() / 2));
    }
    EXPECT_EQ(redrawn(), wanted);
}

TEST_F(CpuPreviewTest, AShareBeyondThePrefixShowsAllOfIt) {
    PreviewLayer& layer = layers[0];
    layers.pop_back();
    layer.whole = layer.set->size();
    layer.set = std::make_shared<const SplatSet>(first_rows(*layer.set, 1000));
    layer.share = 0.9f;
    CpuPreview preview;
    draw(preview);
    EXPECT_EQ(preview.shown(), 1000);
}

TEST_F(CpuPreviewTest, LargeSplatsAreNotSplitUp) {
    const std::string wanted = redrawn();
    for (PreviewLayer& layer : layers) layer.layer.render.lod.max_px = 4.0f;
    EXPECT_EQ(redrawn(), wanted);
}

TEST_F(CpuPreviewTest, ALookThatCannotBeAppliedIsRefusedUntilItIsMended) {
    CpuPreview preview;
    const std::string before = draw(preview);
    layers[0].look.noise.assign(9, Noise{});
    for (Noise& noise : layers[0].look.noise) noise.jitter = 0.1f;
    for (int i = 0; i < 2; ++i) EXPECT_THROW(draw(preview), InputError);
    layers[0].look.noise.clear();
    EXPECT_EQ(draw(preview), before);
}

TEST_F(CpuPreviewTest, NoLayersAndEmptySets) {
    CpuPreview preview;
    EXPECT_EQ(preview.shown(), 0);
    layers[0].set = std::make_shared<const SplatSet>();
    layers.pop_back();
    const Image& picture = preview.draw(layers, camera(), nullptr, width, height, 0.5f);
    EXPECT_TRUE(std::all_of(picture.pixels.begin(), picture.pixels.end(), [](float v) { return v == 0.0f; }));
    layers.clear();
    EXPECT_EQ(preview.draw(layers, camera(), nullptr, width, height, 0.5f).width, width);
    EXPECT_EQ(preview.shown(), 0);
}

}  // namespace
}  // namespace astrosplat
