// What is to be read can be: switches stand out from their rows, tooltips lie beside what they explain.
#include <imgui_internal.h>

#include "gui/panel/panel.h"
#include "gui/panel/parts.h"
#include "gui/test_window.h"

namespace astrosplat {
namespace {

ImVec4 over(ImU32 top, ImU32 below) {
    const ImVec4 t = color4(top), b = color4(below);
    const auto mixed = [&](float upper, float lower) { return upper * t.w + lower * (1.0f - t.w); };
    return {mixed(t.x, b.x), mixed(t.y, b.y), mixed(t.z, b.z), 1.0f};
}

/// As WCAG 2 has it, 0..1.
double luminance(const ImVec4& c) {
    const auto linear = [](float v) {
        return v <= 0.04045f ? double(v) / 12.92 : std::pow((double(v) + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(c.x) + 0.7152 * linear(c.y) + 0.0722 * linear(c.z);
}

double contrast_of(ImU32 ink, ImU32 ground) {
    const double a = luminance(over(ink, ground)), b = luminance(color4(ground));
    return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05);
}

TEST(PlainSight, SwitchesOfLayersStandOutFromEveryRow) {
    TestWindow window(example_document());
    for (const int contrast : {0, 1}) {
        set_contrast(contrast);
        const ImU32 selected = ImGui::ColorConvertFloat4ToU32(over(color::selection, color::panel));
        for (const ImU32 row : {color::panel, selected})
            for (const bool on : {false, true}) {
                const panel::SwitchColors colors = panel::switch_colors(on, false);
                const ImU32 ground = colors.ground == color::none ? row : colors.ground;
                EXPECT_GE(contrast_of(colors.ink, ground), 3.0)
                    << contrast << " " << on << " " << (row == selected);
            }
    }
    set_contrast(0);
}

TEST(PlainSight, TooltipsOfThePanelLieBesideIt) {
    TestWindow window(example_document());
    const float panel = make_layout(window.view, 1600.0f, 900.0f, 1.0f).panel.x;
    const auto expect_beside = [&](glm::vec2 at) {
        window.hover(at);
        window.frame(60);
        const ImGuiWindow* const tip = ImGui::FindWindowByName("##Tooltip_00");
        ASSERT_TRUE(tip && tip->Active);
        EXPECT_LE(tip->Pos.x + tip->Size.x, panel);
        EXPECT_NEAR(tip->Pos.y, at.y, 20.0f);
    };
    const DrawnRow row = window.gui.panel().rows().at(1);
    expect_beside(row.label);
    window.drag(row.value, {30.0f, 0.0f});
    window.frame(60);
    const ImGuiWindow* const tip = ImGui::FindWindowByName("##Tooltip_00");
    EXPECT_FALSE(tip && tip->Active) << "whoever changes a value looks at the picture";
    window.hover({500.0f, 400.0f});
    expect_beside(
        {1600.0f - 12.0f - 14.0f, window.at("panel/Layers").y + 34.0f});  // Isolate of the first layer
}

}  // namespace
}  // namespace astrosplat
