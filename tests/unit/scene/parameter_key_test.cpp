// Dotted keys: built from parts, taken apart, compared.
#include "scene/parameter_key.h"

#include <gtest/gtest.h>

namespace astrosplat {
namespace {

TEST(ParameterKeyTest, IsBuiltFromParts) {
    EXPECT_EQ(layer_key("stars") / "look.noise" / 2 / "cull", "layer.stars.look.noise.2.cull");
    EXPECT_EQ(ParameterKey() / "camera" / "fov", "camera.fov");
    EXPECT_EQ(fmt::format("{}", layer_key("a")), "layer.a");
    EXPECT_EQ(layer_key("a").parts(), (std::vector<std::string>{"layer", "a"}));
    EXPECT_TRUE(ParameterKey().parts().empty());
}

TEST(ParameterKeyTest, LiesBelowWholePartsOnly) {
    const ParameterKey key = "layer.stars.look.density";
    EXPECT_TRUE(key.is_below("layer"));
    EXPECT_TRUE(key.is_below("layer.stars"));
    EXPECT_TRUE(key.is_below(""));
    EXPECT_FALSE(key.is_below("layer.star"));
    EXPECT_FALSE(key.is_below("layer.stars.look.density"));
    EXPECT_FALSE(key.is_below("camera"));
    EXPECT_FALSE(ParameterKey().is_below(""));
    EXPECT_EQ(key.below("layer.stars"), "look.density");
    EXPECT_EQ(key.below(""), "layer.stars.look.density");
    EXPECT_EQ(key.moved("layer.stars", "layer.dust"), "layer.dust.look.density");
    EXPECT_EQ(key.parent(), "layer.stars.look");
    EXPECT_EQ(ParameterKey("camera").parent(), "");
}

TEST(ParameterKeyTest, KnowsItsLayer) {
    EXPECT_EQ(ParameterKey("layer.stars.look.density").layer(), "stars");
    EXPECT_EQ(ParameterKey("layer.stars").layer(), "stars");
    EXPECT_EQ(ParameterKey("layer").layer(), "");
    EXPECT_EQ(ParameterKey("layers.stars.visible").layer(), "");
    EXPECT_EQ(ParameterKey("camera.fov").layer(), "");
}

TEST(ParameterKeyTest, GenericKeysHaveNeitherLayerNorIndex) {
    EXPECT_EQ(ParameterKey("layer.look.look.noise.12.cull").generic(), "layer.look.noise.cull");
    EXPECT_EQ(ParameterKey("look.noise.0.cull").generic(), "look.noise.cull");
    EXPECT_EQ(ParameterKey("camera.position").generic(), "camera.position");
    EXPECT_EQ(ParameterKey("layer.s106.look.vertical.shape").generic(), "layer.look.vertical.shape");
    EXPECT_FALSE(is_list_index(""));
    EXPECT_FALSE(is_list_index("1a"));
}

}  // namespace
}  // namespace astrosplat
