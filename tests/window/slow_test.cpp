// Input during one long frame takes effect afterwards, in its order.
#include "edit/keyframes.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

class WindowSlow : public WindowTest {};

TEST_F(WindowSlow, AValueIsKeyedAtTwoFramesBlindly) {
    start();
    const Pixels first = settled_frame();
    TestWindow& widgets = same_widgets();
    const float y = widgets.at("ruler").y, from = widgets.at("keyframe camera.position 1").x,
                to = widgets.at("keyframe camera.position 24").x;
    stop();
    person->click(diamond(power));
    person->drag({from, y}, {to - from, 0.0f});
    person->move({from, y});
    person->double_click(value_box(power));
    person->type("3.25");
    person->press("Return");
    person->press("ctrl+s");
    EXPECT_EQ(frame_pixels(), first);
    go_on();
    const auto keyframes = [&] {
        const Scene scene = saved();
        const Track* track = find_track(scene, power);
        return track ? track->keyframes : decltype(Track::keyframes)();
    };
    ASSERT_TRUE(comes_true([&] { return keyframes().size() == 2; })) << "it was not saved, or not as it was";
    EXPECT_EQ(keyframes()[0].frame, 1.0);
    EXPECT_EQ(keyframes()[0].value, std::vector<double>{1.0});
    EXPECT_EQ(keyframes()[1].frame, 24.0);
    EXPECT_EQ(keyframes()[1].value, std::vector<double>{3.25});
}

}  // namespace
}  // namespace astrosplat::test
