// Work, events and jobs that wait for their turn.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include "core/error.h"
#include "support/process_state.h"
#include "support/temp_folder.h"
#include "viewer/background_work.h"
#include "viewer/render_queue.h"
#include "viewer/window.h"

namespace astrosplat {
namespace {

// Results for a superseded request are dropped, with all that the request held.

struct Held {
    std::shared_ptr<const int> value;
    bool operator==(const Held&) const = default;
};
struct Sum {
    std::shared_ptr<const int> of;
    std::string error;
};

class LatestWorkTest : public testing::Test {
  protected:
    std::shared_ptr<const Sum> wait_for(const Held& request) {
        work.want(request);
        for (;;) {
            if (auto found = work.found(request)) return found;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    LatestWork<Held, Sum> work{[](const Held& request, const Progress&) { return Sum{request.value, {}}; }};
};

TEST_F(LatestWorkTest, ForgetsWhatItHeld) {
    auto value = std::make_shared<const int>(7);
    const std::weak_ptr<const int> watched = value;
    EXPECT_EQ(*wait_for({value})->of, 7);
    EXPECT_TRUE(work.asked([&](const Held& asked) { return asked.value == value; }));
    value.reset();
    EXPECT_FALSE(watched.expired()) << "else there is nothing to be forgotten";
    work.forget();
    for (int tries = 0; tries < 2000 && !watched.expired(); ++tries)  // the thread may be about to let go
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_TRUE(watched.expired());
    EXPECT_FALSE(work.working());
    EXPECT_FALSE(work.asked([](const Held&) { return true; }));
}

TEST_F(LatestWorkTest, BeginsAgainAfterThat) {
    const Held request{std::make_shared<const int>(3)};
    wait_for(request);
    work.forget();
    EXPECT_EQ(work.found(request), nullptr);
    EXPECT_EQ(*wait_for(request)->of, 3);
}

// Events that came between two slow frames, and the frames they are given to.

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

// Jobs of the window: how far one is by the lines that it says, and what one that is refused or waits leaves
// on the disk.

namespace fs = std::filesystem;

TEST(RenderingLine, SaysTheShareOfAllFrames) {
    EXPECT_EQ(share_of_line("astrosplat: preparing 50% eta 00:00:02"), 0.5f);
    EXPECT_EQ(share_of_line("astrosplat: frame 12 (3/10) 50% eta 00:04:10"), 0.25f);
    EXPECT_EQ(share_of_line("astrosplat: frame 12 (10/10) 100% eta 00:00:00"), 1.0f);
    for (const char* other : {"", "saved a.0001.exr", "37% of nothing", "about x% more", "37%"})
        EXPECT_FALSE(share_of_line(other)) << other;
}

TEST(RenderQueue, AJobThatIsRefusedLeavesNoFolder) {
    const TempFolder folder;
    const fs::path temporary = folder / "temporary";
    fs::create_directory(temporary);
    const fs::path preset = folder.file("look.toml", "astrosplat = 1\n[look]\ndensity = 0.5\n");
    const std::string scene =
        "astrosplat = 1\n[[layer]]\nname = \"a\"\npreset = \"look.toml\"\n"
        "[layer.source]\nmeshes = [ { mesh = \"plane\", texture = \"a.png\" } ]\n";
    const Document document = Document::open(folder.file("scene.toml", scene));
    fs::remove(preset);  // without it the scene cannot be written
    const Variable place("TMPDIR", temporary.c_str());
    RenderQueue jobs(SetCache{}, "astrosplat");
    EXPECT_THROW(jobs.add(make_render_task(document, RenderKind::range, 1.0), document), InputError);
    EXPECT_TRUE(jobs.jobs().empty());
    EXPECT_TRUE(fs::is_empty(temporary));
}

TEST(RenderQueue, AJobThatWaitsLeavesNothingBehind) {
    const TempFolder folder;
    const fs::path temporary = folder / "tmp";
    fs::create_directories(temporary);
    const Variable place("TMPDIR", temporary.c_str());
    const Document document =
        Document::open(folder.file("scene.toml",
                                   "astrosplat = 1\n[[layer]]\nname = \"a\"\n[layer.source]\n"
                                   "meshes = [ { mesh = \"plane\", texture = \"a.png\" } ]\n"));
    RenderQueue jobs(SetCache{}, "astrosplat");
    jobs.add(make_render_task(document, RenderKind::range, 1.0), document);
    EXPECT_FALSE(fs::is_empty(temporary)) << "the scene as it is now";
    jobs.cancel(1);
    EXPECT_TRUE(fs::is_empty(temporary));
    EXPECT_EQ(jobs.jobs()[0].state, QueuedJob::State::cancelled);
    jobs.remove(1);
    EXPECT_TRUE(jobs.jobs().empty());
    {
        RenderQueue dropped(SetCache{}, "astrosplat");
        dropped.add(make_render_task(document, RenderKind::range, 1.0), document);
    }
    EXPECT_TRUE(fs::is_empty(temporary));
}

}  // namespace
}  // namespace astrosplat
