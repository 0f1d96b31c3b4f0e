// A set is seen in the picture while it is generated.
#include <algorithm>

#include "window/window_test.h"

namespace astrosplat::test {
namespace {

class WindowGrowth : public WindowTest {
  protected:
    /// A set that takes seconds.
    void SetUp() override {
        WindowTest::SetUp();
        std::string text = text_of(scene_file);
        const std::string few = "count = 60000", many = "count = 20000000";
        text.replace(text.find(few), few.size(), many);
        write_text(scene_file, text);
    }
    /// More than the words over the picture.
    bool something_is_seen() const {
        const Pixels seen = frame_pixels();
        const auto is_lit = [](std::uint32_t rgb) {
            return std::max({rgb >> 16 & 0xff, rgb >> 8 & 0xff, rgb & 0xff}) > 60;
        };
        return std::count_if(seen.rgb.begin(), seen.rgb.end(), is_lit) > 3000;
    }
};

TEST_F(WindowGrowth, APartOfTheSetIsSeenBeforeItIsWhole) {
    start({scene_file.string(), "--no-cache", "--threads", "1"});
    ASSERT_TRUE(comes_true([&] { return something_is_seen(); }));
    // Escape gives up what is being generated, and leaves alone what is whole: nothing goes on until it is
    // pressed.
    stop();
    person->press("Escape");
    go_on();
    EXPECT_TRUE(comes_true([&] { return !something_is_seen(); })) << "what was given up stays in the picture";
    EXPECT_TRUE(running());
}

}  // namespace
}  // namespace astrosplat::test
