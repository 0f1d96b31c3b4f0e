// Edit > Settings: every choice of every row is taken, and kept when the dialog closes.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "core/color.h"
#include "core/real.h"
#include "gui/key_codes.h"
#include "gui/test_window.h"
#include "gui/theme.h"

namespace astrosplat {
namespace {

using Kind = Command::Kind;

TEST(SettingsDialog, EveryChoiceCanBeClicked) {
    TestWindow window(example_document());
    window.choose("Edit/Settings...");
    window.frame(2);
    for (const SettingRow& row : setting_rows())
        for (std::size_t i = row.choices.size(); i-- > 0;) {
            window.click(std::string("settings/") + row.name + "/" + row.choices[i].label);
            EXPECT_EQ(window.view.settings.*row.value, row.choices[i].value) << row.name;
        }
    EXPECT_NE(window.view.settings, Settings());
    window.click("settings/threads/2");
    window.click("settings/Done");
    EXPECT_FALSE(window.view.settings_open);
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::keep_settings});
    EXPECT_EQ(window.view.settings.threads, 2);
}

TEST(SettingsDialog, TheCacheFolderIsTyped) {
    TestWindow window(example_document());
    window.choose("Edit/Settings...");
    window.frame(2);
    window.click("settings/cache_folder");
    window.type("/a/folder");
    EXPECT_EQ(window.view.settings.cache_folder, "/a/folder");
    window.click("settings/Done");
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::keep_settings});
}

/// W3C's WCAG 2.1, "relative luminance" and "contrast ratio".
double luminance(ImU32 c) {
    double sum = 0.0;
    for (const auto& [shift, weight] :
         {std::pair{IM_COL32_R_SHIFT, 0.2126}, {IM_COL32_G_SHIFT, 0.7152}, {IM_COL32_B_SHIFT, 0.0722}})
        sum += weight * real::srgb_to_linear(double(c >> shift & 255) / 255.0);
    return sum;
}
double contrast(ImU32 a, ImU32 b) {
    const double one = luminance(a), other = luminance(b);
    return (std::max(one, other) + 0.05) / (std::min(one, other) + 0.05);
}

// The levels AA for normal, AAA for high contrast.
TEST(Contrast, IsAsHighAsSaid) {
    TestWindow window(example_document());
    for (const int level : {0, 1}) {
        set_contrast(level);
        EXPECT_EQ(theme_contrast(), level);
        for (const ImU32 back : {color::window, color::panel, color::field}) {
            EXPECT_GT(contrast(color::text, back), level ? 12.0 : 7.0);
            EXPECT_GT(contrast(color::dim, back), level ? 7.0 : 4.0);
            EXPECT_GT(contrast(color::error, back), level ? 6.0 : 3.0);
        }
        EXPECT_GT(contrast(color::line, color::panel), level ? 3.0 : 1.0) << "WCAG 1.4.11";
        EXPECT_EQ(ImGui::GetStyle().Colors[ImGuiCol_Text].x, color4(color::text).x);
    }
    const ImU32 high = color::dim;
    set_contrast(0);
    EXPECT_NE(color::dim, high);
}

TEST(SettingsDialog, EscapeClosesAndKeeps) {
    TestWindow window(example_document());
    window.choose("Edit/Settings...");
    window.frame(2);
    window.tap(key_code::escape);
    window.frame(2);
    EXPECT_FALSE(window.view.settings_open);
    EXPECT_EQ(kinds(window.take_commands()), std::vector<Kind>{Kind::keep_settings});
}

}  // namespace
}  // namespace astrosplat
