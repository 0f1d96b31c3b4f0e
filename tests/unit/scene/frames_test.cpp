// Frame lists.
#include "scene/frames.h"
#include "scene_texts.h"

namespace astrosplat::test {
namespace {

using Frames = std::vector<std::int64_t>;

std::string refusal(const std::string& text) {
    try {
        parse_frames(text, "--frames");
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(Frames, ListsRangesAndSteps) {
    EXPECT_EQ(parse_frames("5", ""), (Frames{5}));
    EXPECT_EQ(parse_frames("1-3, 7", ""), (Frames{1, 2, 3, 7}));
    EXPECT_EQ(parse_frames("10-15x2", ""), (Frames{10, 12, 14}));
    EXPECT_EQ(parse_frames("10-16:3", ""), (Frames{10, 13, 16}));
    EXPECT_EQ(parse_frames("-3--1,-5", ""), (Frames{-5, -3, -2, -1}));
    EXPECT_EQ(parse_frames("-1-1", ""), (Frames{-1, 0, 1}));
    EXPECT_EQ(parse_frames("3,1-3,2", ""), (Frames{1, 2, 3}));
    EXPECT_EQ(parse_frames("1-240", "").size(), 240u);
}

TEST(Frames, AreWrittenShortAndReadBack) {
    const std::pair<Frames, std::string> cases[] = {
        {{}, ""},
        {{7}, "7"},
        {{1, 2}, "1-2"},
        {{1, 3}, "1,3"},
        {{-3, -2, -1, 4}, "-3--1,4"},
        {{1, 3, 4, 5}, "1,3-5"},
        {{0, 5, 10, 11}, "0-10x5,11"},
        {{1, 2, 3, 7, 10, 12, 14, 16, 40}, "1-3,7,10-16x2,40"},
    };
    for (const auto& [frames, text] : cases) {
        EXPECT_EQ(frames_text(frames), text);
        if (frames.empty()) continue;
        EXPECT_EQ(parse_frames(text, ""), frames);
    }
}

TEST(Frames, Messages) {
    const std::string such = "--frames: expected frames such as 1-100,120,200-300x2, found ";
    EXPECT_EQ(refusal(""), such + "''");
    EXPECT_EQ(refusal("1,"), such + "''");
    EXPECT_EQ(refusal("a"), such + "'a'");
    EXPECT_EQ(refusal("1.5"), such + "'1.5'");
    EXPECT_EQ(refusal("1-"), such + "'1-'");
    EXPECT_EQ(refusal("9-1"), "--frames: expected a range that ascends, found '9-1'");
    EXPECT_EQ(refusal("1-9x0"), "--frames: expected a step of at least 1, found '1-9x0'");
    EXPECT_EQ(refusal("99999999999999999999"),
              "--frames: expected frames between -999999999 and 999999999, found '99999999999999999999'");
    EXPECT_EQ(refusal("1-20000000"), "--frames: expected at most 10000000 frames, found '1-20000000'");
}

}  // namespace
}  // namespace astrosplat::test
