// A value gets keyframes at two frames through panel and timeline; what is saved plays the same again.
#include "edit/keyframes.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

class WindowTime : public WindowTest {
  protected:
    /// Takes the playhead to the last frame by mouse.
    void scrub_to_the_end() {
        TestWindow& widgets = same_widgets();
        const float y = widgets.at("ruler").y;
        const float first = widgets.at("keyframe camera.position 1").x,
                    last = widgets.at("keyframe camera.position 24").x;
        person->drag({first, y}, {last - first, 0.0f});
    }
};

TEST_F(WindowTime, AValueIsKeyedAtTwoFramesAndPlaysAgain) {
    start();
    const Pixels first = settled_frame();
    const Pixels timeline = pixels_of(&Layout::timeline);
    person->click(diamond(power));
    expect_title("scene.toml - edited");
    EXPECT_TRUE(comes_true([&] { return pixels_of(&Layout::timeline) != timeline; }))
        << "no row of keyframes";
    expect_settled(first);

    scrub_to_the_end();
    const Pixels before = settled_frame(first);
    person->double_click(value_box(power));
    person->type("3");
    person->press("Return");
    const Pixels last = settled_frame(before);
    person->press("ctrl+s");
    expect_title("scene.toml");

    const Scene scene = saved();
    const Track* track = find_track(scene, power);
    ASSERT_NE(track, nullptr);
    ASSERT_EQ(track->keyframes.size(), 2u);
    EXPECT_EQ(track->keyframes[0].frame, 1.0);
    EXPECT_EQ(track->keyframes[0].value, std::vector<double>{1.0});
    EXPECT_EQ(track->keyframes[1].frame, 24.0);
    EXPECT_EQ(track->keyframes[1].value, std::vector<double>{3.0});
    EXPECT_EQ(find_track(scene, "camera.position")->keyframes.size(), 2u);

    person->press("ctrl+q");
    EXPECT_EQ(end().code, 0);
    start();
    expect_settled(first);
    scrub_to_the_end();
    expect_settled(last);
}

}  // namespace
}  // namespace astrosplat::test
