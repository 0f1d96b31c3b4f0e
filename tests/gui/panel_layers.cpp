// The layers list, driven by mouse and keyboard: visibility, solo, names, order, additions; and what it asks
// of the viewer.
#include "gui/panel_driver.h"
#include "scene/describe.h"
#include "support/test.h"

namespace astrosplat {
namespace {

const char* const layers_scene = R"(astrosplat = 1
[[layer]]
name = "disk"
[layer.source]
meshes = [ { mesh = "plane", texture = "a.png" } ]
[layer.render]
opacity = 0.5
[[layer]]
name = "dust"
[layer.source]
meshes = [ { mesh = "plane", texture = "b.png" } ]
[[layer]]
name = "stars"
[layer.source]
meshes = [ { mesh = "plane", texture = "c.png" } ]
)";

// Rows of 28 px begin below a head of 32 px.
glm::vec2 at(int row, float x) { return {x, 32.0f + 28.0f * (float(row) + 0.5f)}; }
constexpr float eye = 24.0f, name = 90.0f, solo = 360.0f - 66.0f, holdout = 360.0f - 46.0f,
                isolate = 360.0f - 16.0f;

std::vector<std::string> names(const PanelDriver& d) { return layer_names(d.document.scene()); }
using Names = std::vector<std::string>;

class PanelLayersTest : public testing::Test {
  protected:
    PanelDriver d{layers_scene};
};

TEST_F(PanelLayersTest, AClickSelectsAndTheEyeHides) {
    d.click(at(1, name));
    EXPECT_EQ(d.view.layer, 1u);
    d.click(at(2, eye));
    EXPECT_FALSE(d.document.scene().layers[2].visible);
    EXPECT_TRUE(d.document.scene().layers[1].visible);
    d.document.undo();
    EXPECT_TRUE(d.document.scene().layers[2].visible);
}

TEST_F(PanelLayersTest, SoloIsOfTheWindowHoldoutAndIsolateOfTheScene) {
    d.click(at(1, solo));
    EXPECT_EQ(d.view.solo, std::set<std::string>{"dust"});
    EXPECT_FALSE(d.document.edited());
    d.click(at(1, holdout));
    EXPECT_TRUE(d.document.scene().layers[1].render.holdout);
    d.click(at(1, isolate));
    EXPECT_TRUE(d.document.scene().layers[1].render.isolate);
    d.click(at(1, solo));
    EXPECT_TRUE(d.view.solo.empty());
}

TEST_F(PanelLayersTest, ADoubleClickRenames) {
    d.click(at(1, solo));
    d.double_click(at(1, name));
    d.frames(2);
    d.type("clouds");
    d.tap(ImGuiKey_Enter);
    EXPECT_EQ(names(d), (Names{"disk", "clouds", "stars"}));
    EXPECT_EQ(d.view.solo, std::set<std::string>{"clouds"});
    EXPECT_FALSE(d.panel.busy());
    d.document.undo();
    EXPECT_EQ(names(d), (Names{"disk", "dust", "stars"}));
}

TEST_F(PanelLayersTest, ANameThatIsTakenIsRefused) {
    d.double_click(at(1, name));
    d.frames(2);
    d.type("disk");
    d.tap(ImGuiKey_Enter);
    EXPECT_EQ(names(d), (Names{"disk", "dust", "stars"}));
    EXPECT_HAS(d.panel.message(), "disk");
}

TEST_F(PanelLayersTest, DraggingChangesTheOrder) {
    d.drag(at(0, name), {0.0f, 56.0f});
    EXPECT_EQ(names(d), (Names{"dust", "stars", "disk"}));
    EXPECT_EQ(d.view.layer, 2u);
    d.drag(at(2, name), {0.0f, -28.0f});
    EXPECT_EQ(names(d), (Names{"dust", "disk", "stars"}));
    d.document.undo();
    d.document.undo();
    EXPECT_EQ(names(d), (Names{"disk", "dust", "stars"}));
    EXPECT_FALSE(d.document.can_undo());
}

void choose(PanelDriver& d, int row, const std::string& item) {
    d.click(at(row, name), 1);
    d.choose(item);
}

TEST_F(PanelLayersTest, TheMenuDuplicatesAndDeletes) {
    choose(d, 0, "Duplicate");
    ASSERT_EQ(d.document.scene().layers.size(), 4u);
    EXPECT_FLOAT_EQ(d.document.scene().layers[d.view.layer].render.opacity, 0.5f);
    choose(d, 2, "Delete");
    EXPECT_EQ(d.document.scene().layers.size(), 3u);
}

TEST_F(PanelLayersTest, LooksAreCopiedAndGivenToAll) {
    choose(d, 0, "Export look...");
    ASSERT_EQ(d.commands.size(), 1u);
    EXPECT_EQ(d.commands[0].kind, Command::Kind::save_look);
    choose(d, 0, "Copy look");
    choose(d, 2, "Paste look");
    EXPECT_FLOAT_EQ(d.document.scene().layers[2].render.opacity, 0.5f);
    EXPECT_FLOAT_EQ(d.document.scene().layers[1].render.opacity, 1.0f);
    choose(d, 0, "Look to all layers");
    EXPECT_FLOAT_EQ(d.document.scene().layers[1].render.opacity, 0.5f);
    EXPECT_EQ(d.document.undo_name(), "Look of disk to all layers");
}

TEST_F(PanelLayersTest, PlusAsksForAFileOrTakesAShape) {
    d.click({360.0f - 19.0f, 16.0f});
    EXPECT_TRUE(d.commands.empty());
    d.choose("File...");
    ASSERT_EQ(d.commands.size(), 1u);
    EXPECT_EQ(d.commands[0].kind, Command::Kind::import_file);
    d.click({360.0f - 19.0f, 16.0f});
    d.choose("Sphere");
    ASSERT_EQ(d.commands.size(), 2u);
    EXPECT_EQ(d.commands[1].kind, Command::Kind::add_shape);
    EXPECT_EQ(d.commands[1].text, "sphere");
}

TEST_F(PanelLayersTest, NothingMovesUnderTheHeldMouse) {
    d.status.layers.resize(3);
    d.show(PanelTab::source);
    const std::string count = "layer.disk.source.count";
    const glm::vec2 before = d.row(count).value;
    d.move(before);
    d.frames(2);
    d.press();
    d.status.layers[0].loading = true;
    d.status.layers[0].progress = 0.3f;
    d.status.layers[1].error = "no such file";
    d.frames(2);
    EXPECT_EQ(d.row(count).value, before);
    d.release();
    d.frames(2);
    EXPECT_NE(d.row(count).value, before) << "then there is room for the progress and the error";
}

TEST(PanelLayersOfAnother, TheLastLayerCanBeDeleted) {
    PanelDriver d(
        "astrosplat = 1\n[[layer]]\nname = \"only\"\n[layer.source]\nmeshes = [ { mesh = \"disk\" } ]\n");
    choose(d, 0, "Delete");
    EXPECT_TRUE(d.document.scene().layers.empty());
    d.frames(2);
    d.document.undo();
    EXPECT_EQ(names(d), Names{"only"});
}

TEST_F(PanelLayersTest, AFileParametersAnswerIsAnEdit) {
    const std::string key = "environment.image";
    d.panel.answer(key, "/nowhere/sky.png", d.frame());
    EXPECT_EQ(to_toml(d.value(key)), "\"/nowhere/sky.png\"");
    EXPECT_TRUE(d.commands.empty());
}

TEST_F(PanelLayersTest, LoadingCanBeCancelledAndStaleSetsMadeAnew) {
    d.status.layers.resize(3);
    d.status.layers[0].loading = true;
    d.status.layers[1].stale = true;
    d.frames(2);
    d.click({320.0f, 32.0f + 28.0f + 12.0f});
    d.click({310.0f, 32.0f + 56.0f + 28.0f + 12.0f});
    ASSERT_EQ(d.commands.size(), 2u);
    EXPECT_EQ(d.commands[0].kind, Command::Kind::cancel_load);
    EXPECT_EQ(d.commands[0].index, 0u);
    EXPECT_EQ(d.commands[1].kind, Command::Kind::regenerate);
    EXPECT_EQ(d.commands[1].index, 1u);
}

// A layer's parameters and the scene's are two panels, each with the tab it had last.
TEST_F(PanelLayersTest, TheSceneHasAPanelOfItsOwn) {
    const glm::vec2 layers{45.0f, 16.0f}, scene{100.0f, 16.0f};
    d.show(PanelTab::mixing);
    d.click(scene);
    EXPECT_EQ(d.view.tab, PanelTab::camera);
    d.frames(2);
    EXPECT_TRUE(d.has_row("camera.fov"));
    EXPECT_FALSE(d.has_row("layer.disk.render.blend"));
    d.show(PanelTab::output);
    d.click(layers);
    EXPECT_EQ(d.view.tab, PanelTab::mixing);
    d.frames(2);
    EXPECT_TRUE(d.has_row("layer.disk.render.blend"));
    d.click(scene);
    EXPECT_EQ(d.view.tab, PanelTab::output);
}

}  // namespace
}  // namespace astrosplat
