// The words at the head of folded sections.
#include <gtest/gtest.h>

#include <algorithm>

#include "gui/panel/tab_sections.h"

namespace astrosplat::panel {
namespace {

/// Of the section of that title, for a scene whose one layer has this look.
std::string state_of(const std::string& title, const std::string& look) {
    Document document = Document::untitled(R"(astrosplat = 1
[[layer]]
name = "dust"
[layer.source]
meshes = [ { mesh = "plane", texture = "dust.png" } ]
)" + look,
                                           "/nowhere/scene.toml");
    ViewState view;
    const Status status;
    Commands commands;
    Memory memory;
    std::vector<DrawnRow> rows;
    describe_current(memory, document, 1.0);
    const auto section = std::ranges::find(tab_sections(), title, &TabSection::title);
    return section->state({document, view, status, commands, memory, rows});
}

TEST(PanelStates, SayWhatALookDoes) {
    EXPECT_EQ(state_of("Noise", ""), "off");
    EXPECT_EQ(state_of("Noise", "[[layer.look.noise]]\njitter = 0.5\n[[layer.look.noise]]\n"), "2");
    EXPECT_EQ(state_of("Thickness map", ""), "off");
    EXPECT_EQ(state_of("Colour", ""), "off");
    EXPECT_EQ(state_of("Colour", "[layer.look.grade]\ngain = 2.0\n"), "changed");
    EXPECT_EQ(state_of("Opacity at soft edges", ""), "off");
    EXPECT_EQ(state_of("Opacity at soft edges", "[layer.look.alpha]\npower = 2.0\n"), "power 2");
}

}  // namespace
}  // namespace astrosplat::panel
