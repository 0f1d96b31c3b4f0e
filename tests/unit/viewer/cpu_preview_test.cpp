// Which layer a click in the picture selects: the brightest at that pixel first, dust by what it hides.
#include "viewer/cpu_preview.h"

#include <gtest/gtest.h>

namespace astrosplat {
namespace {

constexpr std::int64_t size = 64;  // px

/// Layers of one large dot each, seen from +z; x < 0 is the left half.
struct LayersAtPixel : testing::Test {
    std::vector<ShadedSplats> splats;
    std::vector<PreviewLayer> layers;
    LayersAtPixel() { splats.reserve(8); }

    PreviewLayer& add(const char* name, glm::vec3 place, glm::vec3 color, float alpha = 1.0f) {
        ShadedSplats dot;
        dot.position.push_back(place);
        dot.color.push_back(color);
        dot.alpha.push_back(alpha);
        dot.radius.push_back(1.0f);
        dot.id.push_back(splats.size());
        splats.push_back(std::move(dot));
        PreviewLayer layer;
        layer.layer.name = name;
        layer.layer.splats = &splats.back();
        layer.layer.render.falloff.shape = Falloff::Shape::constant;
        layers.push_back(std::move(layer));
        return layers.back();
    }
    static PreviewView view() {
        PreviewView view;
        CameraParams params;
        params.projection = Projection::orthographic;
        params.position = glm::dvec3(0.0, 0.0, 10.0);
        params.height = 4.0;
        view.width = view.height = size;
        view.camera = make_camera(params, double(size), double(size), {});
        return view;
    }
    std::vector<float> light(std::int64_t x, std::int64_t y) const {
        return light_of_layers(layers, view(), x, y);
    }
    std::vector<std::size_t> seen(std::int64_t x, std::int64_t y) const { return seen_layers(light(x, y)); }
};

TEST_F(LayersAtPixel, EachLayerIsFoundWhereItIs) {
    add("left", {-1.0f, 0.0f, 0.0f}, glm::vec3(0.2f));
    add("right", {1.0f, 0.0f, 0.0f}, glm::vec3(0.8f));
    EXPECT_EQ(seen(16, 32), std::vector<std::size_t>{0});
    EXPECT_EQ(seen(48, 32), std::vector<std::size_t>{1});
    EXPECT_EQ(seen(16, 4), std::vector<std::size_t>{});
}

TEST_F(LayersAtPixel, LightIsThatOfNinePixelsAsItArrives) {
    add("behind", {0.0f, 0.0f, -1.0f}, {0.25f, 0.5f, 0.25f});
    add("in front", {0.0f, 0.0f, 1.0f}, {0.5f, 0.0f, 0.5f}, 0.75f);
    const std::vector<float> found = light(32, 32);
    EXPECT_NEAR(found[0], 9.0f * 0.25f, 1e-4f);
    EXPECT_NEAR(found[1], 9.0f * 0.75f, 1e-4f);
    EXPECT_EQ(seen(32, 32), (std::vector<std::size_t>{1, 0}));
}

TEST_F(LayersAtPixel, WhatHidesIsSeenByTheLightItTakes) {
    add("stars", {0.0f, 0.0f, -1.0f}, glm::vec3(1.0f));
    add("dust", {0.0f, 0.0f, 1.0f}, glm::vec3(1.0f), 0.75f).layer.render.blend = Blend::absorb;
    layers[1].layer.render.absorb = glm::vec3(1.0f);
    const std::vector<float> found = light(32, 32);
    EXPECT_NEAR(found[0], 9.0f * 3.0f * 0.25f, 1e-3f);
    EXPECT_NEAR(found[1], 9.0f * 3.0f * 0.75f, 1e-3f);
    EXPECT_EQ(seen(32, 32), (std::vector<std::size_t>{1, 0}));
}

TEST_F(LayersAtPixel, NothingIsSeenBesideTheFrame) {
    add("all", {0.0f, 0.0f, 0.0f}, glm::vec3(1.0f));
    for (const auto& [x, y] : {std::pair{-1, 32}, {64, 32}, {32, -1}, {32, 64}})
        EXPECT_EQ(light(x, y), std::vector<float>{0.0f}) << x << " " << y;
    EXPECT_GT(light(32, 32)[0], 0.0f);
}

TEST(SeenLayers, WhatCannotBeToldFromBlackIsLeftOut) {
    EXPECT_EQ(seen_layers({1.0f, 0.01f, 5.0f, 0.2f, 0.0f}), (std::vector<std::size_t>{2, 0, 3}));
    EXPECT_TRUE(seen_layers({0.0f, 0.0f}).empty());
    EXPECT_TRUE(seen_layers({}).empty());
}

TEST(ClickedLayer, AnotherClickTakesTheNextOneAndThenTheFirstAgain) {
    const std::vector<std::size_t> seen{2, 0, 3};
    EXPECT_EQ(clicked_layer(seen, 0, false), 2u);
    EXPECT_EQ(clicked_layer(seen, 2, true), 0u);
    EXPECT_EQ(clicked_layer(seen, 0, true), 3u);
    EXPECT_EQ(clicked_layer(seen, 3, true), 2u);
    EXPECT_EQ(clicked_layer(seen, 1, true), 2u) << "the selected layer is not here";
    EXPECT_EQ(clicked_layer({}, 1, true), std::nullopt);
}

}  // namespace
}  // namespace astrosplat
