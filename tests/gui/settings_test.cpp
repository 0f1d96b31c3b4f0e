// Edit > Settings: every choice of every row is taken, and kept when the dialog closes.
#include <gtest/gtest.h>

#include "gui/key_codes.h"
#include "gui/test_window.h"

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
