// Where things lie, splitters, and the row of tools.
#include <gtest/gtest.h>

#include "gui/test_window.h"

namespace astrosplat {
namespace {

using Kind = Command::Kind;

TEST(Layout, CoversTheWindowWithoutGaps) {
    ViewState view;
    for (const bool panels : {true, false})
        for (const bool snapshots : {true, false}) {
            view.panels = panels;
            view.snapshots_open = snapshots;
            const Layout l = make_layout(view, 1600, 900, 1);
            float area = 0;
            for (const Rect& r :
                 {l.menu, l.tools, l.notice, l.viewport, l.snapshots, l.panel, l.timeline, l.status})
                area += r.width * r.height;
            EXPECT_EQ(area, 1600.0f * 900.0f);
        }
}

TEST(Layout, TheWindowKeepsToItAtOddScales) {
    TestWindow window(example_document(), 1600, 1000, 1.25f);
    const Rect viewport = make_layout(window.view, 1600, 1000, 1.25f).viewport;
    EXPECT_EQ(window.at("frame in view"),
              glm::vec2(viewport.x + viewport.width / 2, viewport.y + viewport.height / 2));
}

TEST(Layout, SplittersAreDraggedAndReset) {
    TestWindow window(example_document());
    window.drag(window.at("panel splitter"), {-100, 0});
    EXPECT_NEAR(window.view.panel_width, 460, 1);
    window.drag(window.at("panel splitter"), {-1000, 0});
    EXPECT_EQ(window.view.panel_width, 520);
    window.double_click(window.at("panel splitter"));
    EXPECT_EQ(window.view.panel_width, 360);
    window.drag(window.at("timeline splitter"), {0, -80});
    EXPECT_NEAR(window.view.timeline_height, 228, 1);
    window.click("fold timeline");
    EXPECT_EQ(make_layout(window.view, 1600, 900, 1).timeline.height, 36);
}

TEST(Layout, APictureOfTheViewportsSizeIsShownPixelByPixel) {
    const Rect viewport{0, 60, 1241, 667};
    const Rect fit = place_frame(ViewState{}, viewport, 1241, 667);
    EXPECT_EQ(fit.x, 0);
    EXPECT_EQ(fit.y, 60);
    EXPECT_EQ(fit.width, 1241);
    ViewState view;
    view.size = SizeMode::one_to_one;
    view.pan_px = {10, -5};
    view.zoom = 2;
    const Rect zoomed = place_frame(view, {0, 0, 1000, 500}, 100, 50);
    EXPECT_EQ(zoomed.x, 410);
    EXPECT_EQ(zoomed.y, 195);
    EXPECT_EQ(zoomed.width, 200);
}

/// In the smallest window, with the longest words.
TEST(Tools, DoNotLieOverEachOther) {
    TestWindow window(example_document(), 900, 600);
    window.status.reference = ReferenceStatus{0, 1.5, ""};
    window.view.compare_with = CompareWith::reference;
    window.view.compare = CompareMode::difference;
    window.frame(2);
    EXPECT_LT(window.at("compare/Diff").x + 30.0f, window.at("more tools").x);
    window.click("more tools");
    window.frame(2);
    EXPECT_TRUE(window.has("compare with"));
    EXPECT_TRUE(window.has("place/Place"));
}

TEST(Tools, ChooseViewSizeAndComparison) {
    TestWindow window(example_document());
    window.click("view/Side");
    EXPECT_EQ(window.view.view, ViewKind::side);
    window.click("view/Camera");
    EXPECT_EQ(window.view.view, ViewKind::camera);
    window.click("size/1:1");
    EXPECT_EQ(window.view.size, SizeMode::one_to_one);
    window.click("compare/A|B");
    EXPECT_EQ(window.view.compare, CompareMode::wipe);
    window.click("compare/Diff");
    EXPECT_EQ(window.view.compare, CompareMode::difference);
}

}  // namespace
}  // namespace astrosplat
