// Events that came between two slow frames, and the frames they are given to.
#include "viewer/input_queue.h"

#include <gtest/gtest.h>

namespace astrosplat {
namespace {

using Kind = InputEvent::Kind;

InputEvent at(Kind kind, double x) { return {kind, 0, 0, x, 0.0, 0.0}; }
InputEvent of(Kind kind, int code) { return {kind, code, 0, 0.0, 0.0, 0.0}; }

std::vector<std::vector<InputEvent>> frames_of(const std::vector<InputEvent>& events,
                                               Typing typing = Typing::shortcuts) {
    InputQueue queue;
    for (const InputEvent& event : events) queue.push(event);
    std::vector<std::vector<InputEvent>> frames;
    while (!queue.empty()) frames.push_back(queue.take(typing));
    return frames;
}

using Frames = std::vector<std::vector<InputEvent>>;

TEST(InputQueue, NothingIsTakenFromNothing) { EXPECT_TRUE(InputQueue().take().empty()); }

TEST(InputQueue, ADragEndsWhereItWasLetGo) {
    const InputEvent to_begin = at(Kind::move, 1), press = of(Kind::press, 0), half = at(Kind::move, 2),
                     end = at(Kind::move, 3), release = of(Kind::release, 0), away = at(Kind::move, 9);
    EXPECT_EQ(frames_of({to_begin, press, half, end, release, away}),
              (Frames{{to_begin}, {press}, {half, end}, {release}, {away}}));
}

TEST(InputQueue, ADoubleClickIsTwoClicks) {
    const InputEvent press = of(Kind::press, 0), release = of(Kind::release, 0);
    EXPECT_EQ(frames_of({press, release, press, release}), (Frames{{press}, {release}, {press}, {release}}));
}

TEST(InputQueue, ClicksAtTwoPlacesStayThere) {
    const InputEvent menu = at(Kind::move, 1), item = at(Kind::move, 2), press = of(Kind::press, 0),
                     release = of(Kind::release, 0);
    EXPECT_EQ(frames_of({menu, press, release, item, press, release}),
              (Frames{{menu}, {press}, {release}, {item}, {press}, {release}}));
}

TEST(InputQueue, MovesAndNotchesAreOneFrame) {
    const InputEvent a = at(Kind::move, 1), b = at(Kind::move, 2), notch = at(Kind::wheel, 1);
    EXPECT_EQ(frames_of({a, b, notch, notch}), (Frames{{a, b, notch, notch}}));
    EXPECT_EQ(frames_of({notch, a}), (Frames{{notch}, {a}})) << "the wheel would turn what lies elsewhere";
}

TEST(InputQueue, AShortPressOfAKeyIsSeen) {
    const InputEvent down = of(Kind::key_down, '0'), up = of(Kind::key_up, '0');
    EXPECT_EQ(frames_of({down, up}), (Frames{{down}, {up}}));
}

TEST(InputQueue, CtrlIsHeldForAsLongAsItsKey) {
    const InputEvent ctrl = of(Kind::key_down, 341), s = of(Kind::key_down, 'S'),
                     s_up = of(Kind::key_up, 'S'), ctrl_up = of(Kind::key_up, 341);
    EXPECT_EQ(frames_of({ctrl, s, ctrl_up, s_up}), (Frames{{ctrl}, {s}, {ctrl_up, s_up}}));
}

TEST(InputQueue, WhatIsTypedWaitsUntilItMay) {
    const InputEvent move = at(Kind::move, 1), key = of(Kind::key_down, '3'),
                     three = of(Kind::character, '3');
    InputQueue queue;
    for (const InputEvent& event : {move, key, three}) queue.push(event);
    EXPECT_EQ(queue.take(Typing::later), std::vector<InputEvent>{move});
    EXPECT_TRUE(queue.take(Typing::later).empty());
    EXPECT_EQ(queue.take(), (std::vector<InputEvent>{key, three}));
}

TEST(InputQueue, KeysAndCharactersKeepTheirOrder) {
    const InputEvent ctrl = of(Kind::key_down, 341), a = of(Kind::key_down, 'A'),
                     a_up = of(Kind::key_up, 'A'), ctrl_up = of(Kind::key_up, 341),
                     key = of(Kind::key_down, '3'), three = of(Kind::character, '3'),
                     key_up = of(Kind::key_up, '3'), enter = of(Kind::key_down, 257);
    EXPECT_EQ(frames_of({ctrl, a, a_up, ctrl_up, key, three, key_up, enter}),
              (Frames{{ctrl}, {a}, {a_up, ctrl_up, key, three}, {key_up, enter}}));
}

/// A word typed in no time is a word, however long a frame takes; Enter is after it, Left before what
/// follows.
TEST(InputQueue, AWordIsOneFrameOfAText) {
    std::vector<InputEvent> word;
    for (const char letter : {'n', 'n', 'e'})
        for (const InputEvent& event :
             {of(Kind::key_down, letter - 32), of(Kind::character, letter), of(Kind::key_up, letter - 32)})
            word.push_back(event);
    std::vector<InputEvent> typed = word;
    const InputEvent enter = of(Kind::key_down, 257), left = of(Kind::key_down, 263),
                     a = of(Kind::character, 'a');
    typed.insert(typed.end(), {enter, left, a});
    EXPECT_EQ(frames_of(typed, Typing::text), (Frames{word, {enter}, {left}, {a}}));
    EXPECT_GT(frames_of(word).size(), 2u) << "three shortcuts";
    const InputEvent ctrl = of(Kind::key_down, 341), up = of(Kind::key_up, 'V');
    InputEvent v = of(Kind::key_down, 'V');
    v.modifiers = 2;
    EXPECT_EQ(frames_of({a, ctrl, v, up}, Typing::text), (Frames{{a}, {ctrl}, {v}, {up}}));
}

TEST(InputQueue, AKeyBeforeAClickIsHeldInIt) {
    const InputEvent ctrl = of(Kind::key_down, 341), press = of(Kind::press, 0),
                     release = of(Kind::release, 0), ctrl_up = of(Kind::key_up, 341);
    EXPECT_EQ(frames_of({ctrl, press, release, ctrl_up}), (Frames{{ctrl}, {press}, {release}, {ctrl_up}}));
}

}  // namespace
}  // namespace astrosplat
