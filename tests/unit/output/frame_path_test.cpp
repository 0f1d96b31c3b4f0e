// Frame numbers in file names.
#include <gtest/gtest.h>

#include "core/error.h"
#include "output/frame_path.h"
#include "output/write.h"

namespace astrosplat {
namespace {

TEST(FrameFile, EveryPatternPadsWithZeros) {
    EXPECT_EQ(frame_file("frames/shot.####.exr", 12), "frames/shot.0012.exr");
    EXPECT_EQ(frame_file("shot.%04d.exr", 12), "shot.0012.exr");
    EXPECT_EQ(frame_file("shot.{frame:04}.exr", 12), "shot.0012.exr");
    EXPECT_EQ(frame_file("shot.{frame:04d}.exr", 12), "shot.0012.exr");
    EXPECT_EQ(frame_file("#.png", 12), "12.png");
    EXPECT_EQ(frame_file("%d.png", 7), "7.png");
    EXPECT_EQ(frame_file("{frame}.png", 7), "7.png");
    EXPECT_EQ(frame_file("####.png", 123456), "123456.png");
}

TEST(FrameFile, PairsHaveTheirEyeInTheName) {
    EXPECT_EQ(frame_file("%V/shot.%v.####.exr", 12, Eye::left), "left/shot.l.0012.exr");
    EXPECT_EQ(frame_file("shot.%04d.%V.exr", 12, Eye::right), "shot.0012.right.exr");
    EXPECT_EQ(frame_file("shot.%V.png", 12), "shot.centre.png");
    EXPECT_TRUE(has_eye_token("%V.####.exr") && has_eye_token("%v.exr"));
    EXPECT_FALSE(has_eye_token("V.%04d.exr") || has_eye_token("100%"));
}

TEST(FrameFile, NegativeFramesKeepTheirDigits) {
    EXPECT_EQ(frame_file("a.####.exr", -5), "a.-0005.exr");
    EXPECT_EQ(frame_file("a.%03d.exr", -5), "a.-005.exr");
    EXPECT_EQ(frame_file("a.{frame}.exr", -5), "a.-5.exr");
    EXPECT_EQ(frame_file("a.#.exr", INT64_MIN), "a.-9223372036854775808.exr");
}

TEST(FrameFile, OtherTextIsLeftAlone) {
    for (const char* name :
         {"100%.exr", "50%of{frames}.exr", "{frame:}.exr", "{frame:x}.exr", "ünter 1.exr", ""}) {
        EXPECT_EQ(frame_file(name, 3), name);
        EXPECT_FALSE(has_frame_token(name)) << name;
    }
    EXPECT_EQ(frame_file("ünter 100% ##.exr", 3), "ünter 100% 03.exr");
    EXPECT_TRUE(has_frame_token("a.%d.exr"));
}

TEST(FrameFile, TwoPlacesAreAnError) {
    try {
        frame_file("#/shot.%04d.exr", 1);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(
            error.what(),
            "output.path: expected one place for the frame number (####, %04d or {frame:04}), found more in "
            "'#/shot.%04d.exr'");
    }
}

}  // namespace
}  // namespace astrosplat
