// The window without a mouse: the ring, menus and the field that finds everything.
#include <imgui_internal.h>

#include "gui/panel/panel.h"
#include "gui/parts.h"
#include "gui/test_window.h"
#include "gui/widgets.h"
#include "support/test.h"

namespace astrosplat {
namespace {

class KeyboardTest : public ExampleWindow {
  protected:
    /// Middle of the ring, px; the test fails where there is none.
    glm::vec2 ring() const {
        const ImGuiContext& g = *ImGui::GetCurrentContext();
        EXPECT_TRUE(ring_shown());
        if (!ring_shown()) return {};
        const ImVec2 in_window = g.NavWindow->NavRectRel[g.NavLayer].GetCenter(),
                     at = g.NavWindow->DC.CursorStartPos;
        return {at.x + in_window.x, at.y + in_window.y};
    }
    bool ring_is_on(const std::string& key) const {
        for (const DrawnRow& row : window.gui.panel().rows())
            if (row.key == key) return glm::distance(ring(), row.value) < 10.0f;
        return false;
    }
    void tab_to(const std::string& key) {
        for (int i = 0; i < 60 && !(ring_shown() && ring_is_on(key)); ++i) window.tap(key_code::tab);
        EXPECT_TRUE(ring_is_on(key)) << key;
    }
};

const std::string alpha_gain = "layer.dust.look.alpha.gain";

TEST_F(KeyboardTest, UntilThereIsARingKeysAreTheTimelines) {
    window.tap(key_code::right);
    EXPECT_EQ(window.view.frame, 2.0);
    EXPECT_FALSE(ring_shown());
    window.tap(key_code::tab);
    EXPECT_TRUE(ring_shown());
    EXPECT_GT(ring().x, make_layout(window.view, 1600, 900, 1).panel.x) << "the panel comes first";
    window.tap(key_code::right);
    window.tap(key_code::n7);
    EXPECT_EQ(window.view.frame, 2.0);
    EXPECT_EQ(window.view.view, ViewKind::camera) << "no digit falls through";
    window.tap(key_code::escape);
    EXPECT_FALSE(ring_shown());
    window.tap(key_code::right);
    EXPECT_EQ(window.view.frame, 3.0);
    window.tap(key_code::tab);
    window.click(glm::vec2(500, 400));
    EXPECT_FALSE(ring_shown()) << "a click takes it away";
}

TEST_F(KeyboardTest, ASwitchIsPressedAndThePanelsTabsAreReached) {
    window.tap(key_code::tab);  // Layers
    window.tap(key_code::tab);  // Scene
    window.tap(key_code::space);
    EXPECT_EQ(window.view.tab, PanelTab::camera);
    EXPECT_FALSE(window.view.playing);
    EXPECT_TRUE(ring_shown());
    window.tap(key_code::tab, false, true);
    window.tap(key_code::enter);
    EXPECT_TRUE(is_of_layer(window.view.tab));
}

TEST_F(KeyboardTest, EnterTypesAValueAndTheRingStays) {
    window.view.tab = PanelTab::look;
    window.frame();
    tab_to(alpha_gain);
    window.tap(key_code::enter);
    EXPECT_TRUE(window.gui.panel().busy());
    window.type("0.25");
    window.tap(key_code::enter);
    EXPECT_EQ(window.document.scene().layers[0].look.alpha.gain, 0.25f);
    EXPECT_TRUE(ring_is_on(alpha_gain));
    window.tap(key_code::enter);
    window.type("0.75");
    window.tap(key_code::escape);
    EXPECT_EQ(window.document.scene().layers[0].look.alpha.gain, 0.25f) << "Escape drops it";
    window.tap(key_code::escape);
    EXPECT_FALSE(ring_shown());
}

TEST_F(KeyboardTest, F6GoesToTheToolsAndArrowsAlongThem) {
    window.tap(key_code::f6);
    window.tap(key_code::f6);
    EXPECT_LT(glm::distance(ring(), window.at("view/Camera")), 4.0f);
    window.tap(key_code::right);
    EXPECT_LT(glm::distance(ring(), window.at("view/Free")), 4.0f);
    window.tap(key_code::enter);
    EXPECT_EQ(window.view.view, ViewKind::free);
}

TEST_F(KeyboardTest, MenusOpenByAltAndF10) {
    window.tap(key_code::f10);
    EXPECT_TRUE(window.has("File/Open..."));
    window.tap(key_code::down);  // the first opens a menu of its own
    window.tap(key_code::right);
    EXPECT_TRUE(window.has("Edit/Store as B"));
    EXPECT_FALSE(window.has("File/Open..."));
    window.tap(key_code::escape);
    EXPECT_FALSE(any_popup());
    EXPECT_EQ(window.view.frame, 1.0);
    window.hold(false, false, true);
    ImGui::GetIO().KeysDown['H'] = true;
    window.frame();
    ImGui::GetIO().KeysDown['H'] = false;
    window.hold(false, false, false);
    window.frame(3);
    ASSERT_TRUE(window.has("Help/Log"));
    EXPECT_TRUE(window.document.scene().layers[0].visible);
    for (int i = 0; i < 6 && glm::distance(ring(), window.at("Help/Log")) > 4.0f; ++i)
        window.tap(key_code::down);
    window.tap(key_code::enter);
    EXPECT_TRUE(window.view.log_open);
    EXPECT_TRUE(window.has("log/Close"));
    window.tap(key_code::escape);
    EXPECT_FALSE(any_popup());
}

TEST_F(KeyboardTest, ADialogIsAnsweredByTabAndEnter) {
    make_edited(window);
    window.tap('Q', true);
    ASSERT_TRUE(window.has("unsaved/Cancel"));
    for (int i = 0; i < 4 && !(ring_shown() && glm::distance(ring(), window.at("unsaved/Cancel")) < 4.0f);
         ++i)
        window.tap(key_code::tab);
    window.tap(key_code::enter);
    EXPECT_FALSE(any_popup());
    EXPECT_TRUE(window.take_commands().empty());
}

TEST_F(KeyboardTest, CommandsAndValuesAreFound) {
    const auto find = [&](const std::string& words) {
        window.tap('K', true);
        window.frame(3);
        window.type(words);
    };
    find("layer visible");
    EXPECT_TRUE(window.has("find/Visible"));
    EXPECT_FALSE(window.has("find/Open..."));
    window.tap(key_code::enter);
    EXPECT_FALSE(window.document.scene().layers[0].visible);
    EXPECT_FALSE(window.view.find_open);
    find("alpha.gain");
    window.tap(key_code::enter);
    EXPECT_EQ(window.view.tab, PanelTab::look);
    EXPECT_TRUE(ring_is_on(alpha_gain));
    find("output.fps");
    window.tap(key_code::enter);
    EXPECT_EQ(window.view.tab, PanelTab::output);
    EXPECT_TRUE(ring_is_on("output.fps"));
    window.tap(key_code::enter);
    window.type("30");
    window.tap(key_code::enter);
    EXPECT_EQ(window.document.scene().output.fps, 30.0);
    find("no such thing");
    window.tap(key_code::enter);
    EXPECT_TRUE(window.view.find_open);
    window.tap(key_code::escape);
    EXPECT_FALSE(window.view.find_open);
    find("frame");
    window.tap(key_code::down);
    window.tap(key_code::enter);
    EXPECT_FALSE(window.view.find_open);
}

}  // namespace
}  // namespace astrosplat
