// Curves, levels and lists of the Look and Source tabs, driven by the mouse.
#include <gtest/gtest.h>

#include "gui/panel_driver.h"

namespace astrosplat {
namespace {

const char* const curves_scene = R"(astrosplat = 1
[[layer]]
name = "dust"
[layer.source]
meshes = [ { mesh = "plane", texture = "a.fits" } ]
[layer.look.pdf]
shape = "curve"
points = [[0.0, 1.0], [1.0, 0.0]]
)";
const std::string points = "layer.dust.look.pdf.points";

using Points = std::vector<glm::vec2>;
const Points& curve(const PanelDriver& d) { return d.document.scene().layers[0].look.pdf.points; }

// The plot of 84 px stands above the row of its shape: captions of 17 px and the gaps of rows between.
glm::vec2 on_plot(const PanelDriver& d, float x, float y) {
    const DrawnRow shape = d.row("layer.dust.look.pdf.shape");
    const glm::vec4 plot = d.panel.plot_area(points);  // x, y, width, height
    EXPECT_LT(plot.y, shape.value.y);
    return {plot.x + x * plot.z, plot.y + plot.w - 2.0f - y * (plot.w - 5.0f)};
}

TEST(PanelCurves, AClickAddsAPointOneUndoStep) {
    PanelDriver d(curves_scene);
    d.show(PanelTab::look);
    d.click(on_plot(d, 0.5f, 0.25f));
    ASSERT_EQ(curve(d).size(), 3u);
    EXPECT_NEAR(curve(d)[1].x, 0.5f, 0.01f);
    EXPECT_NEAR(curve(d)[1].y, 0.25f, 0.02f);
    d.document.undo();
    EXPECT_EQ(curve(d).size(), 2u);
    EXPECT_FALSE(d.document.can_undo());
}

TEST(PanelCurves, ADragMovesAPointButNotPastItsNeighbours) {
    PanelDriver d(curves_scene);
    d.show(PanelTab::look);
    d.click(on_plot(d, 0.5f, 0.25f));
    const glm::vec2 from = on_plot(d, 0.5f, 0.25f);
    d.drag(from, on_plot(d, 0.75f, 0.5f) - from);
    ASSERT_EQ(curve(d).size(), 3u);
    EXPECT_NEAR(curve(d)[1].x, 0.75f, 0.01f);
    EXPECT_NEAR(curve(d)[1].y, 0.5f, 0.02f);
    const glm::vec2 again = on_plot(d, 0.75f, 0.5f);
    d.drag(again, {400.0f, 0.0f});
    EXPECT_LT(curve(d)[1].x, curve(d)[2].x);
    d.document.undo();
    EXPECT_NEAR(curve(d)[1].x, 0.75f, 0.01f);
}

TEST(PanelCurves, ARightClickDeletesDownToTwoPoints) {
    PanelDriver d(curves_scene);
    d.show(PanelTab::look);
    d.click(on_plot(d, 0.5f, 0.25f));
    d.click(on_plot(d, 0.5f, 0.25f), 1);
    EXPECT_EQ(curve(d).size(), 2u);
    d.click(on_plot(d, 0.0f, 1.0f), 1);
    EXPECT_EQ(curve(d), (Points{{0.0f, 1.0f}, {1.0f, 0.0f}}));
}

TEST(PanelCurves, ArrowsNudgeTheSelectedPoint) {
    PanelDriver d(curves_scene);
    d.show(PanelTab::look);
    d.click(on_plot(d, 0.5f, 0.25f));
    const glm::vec2 before = curve(d)[1];
    d.tap(ImGuiKey_RightArrow);
    d.tap(ImGuiKey_UpArrow);
    EXPECT_NEAR(curve(d)[1].x, before.x + 0.01f, 1e-5f);
    EXPECT_NEAR(curve(d)[1].y, before.y + 0.01f, 1e-5f);
}

TEST(PanelCurves, AtMostSixteenPoints) {
    PanelDriver d(curves_scene);
    d.show(PanelTab::look);
    for (int i = 0; i < 20; ++i)
        d.click(on_plot(d, 0.04f + 0.045f * static_cast<float>(i), i % 2 ? 0.3f : 0.7f));
    EXPECT_EQ(curve(d).size(), 16u);
    EXPECT_EQ(d.panel.message(), "");
}

const std::string black = "layer.dust.source.black", white = "layer.dust.source.white";

void tell_values(PanelDriver& d, double lo, double hi) {
    auto histograms = std::make_shared<LayerHistograms>();
    histograms->values.share.assign(64, 0.5f);
    histograms->values.lo = lo;
    histograms->values.hi = hi;
    histograms->values.black = lo + 0.1 * (hi - lo);
    histograms->values.white = hi - 0.1 * (hi - lo);
    d.status.layers.resize(1);
    d.status.layers[0].histograms = histograms;
}

TEST(PanelCurves, RowsOfLevelsAreDraggedAsFastAsTheDataIsWide) {
    for (const double wide : {1e-3, 1e5}) {
        PanelDriver d(curves_scene);
        tell_values(d, 0.0, wide);
        d.document.set(black, 0.5 * wide, 1.0);
        d.show(PanelTab::source);
        d.drag(d.row(black).value, {-50.0f, 0.0f});
        EXPECT_NEAR(d.value(black).number() / wide, 0.3, 0.005) << "250 px are the whole range";
    }
}

TEST(PanelCurves, BlackAndWhiteAreDraggedOverTheHistogram) {
    PanelDriver d(curves_scene);
    tell_values(d, 0.0, 1000.0);
    d.show(PanelTab::source);
    EXPECT_EQ(d.value(black), Value("auto"));
    const glm::vec4 plot = d.panel.plot_area(black);
    const float middle = plot.y + plot.w * 0.5f;
    d.drag({plot.x + 0.1f * plot.z, middle}, {0.1f * plot.z, 0.0f});
    ASSERT_TRUE(d.value(black).is_number());
    EXPECT_NEAR(d.value(black).number(), 200.0, 5.0);
    d.drag({plot.x + 0.9f * plot.z, middle}, {-0.9f * plot.z, 0.0f});
    EXPECT_GT(d.value(white).number(), d.value(black).number());  // never past each other
    d.document.undo();
    d.document.undo();
    EXPECT_EQ(d.value(black), Value("auto"));
    EXPECT_FALSE(d.document.can_undo());
}

}  // namespace
}  // namespace astrosplat
