// The timeline's first row by mouse and keys: frames, rate, how they are played.
#include <gtest/gtest.h>

#include "gui/key_codes.h"
#include "gui/test_window.h"

namespace astrosplat {
namespace {

struct TimelineHeader : testing::Test {
    TestWindow window{example_document()};
    void type_into(const std::string& name, const std::string& text, bool twice) {
        if (twice)
            window.double_click(window.at(name));
        else
            window.click(name);
        window.tap('A', true);
        window.type(text);
        window.tap(key_code::enter);
        window.frame(2);
    }
};

TEST_F(TimelineHeader, FramesAreTyped) {
    type_into("range", "1-48", false);
    EXPECT_EQ(window.document.scene().output.frames, "1-48");
    type_into("range", "1-", false);
    EXPECT_EQ(window.document.scene().output.frames, "1-48") << "nonsense changes nothing";
    window.tap('Z', true);
    EXPECT_EQ(window.document.scene().output.frames, "1-240");
}

TEST_F(TimelineHeader, TheRateIsTyped) {
    type_into("fps", "30", true);
    EXPECT_EQ(window.document.scene().output.fps, 30.0);
    window.tap('Z', true);
    EXPECT_EQ(window.document.scene().output.fps, 24.0);
}

TEST_F(TimelineHeader, WhatComesAfterTheLastFrameIsChosen) {
    window.click("playing/Loop");
    EXPECT_EQ(window.view.play_mode, PlayMode::ping_pong);
    window.frame(2);
    window.click("playing/Ping-pong");
    EXPECT_EQ(window.view.play_mode, PlayMode::once);
    window.frame(2);
    window.click("playing/Once");
    EXPECT_EQ(window.view.play_mode, PlayMode::loop);
    window.click("playing/Every frame");
    EXPECT_TRUE(window.view.every_frame);
    window.click("playing/Rendered");
    EXPECT_TRUE(window.view.show_rendered);
}

TEST_F(TimelineHeader, InAndOutPointsAreSetByKeysAndDragged) {
    window.view.frame = 40;
    window.tap('I');
    window.view.frame = 80;
    window.tap('O');
    window.frame(2);
    EXPECT_EQ(window.view.play_first, 40.0);
    EXPECT_EQ(window.view.play_last, 80.0);
    const float per_frame =
        (window.at("keyframe camera.position 240").x - window.at("keyframe camera.position 90").x) / 150.0f;
    window.drag(window.at("out point"), {60 * per_frame, 0});
    EXPECT_NEAR(*window.view.play_last, 140.0, 1.0);
    window.drag(window.at("in point"), {500 * per_frame, 0});
    EXPECT_EQ(window.view.play_first, window.view.play_last) << "it stays before the out point";
    EXPECT_EQ(window.view.frame, 80.0) << "the playhead stays";
    window.tap('I', false, true);
    EXPECT_FALSE(window.view.play_first || window.view.play_last);
}

TEST_F(TimelineHeader, TheRateThatIsReachedIsTold) {
    window.move({-100, -100});
    window.frame(2);
    const auto still = window.picture(Style::schematic).pixels;
    window.status.played_fps = 11.5;
    window.frame(2);
    EXPECT_FALSE(window.picture(Style::schematic).pixels == still);
}

}  // namespace
}  // namespace astrosplat
