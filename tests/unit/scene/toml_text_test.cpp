// Edits of a TOML text: what is removed goes with its line, and keys are quoted where they must be.
#include "scene/toml_text.h"

#include <gtest/gtest.h>

namespace astrosplat {
namespace {

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
}  // namespace astrosplat
