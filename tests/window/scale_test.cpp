// A screen of many small pixels: the window is as large to the eye as on any other.
#include "edit/preferences.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

class WindowScale : public WindowTest {
  protected:
    /// The window's size on a screen of that size whose desktop asks for scale 2, and what is kept of it.
    Area opened_on(int screen_width, int screen_height) {
        screen.emplace(screen_width, screen_height);
        person.emplace(screen->display());
        screen->set_dpi(192);
        start();
        const Area area = screen->window_area();
        person->press("ctrl+q");
        EXPECT_TRUE(comes_true([&] { return !running(); }));
        kept = load_preferences(folder / "home/config/astrosplat/viewer.json");
        return area;
    }
    Preferences kept;
};

TEST_F(WindowScale, IsThatOfTheScreen) {
    const Area area = opened_on(2 * width + 100, 2 * height + 100);
    EXPECT_EQ(area.width, 2 * width);
    EXPECT_EQ(area.height, 2 * height);
    EXPECT_EQ(kept.window_width, width);
    EXPECT_EQ(kept.window_height, height);
}

TEST_F(WindowScale, IsNoReasonToBeLargerThanTheScreen) {
    const Area area = opened_on(2 * width - 400, height);
    EXPECT_EQ(area.width, 2 * width - 400);
    EXPECT_EQ(area.height, height);
}

}  // namespace
}  // namespace astrosplat::test
