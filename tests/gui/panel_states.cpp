// The words at the head of folded sections.
#include <gtest/gtest.h>

#include <algorithm>

#include "gui/panel/panel.h"
#include "gui/panel/parts.h"
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
    std::vector<DrawnItem> drawn;
    describe_current(memory, document, 1.0);
    const auto section = std::ranges::find(tab_sections(), title, &TabSection::title);
    return section->state({{document, view, status, commands, drawn}, memory, rows});
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

/// The word in place of this key's 0, for a layer of which the window knows this much.
std::string zero_of(const std::string& key, const LayerStatus& layer) {
    Document document = Document::untitled(R"(astrosplat = 1
[[layer]]
name = "dust"
[layer.source]
meshes = [ { mesh = "plane", texture = "dust.png" } ]
)",
                                           "/nowhere/scene.toml");
    ViewState view;
    Status status;
    status.layers = {layer};
    Commands commands;
    Memory memory;
    std::vector<DrawnRow> rows;
    std::vector<DrawnItem> drawn;
    describe_current(memory, document, 1.0);
    Context context{{document, view, status, commands, drawn}, memory, rows};
    return zero_in_words(context, find(context, key)->spec);
}

TEST(PanelStates, ZerosThatAreNoAmountSayWhatIsUsed) {
    LayerStatus layer;
    EXPECT_EQ(zero_of("layer.dust.source.max_distance", layer), "Auto") << "as long as nobody knows";
    layer.radius_min = 0.0165;
    layer.histograms = [] {
        auto histograms = std::make_shared<LayerHistograms>();
        histograms->max_distance = 0.25;
        return histograms;
    }();
    EXPECT_EQ(zero_of("layer.dust.source.max_distance", layer), "Auto (0.250)");
    EXPECT_EQ(zero_of("layer.dust.look.radius.min", layer), "Auto (0.0165)");
    EXPECT_EQ(zero_of("layer.dust.look.reach", layer), "Auto (0.250)");
    EXPECT_EQ(zero_of("layer.dust.source.uv_width", layer), "Auto");
    EXPECT_EQ(zero_of("layer.dust.source.structure.height", layer), "Auto");
    layer.uv_width = 12.0;
    layer.body_height = 0.198;
    EXPECT_EQ(zero_of("layer.dust.source.uv_width", layer), "Auto (12.0)");
    EXPECT_EQ(zero_of("layer.dust.source.structure.height", layer), "Auto (0.198)");
    layer.stale = true;  // the set is that of another distance
    EXPECT_EQ(zero_of("layer.dust.source.max_distance", layer), "Auto");
    EXPECT_EQ(zero_of("layer.dust.source.structure.height", layer), "Auto");
}

}  // namespace
}  // namespace astrosplat::panel
