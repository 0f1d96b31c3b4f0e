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

TEST_F(PlaybackTest, InAndOutPointsBoundIt) {
    output.frames = "1-100";
    view.play_first = 20.0;
    view.play_last = 22.0;
    frame_at(100.0);
    EXPECT_EQ(frame_at(100.25), 20.0);  // from outside
    EXPECT_EQ(frame_at(100.5), 21.0);
    EXPECT_EQ(frame_at(100.75), 22.0);
    EXPECT_EQ(frame_at(101.0), 20.0);
    view.play_last = 7.0;  // before the in point: as if it were not there
    for (int i = 0; i < 5; ++i) frame_at(101.25 + 0.25 * i);
    EXPECT_EQ(view.frame, 25.0);
}

TEST_F(PlaybackTest, ThereAndBackShowsTheEndsOnce) {
    view.play_mode = PlayMode::ping_pong;
    frame_at(100.0);
    std::vector<double> seen;
    for (int i = 1; i <= 6; ++i) seen.push_back(frame_at(100.0 + 0.25 * i));
    EXPECT_EQ(seen, (std::vector<double>{11, 12, 11, 10, 11, 12}));
}

TEST_F(PlaybackTest, OnceStopsAtTheEndAndBeginsAgain) {
    view.play_mode = PlayMode::once;
    frame_at(100.0);
    frame_at(100.25);
    frame_at(100.5);
    EXPECT_TRUE(view.playing);
    EXPECT_EQ(frame_at(100.75), 12.0);
    EXPECT_FALSE(view.playing);
    frame_at(101.0);
    view.playing = true;
    EXPECT_EQ(frame_at(102.0), 10.0);
}

TEST_F(PlaybackTest, EveryFrameIsShownAndTheRateToldAsItIs) {
    output.frames = "10-100";
    view.every_frame = true;
    frame_at(100.0);
    for (int i = 1; i <= 4; ++i) EXPECT_EQ(frame_at(100.0 + 0.5 * i), 10.0 + i);  // 2 a second, not 4
    EXPECT_NEAR(playback.shown_fps(), 2.0, 1e-9);
    view.every_frame = false;
    for (int i = 1; i <= 8; ++i) frame_at(102.0 + 0.25 * i);
    EXPECT_NEAR(playback.shown_fps(), 4.0, 1e-9);
}

TEST(FirstFrame, IsTheEarliest) {
    Scene scene;
    scene.output.frames = "7-9,3";
    EXPECT_EQ(first_frame(scene), 3.0);
}

}  // namespace
}  // namespace astrosplat
