// The rows of colour management: a configuration is named, its displays and views are chosen, names of
// another one go.
#include <gtest/gtest.h>

#include "gui/panel/companions.h"
#include "gui/panel_driver.h"

namespace astrosplat {
namespace {

const char* const colors_scene = R"(astrosplat = 1
[output]
ocio = { config = "colors.ocio" }
[[layer]]
name = "dust"
[layer.source]
meshes = [ { mesh = "plane", texture = "dust.png" } ]
)";
const std::string ocio = "output.ocio.";

class PanelColors : public testing::Test {
  protected:
    explicit PanelColors(const char* scene = colors_scene) : d(scene) {
        ColorStatus color;
        color.config = {"/nowhere/colors.ocio",
                        {{"Screen", {"Film", "Plain"}, "Film"}, {"Projector", {"Pure"}, "Pure"}},
                        "Screen"};
        color.display = "Screen";
        color.view = "Film";
        d.status.color = color;
        d.show(PanelTab::output);
    }
    void choose(const std::string& key, const std::string& item) {
        d.click(d.row(ocio + key).value);
        d.frames(2);
        d.choose(item);
        d.frames(2);
    }
    std::string text(const std::string& key) { return *d.value(ocio + key).text(); }

    PanelDriver d;
};

TEST_F(PanelColors, DisplayAndViewAreChosenUndoneAndSaved) {
    choose("view", "Plain");
    EXPECT_EQ(text("view"), "Plain");
    choose("display", "Projector");
    EXPECT_EQ(text("display"), "Projector");
    EXPECT_EQ(text("view"), "") << "a view of the display before";
    choose("view", "Pure");
    const std::string saved = d.document.text_for("/nowhere/scene.toml");
    for (const char* line : {"colors.ocio", "\"Projector\"", "\"Pure\""})
        EXPECT_NE(saved.find(line), std::string::npos) << saved;
    d.document.undo();
    d.document.undo();
    EXPECT_EQ(text("display"), "");
    EXPECT_EQ(text("view"), "Plain");
    d.document.undo();
    EXPECT_FALSE(d.document.can_undo());
    EXPECT_EQ(d.document.text_for("/nowhere/scene.toml"), colors_scene);
}

TEST_F(PanelColors, TheProgramsOwnViewHidesMeanwhile) {
    EXPECT_FALSE(d.has_row("output.view"));
    EXPECT_TRUE(d.has_row("output.exposure"));
    d.panel.answer(ocio + "config", "", d.frame());
    d.show(PanelTab::output);
    EXPECT_TRUE(d.has_row("output.view"));
    EXPECT_FALSE(d.has_row(ocio + "view"));
    EXPECT_TRUE(d.has_row(ocio + "display")) << "the environment names a configuration";
    d.status.color.reset();
    d.show(PanelTab::output);
    EXPECT_FALSE(d.has_row(ocio + "display"));
    EXPECT_TRUE(d.has_row(ocio + "config"));
}

TEST(PanelColorCompanions, NamesOfAnotherConfigurationGo) {
    Scene scene;
    scene.output.ocio = {"a.ocio", "Screen", "Film", "linear"};
    EXPECT_EQ(panel::companions(scene, ocio + "config", "b.ocio").size(), 3u);
    EXPECT_EQ(panel::companions(scene, ocio + "display", "Projector").size(), 1u);
    EXPECT_TRUE(panel::companions(scene, ocio + "view", "Plain").empty());
}

}  // namespace
}  // namespace astrosplat
