// Playing: the scene's frames at its speed, round and round, whatever the clock does.
#include "viewer/playback.h"

#include <gtest/gtest.h>

namespace astrosplat {
namespace {

struct PlaybackTest : testing::Test {
    Playback playback;
    ViewState view;
    OutputParams output;
    PlaybackTest() {
        output.frames = "10-12";
        output.fps = 4.0;
        view.frame = 10.0;
        view.playing = true;
    }
    double frame_at(double now) {
        playback.advance(view, output, now);
        return view.frame;
    }
};

TEST_F(PlaybackTest, AfterTheLastFrameComesTheFirst) {
    EXPECT_EQ(frame_at(100.0), 10.0);
    EXPECT_EQ(frame_at(100.125), 10.0);
    EXPECT_EQ(frame_at(100.25), 11.0);
    EXPECT_EQ(frame_at(100.5), 12.0);
    EXPECT_EQ(frame_at(100.75), 10.0);
}

TEST_F(PlaybackTest, FramesThatCannotBeDrawnInTimeAreLeftOut) {
    output.frames = "10-100";
    frame_at(100.0);
    EXPECT_EQ(frame_at(101.125), 14.0);
    EXPECT_EQ(frame_at(101.25), 15.0);  // the eighth of a second is not lost
}

TEST_F(PlaybackTest, APauseIsNotCaughtUp) {
    frame_at(100.0);
    view.playing = false;
    EXPECT_EQ(frame_at(101.0), 10.0);
    view.playing = true;
    EXPECT_EQ(frame_at(102.0), 10.0);
    EXPECT_EQ(frame_at(102.25), 11.0);
}

TEST(FirstFrame, IsTheEarliest) {
    Scene scene;
    scene.output.frames = "7-9,3";
    EXPECT_EQ(first_frame(scene), 3.0);
}

}  // namespace
}  // namespace astrosplat
