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
    bool ring_is_on(const std::string& key) const {
        for (const DrawnRow& row : window.gui.panel().rows())
            if (row.key == key) return glm::distance(window.ring(), row.value) < 10.0f;
        return false;
    }
    void tab_to(const std::string& key) {
        for (int i = 0; i < 60 && !(ring_shown() && ring_is_on(key)); ++i) window.tap(key_code::tab);
        EXPECT_TRUE(ring_is_on(key)) << key;
    }
};

/// What can be clicked can be reached.
class ReachTest : public KeyboardTest {
  protected:
    /// Of the controls whose names begin so: those that Tab does not come to.
    std::set<std::string> missed(const std::vector<std::string>& begins) {
        std::set<std::string> names;
        for (const DrawnItem& item : window.gui.drawn_items())
            for (const std::string& begin : begins)
                if (item.name == begin || (begin.back() == '/' && item.name.starts_with(begin)))
                    names.insert(item.name);
        EXPECT_GE(names.size(), begins.size());
        for (int i = 0; i < 200 && !names.empty(); ++i) {
            if (ring_shown())
                std::erase_if(names, [&](const std::string& name) {
                    return window.has(name) && glm::distance(window.ring(), window.at(name)) < 2.0f;
                });
            window.tap(key_code::tab);
        }
        return names;
    }
    static inline const std::set<std::string> none;
};

TEST_F(ReachTest, TheRingStopsAtControlsAlone) {
    for (int i = 0; i < 150; ++i) {
        window.tap(key_code::tab);
        const ImRect area = ImGui::GetCurrentContext()->NavWindow->NavRectRel[0];
        EXPECT_LT(area.GetWidth() * area.GetHeight(), 800.0f * 40.0f) << i;
    }
}

TEST_F(ReachTest, ToolsNoticeAndTimelineHeader) {
    window.view.hint_open = window.view.snapshots_open = true;
    window.frame(2);
    window.tap(key_code::f6);
    EXPECT_EQ(
        missed({"view/", "size/", "compare/", "display", "exposure", "preview", "engine", "close hint",
                "take snapshot", "play", "frame", "range", "fps", "playing/", "graph", "fold timeline"}),
        none);
}

TEST_F(ReachTest, TheTimelinesHeaderIsFired) {
    for (int i = 0; i < 3; ++i) window.tap(key_code::f6);  // panel, tools, timeline
    EXPECT_LT(glm::distance(window.ring(), window.at("play")), 2.0f);
    window.tap(key_code::space);
    EXPECT_TRUE(window.view.playing);
    window.tap(key_code::space);
    window.tap(key_code::tab);  // to a field: what is typed is its value
    window.type("7");
    window.tap(key_code::enter);
    EXPECT_EQ(window.view.frame, 7.0);
    window.tap(key_code::f6);
    EXPECT_GT(window.ring().x, make_layout(window.view, 1600, 900, 1).panel.x) << "and round";
}

TEST_F(ReachTest, WhatAPictureWasTakenForIsChosenFirst) {
    window.view.start.emplace(PictureStart{"m51.png"});
    window.frame(3);
    window.tap(key_code::tab);
    EXPECT_EQ(missed({"start/"}), none);
    for (int i = 0; i < 20 && glm::distance(window.ring(), window.at("start/Make a film")) > 2.0f; ++i)
        window.tap(key_code::tab);
    window.tap(key_code::enter);
    EXPECT_EQ(window.take_only(Command::Kind::start_again).text, "film");
    window.tap(key_code::f6);
    EXPECT_GT(window.ring().x, make_layout(window.view, 1600, 900, 1).panel.x);
}

TEST_F(ReachTest, Dialogs) {
    window.tap('R', true);
    EXPECT_EQ(missed({"render/"}), std::set<std::string>{"render/takes"}) << "which is a text";
    window.tap(key_code::escape);
    window.view.render_open = false;
    window.view.settings_open = true;
    window.frame(3);
    EXPECT_EQ(missed({"settings/"}), none);
    window.view.settings_open = false;
    window.view.queue_open = true;
    window.status.jobs.push_back(running_job_of("Rendering", 0.5f));
    window.frame(3);
    EXPECT_EQ(missed({"queue/"}), none);
}

TEST_F(ReachTest, EnterInATextAnswersItsDialogWhereverTheRingHasBeen) {
    window.tap(key_code::tab);
    window.tap(key_code::f12);
    window.frame(3);
    window.type("seen.png");
    window.tap(key_code::enter);
    for (int i = 0; i < 100 && window.has("file/Save"); ++i) {
        usleep(10'000);  // the disk is asked
        window.frame();
    }
    EXPECT_TRUE(window.take_only(Command::Kind::screenshot).path.filename().string().ends_with("seen.png"));
}

TEST_F(ReachTest, TheFileDialog) {
    window.tap('O', true);
    window.frame(3);
    window.tap(key_code::f6);  // Tab completes the path
    EXPECT_EQ(
        missed({"place/", "file/by Name", "file/by Size", "file/All files", "file/Cancel", "file/Open"}),
        none);
}

TEST_F(KeyboardTest, AltAloneOpensTheMenusAsF10Does) {
    const auto alt = [&](const std::function<void()>& meanwhile) {
        ImGui::GetIO().KeysDown[key_code::left_alt] = true;
        window.hold(false, false, true);
        window.frame();
        meanwhile();
        ImGui::GetIO().KeysDown[key_code::left_alt] = false;
        window.hold(false, false, false);
        window.frame(4);
    };
    alt([&] { window.drag({500, 400}, {40, 10}); });
    EXPECT_FALSE(any_popup()) << "the camera was turned";
    alt([] {});
    EXPECT_TRUE(window.has("File/Open..."));
    EXPECT_TRUE(ring_shown());
}

TEST_F(KeyboardTest, WhatIsAutomaticIsTypedAnew) {
    window.tap('K', true);
    window.frame(3);
    window.type("source.voxels");
    window.tap(key_code::enter);
    ASSERT_TRUE(ring_is_on("layer.dust.source.voxels"));
    window.tap(key_code::enter);
    window.tap(key_code::end);
    window.type("4 5 6");
    window.tap(key_code::enter);
    EXPECT_EQ(window.document.scene().layers[0].source.voxels, glm::i64vec3(4, 5, 6));
}

const std::string alpha_gain = "layer.dust.look.alpha.gain";

TEST_F(KeyboardTest, UntilThereIsARingKeysAreTheTimelines) {
    window.tap(key_code::right);
    EXPECT_EQ(window.view.frame, 2.0);
    EXPECT_FALSE(ring_shown());
    window.tap(key_code::tab);
    EXPECT_TRUE(ring_shown());
    EXPECT_GT(window.ring().x, make_layout(window.view, 1600, 900, 1).panel.x) << "the panel comes first";
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
    EXPECT_LT(glm::distance(window.ring(), window.at("view/Camera")), 4.0f);
    window.tap(key_code::right);
    EXPECT_LT(glm::distance(window.ring(), window.at("view/Free")), 4.0f);
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
    for (int i = 0; i < 6 && glm::distance(window.ring(), window.at("Help/Log")) > 4.0f; ++i)
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
    for (int i = 0;
         i < 4 && !(ring_shown() && glm::distance(window.ring(), window.at("unsaved/Cancel")) < 4.0f); ++i)
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
