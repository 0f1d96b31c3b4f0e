// Words of a scene: keys, what was meant, lists of frames, edits of the text.
#include <gtest/gtest.h>

#include <vector>

#include "scene/frames.h"
#include "scene/parameter_key.h"
#include "scene/toml_text.h"
#include "support/errors.h"

namespace astrosplat::test {
namespace {

// Dotted keys: built from parts, taken apart, compared.

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

// "Did you mean": distances worked out by hand, and the slips people make in keys.

TEST(Suggest, EditDistance) {
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
    EXPECT_EQ(edit_distance("", "abc"), 3);
    EXPECT_EQ(edit_distance("same", "same"), 0);
    EXPECT_EQ(edit_distance("outptu", "output"), 1);
    EXPECT_EQ(edit_distance("uotput", "output"), 1);
}

TEST(Suggest, NearestName) {
    const std::vector<std::string> keys{"layer.look.alpha.power", "layer.look.density", "camera.fov"};
    EXPECT_EQ(nearest_name("camera.fow", keys), "camera.fov");
    EXPECT_EQ(nearest_name("alpha.powr", keys), "layer.look.alpha.power");
    EXPECT_EQ(nearest_name("densty", keys), "layer.look.density");
    EXPECT_EQ(nearest_name("fow", keys), "camera.fov");
    EXPECT_EQ(nearest_name("something", keys), "");
}

// Frame lists.

using Frames = std::vector<std::int64_t>;

std::string refusal(const std::string& text) { return ERROR_OF(parse_frames(text, "--frames")); }

TEST(Frames, ListsRangesAndSteps) {
    EXPECT_EQ(parse_frames("5", ""), (Frames{5}));
    EXPECT_EQ(parse_frames("1-3, 7", ""), (Frames{1, 2, 3, 7}));
    EXPECT_EQ(parse_frames("10-15x2", ""), (Frames{10, 12, 14}));
    EXPECT_EQ(parse_frames("10-16:3", ""), (Frames{10, 13, 16}));
    EXPECT_EQ(parse_frames("-3--1,-5", ""), (Frames{-5, -3, -2, -1}));
    EXPECT_EQ(parse_frames("-1-1", ""), (Frames{-1, 0, 1}));
    EXPECT_EQ(parse_frames("3,1-3,2", ""), (Frames{1, 2, 3}));
    EXPECT_EQ(parse_frames("1-240", "").size(), 240u);
}

TEST(Frames, AreWrittenShortAndReadBack) {
    const std::pair<Frames, std::string> cases[] = {
        {{}, ""},
        {{7}, "7"},
        {{1, 2}, "1-2"},
        {{1, 3}, "1,3"},
        {{-3, -2, -1, 4}, "-3--1,4"},
        {{1, 3, 4, 5}, "1,3-5"},
        {{0, 5, 10, 11}, "0-10x5,11"},
        {{1, 2, 3, 7, 10, 12, 14, 16, 40}, "1-3,7,10-16x2,40"},
    };
    for (const auto& [frames, text] : cases) {
        EXPECT_EQ(frames_text(frames), text);
        if (frames.empty()) continue;
        EXPECT_EQ(parse_frames(text, ""), frames);
    }
}

TEST(Frames, Messages) {
    const std::string such = "--frames: expected frames such as 1-100,120,200-300x2, found ";
    EXPECT_EQ(refusal(""), such + "''");
    EXPECT_EQ(refusal("1,"), such + "''");
    EXPECT_EQ(refusal("a"), such + "'a'");
    EXPECT_EQ(refusal("1.5"), such + "'1.5'");
    EXPECT_EQ(refusal("1-"), such + "'1-'");
    EXPECT_EQ(refusal("9-1"), "--frames: expected a range that ascends, found '9-1'");
    EXPECT_EQ(refusal("1-9x0"), "--frames: expected a step of at least 1, found '1-9x0'");
    EXPECT_EQ(refusal("99999999999999999999"),
              "--frames: expected frames between -999999999 and 999999999, found '99999999999999999999'");
    EXPECT_EQ(refusal("1-20000000"), "--frames: expected at most 10000000 frames, found '1-20000000'");
}

// Edits of a TOML text: what is removed goes with its line, and keys are quoted where they must be.

TEST(TomlKey, IsQuotedWhereTomlNeedsIt) {
    EXPECT_EQ(toml_key({"azAZ", "09", "_", "-"}), "azAZ.09._.-");
    EXPECT_EQ(toml_key({"layer.dust.look.density"}), "\"layer.dust.look.density\"");
    EXPECT_EQ(toml_key({"a b", ""}), "\"a b\".\"\"");
    EXPECT_EQ(toml_key({"layer", "0", "name"}, 2), "name");
}

TEST(TomlText, WhatIsRemovedTakesItsLineAlong) {
    TomlText text("a = 1\nb.c = 2  # of b\nb.d = 3\ne = 4\n");
    text.remove({"b", "c"});
    EXPECT_EQ(text.text(), "a = 1\nb.d = 3\ne = 4\n");
    text.remove({"b"});
    EXPECT_EQ(text.text(), "a = 1\ne = 4\n");
    text.remove({"absent"});
    EXPECT_EQ(text.text(), "a = 1\ne = 4\n");
}

TEST(TomlText, InlineTablesCloseTheGapOfWhatIsRemoved) {
    const std::string begin = "a = { b = 1, c = 2, d = 3 }  # kept\n";
    const auto without = [&](const std::string& key) {
        TomlText text(begin);
        text.remove({"a", key});
        return text.text();
    };
    EXPECT_EQ(without("b"), "a = { c = 2, d = 3 }  # kept\n");
    EXPECT_EQ(without("c"), "a = { b = 1, d = 3 }  # kept\n");
    EXPECT_EQ(without("d"), "a = { b = 1, c = 2 }  # kept\n");
}

}  // namespace
}  // namespace astrosplat::test
