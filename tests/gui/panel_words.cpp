// Numbers and values in words, as the side panel shows them; and how far a pixel of dragging goes.
#include "gui/panel/words.h"

#include <gtest/gtest.h>

namespace astrosplat::panel {
namespace {

TEST(PanelWords, FiguresAreThreeAtLeastAndFiveAtMost) {
    EXPECT_EQ(figures(0.35), "0.350");
    EXPECT_EQ(figures(1.0), "1.00");
    EXPECT_EQ(figures(45.0), "45.0");
    EXPECT_EQ(figures(12.345), "12.345");
    EXPECT_EQ(figures(2.487106), "2.4871");
    EXPECT_EQ(figures(0.008), "0.00800");
    EXPECT_EQ(figures(-812.0), "-812");
    EXPECT_EQ(figures(0.0), "0.00");
    EXPECT_EQ(figures(1e-9), short_number(1e-9));
}

TEST(PanelWords, ANarrowBoxShowsFewerFigures) {
    const auto within = [](std::size_t most) {
        return [most](const std::string& text) { return text.size() <= most; };
    };
    EXPECT_EQ(figures_that_fit(-12.3456, within(9)), "-12.346");
    EXPECT_EQ(figures_that_fit(-12.3456, within(6)), "-12.35");
    EXPECT_EQ(figures_that_fit(-12.3456, within(5)), "-12.3");
    EXPECT_EQ(figures_that_fit(0.008, within(5)), "0.008");
    EXPECT_EQ(figures_that_fit(1234.5, within(5)), "1234");
    EXPECT_EQ(figures_that_fit(-81234.0, within(3)),
              "-81 234");  // never other than what it is: the box ends it
}

TEST(PanelWords, LargeIntegersAreGrouped) {
    EXPECT_EQ(figures(std::int64_t{4096}), "4096");
    EXPECT_EQ(figures(std::int64_t{2000000}), "2 000 000");
    EXPECT_EQ(figures(std::int64_t{-65536}), "-65 536");
}

TEST(PanelWords, SharesArePercent) {
    EXPECT_EQ(percent(0.614), "61 %");
    EXPECT_EQ(percent(0.004), "0.4 %");
}

TEST(PanelWords, SetOptionsAreOneWordOfAShell) {
    EXPECT_EQ(set_option("layer.a.look.density", 0.5), "--set layer.a.look.density=0.5");
    EXPECT_EQ(set_option("camera.up", Value::List{0.0, 1.0, 0.0}), "--set 'camera.up=[0.0, 1.0, 0.0]'");
    EXPECT_EQ(set_option("provenance.title", "it's"), "--set 'provenance.title=\"it'\\''s\"'");
}

TEST(PanelWords, ADefaultOfZeroThatIsNoAmountSaysWhatItMeans) {
    ParameterSpec spec;
    spec.zero = "Auto";
    const auto has = [&](const Value& standard, const char* text) {
        return tooltip_text(spec, standard).find(text) != std::string::npos;
    };
    EXPECT_TRUE(has(0.0, "; default Auto (0.0)"));
    EXPECT_TRUE(has(0.5, "; default 0.5"));
    spec.zero = {};
    EXPECT_TRUE(has(0.0, "; default 0.0"));
}

TEST(PanelWords, DraggingRoundsToCleanNumbers) {
    ParameterSpec spec;
    spec.min = 0.0, spec.max = 1.0;
    const double step = drag_step(spec, 0.5);
    EXPECT_DOUBLE_EQ(step, 0.004);
    EXPECT_EQ(short_number(rounded_to_step(0.5 + 17 * step, step)), "0.568");
    ParameterSpec magnitude;
    magnitude.min = 1e-6, magnitude.slider_min = 0.01, magnitude.slider_max = 100.0;
    magnitude.scale = Scale::logarithmic;
    EXPECT_DOUBLE_EQ(drag_step(magnitude, 50.0), 0.5);  // of itself
    EXPECT_EQ(rounded_to_step(1234.5, 20.0), 1230.0);
    ParameterSpec open;  // on both sides of 0, and farther than the slider
    open.slider_min = -10.0, open.slider_max = 10.0;
    EXPECT_DOUBLE_EQ(drag_step(open, 0.0), 0.02);
    EXPECT_DOUBLE_EQ(drag_step(open, -2.0), 0.04);
    EXPECT_DOUBLE_EQ(drag_step(open, 1000.0), 0.08);
}

}  // namespace
}  // namespace astrosplat::panel
