// Frames: means of renderings by hand, and their names.
#include <gtest/gtest.h>

#include <array>

#include "core/error.h"
#include "core/file.h"
#include "frame/frame_scene.h"
#include "frame/output_pattern.h"
#include "support/errors.h"

namespace astrosplat {
namespace {

// Means of renderings by hand: light, depth by opacity, and layers that only some of them show.

/// Of one pixel: everything `light`, at `depth`, before an environment.
RenderedFrame rendering(float light, float opacity, float depth, std::size_t layers) {
    RenderedFrame frame;
    frame.beauty = make_image(1, 1, 4, light);
    frame.depth = make_image(1, 1, 1, depth);
    frame.opacity = make_image(1, 1, 1, opacity);
    frame.layers.assign(layers, make_image(1, 1, 4, light));
    frame.statistics = {100, 10, 2.0, 0.5};
    return frame;
}

TEST(MeanFrame, LightIsTheMeanAndDepthIsWeightedByOpacity) {
    RenderedFrame sum;
    add_rendering(sum, rendering(1.0f, 0.75f, 2.0f, 0), {});
    add_rendering(sum, rendering(0.5f, 0.25f, 10.0f, 0), {});
    divide_sum(sum, 2, 0);
    EXPECT_EQ(sum.beauty.pixels[0], 0.75f);
    EXPECT_EQ(sum.depth.pixels[0], 4.0f);
    EXPECT_TRUE(sum.layers.empty());
    EXPECT_EQ(sum.statistics.splats_in, 100);
    EXPECT_EQ(sum.statistics.splats_drawn, 10);
    EXPECT_EQ(sum.statistics.mean_overlap, 2.0);
    EXPECT_EQ(sum.statistics.seconds, 1.0);
}

TEST(MeanFrame, DepthIsNothingWhereNothingIsSeen) {
    RenderedFrame sum;
    for (int i = 0; i < 2; ++i) add_rendering(sum, rendering(1.0f, 0.0f, 0.0f, 0), {});
    divide_sum(sum, 2, 0);
    EXPECT_EQ(sum.depth.pixels[0], 0.0f);
}

TEST(MeanFrame, ALayerThatOneRenderingShowsHasItsShareInItsPlace) {
    RenderedFrame sum;
    const std::array<std::size_t, 1> third = {2}, first = {0};
    add_rendering(sum, rendering(1.0f, 1.0f, 1.0f, 1), third);
    add_rendering(sum, rendering(0.5f, 1.0f, 1.0f, 1), first);
    add_rendering(sum, rendering(0.0f, 1.0f, 1.0f, 0), {});
    add_rendering(sum, rendering(1.0f, 1.0f, 1.0f, 1), third);
    divide_sum(sum, 4, 4);
    ASSERT_EQ(sum.layers.size(), 4u);
    for (const auto& [layer, light] : {std::pair{0, 0.125f}, {1, 0.0f}, {2, 0.5f}, {3, 0.0f}})
        EXPECT_EQ(sum.layers[static_cast<std::size_t>(layer)].pixels[0], light) << layer;
}

// Frame numbers and eyes in file names, and folders whose names look like them.

namespace fs = std::filesystem;

std::string frame_file(const std::string& name, std::int64_t frame, Eye eye = Eye::centre) {
    return OutputPattern{"", name}.resolve(frame, eye).string();
}

bool is_stereo(const std::string& name) { return OutputPattern{"", name}.is_stereo(); }
bool is_numbered(const std::string& name) { return OutputPattern{"", name}.is_numbered(); }

TEST(OutputPattern, EveryPatternPadsWithZeros) {
    EXPECT_EQ(frame_file("frames/shot.####.exr", 12), "frames/shot.0012.exr");
    EXPECT_EQ(frame_file("shot.%04d.exr", 12), "shot.0012.exr");
    EXPECT_EQ(frame_file("shot.{frame:04}.exr", 12), "shot.0012.exr");
    EXPECT_EQ(frame_file("shot.{frame:04d}.exr", 12), "shot.0012.exr");
    EXPECT_EQ(frame_file("#.png", 12), "12.png");
    EXPECT_EQ(frame_file("%d.png", 7), "7.png");
    EXPECT_EQ(frame_file("{frame}.png", 7), "7.png");
    EXPECT_EQ(frame_file("####.png", 123456), "123456.png");
}

TEST(OutputPattern, PairsHaveTheirEyeInTheName) {
    EXPECT_EQ(frame_file("%V/shot.%v.####.exr", 12, Eye::left), "left/shot.l.0012.exr");
    EXPECT_EQ(frame_file("shot.%04d.%V.exr", 12, Eye::right), "shot.0012.right.exr");
    EXPECT_EQ(frame_file("shot.%V.png", 12), "shot.centre.png");
    EXPECT_TRUE(is_stereo("%V.####.exr") && is_stereo("%v.exr"));
    EXPECT_FALSE(is_stereo("V.%04d.exr") || is_stereo("100%"));
}

TEST(OutputPattern, NegativeFramesKeepTheirDigits) {
    EXPECT_EQ(frame_file("a.####.exr", -5), "a.-0005.exr");
    EXPECT_EQ(frame_file("a.%03d.exr", -5), "a.-005.exr");
    EXPECT_EQ(frame_file("a.{frame}.exr", -5), "a.-5.exr");
    EXPECT_EQ(frame_file("a.#.exr", INT64_MIN), "a.-9223372036854775808.exr");
}

TEST(OutputPattern, OtherTextIsLeftAlone) {
    for (const char* name :
         {"100%.exr", "50%of{frames}.exr", "{frame:}.exr", "{frame:x}.exr", "ünter 1.exr", ""}) {
        EXPECT_EQ(frame_file(name, 3), name);
        EXPECT_FALSE(is_numbered(name)) << name;
    }
    EXPECT_EQ(frame_file("ünter 100% ##.exr", 3), "ünter 100% 03.exr");
    EXPECT_TRUE(is_numbered("a.%d.exr"));
}

TEST(OutputPattern, TwoPlacesAreAnError) {
    const std::string expected =
        "output.path: expected one place for the frame number (####, %04d or {frame:04}), found more in "
        "'#/shot.%04d.exr'";
    EXPECT_EQ(ERROR_OF(output_pattern("/a", "#/shot.%04d.exr")), expected);
    EXPECT_EQ(ERROR_OF(frame_file("#/shot.%04d.exr", 1)), expected);
}

TEST(OutputPattern, TheFolderIsTakenAsItIs) {
    const OutputPattern pattern{"/films/C#1 100%v {frame}", "shot.####.exr"};
    EXPECT_EQ(pattern.resolve(5), "/films/C#1 100%v {frame}/shot.0005.exr");
    EXPECT_FALSE(pattern.is_stereo());
    EXPECT_FALSE((OutputPattern{"/films/####", "shot.exr"}.is_numbered()));
    EXPECT_EQ(output_pattern("/no such C#1/%V", "still.exr").resolve(5), "/no such C#1/%V/still.exr");
}

TEST(OutputPattern, WrittenFoldersThatExistAreTakenAsTheyAre) {
    const TemporaryFolder folder;
    fs::create_directories(folder.path() / "C#1" / "{frame}");
    const OutputPattern inside = output_pattern(folder.path(), "C#1/{frame}/%V/shot.####.exr");
    EXPECT_EQ(inside.folder, folder.path() / "C#1" / "{frame}");
    EXPECT_EQ(inside.resolve(5, Eye::left), folder.path() / "C#1/{frame}/left/shot.0005.exr");
    EXPECT_EQ(output_pattern("/", (folder.path() / "C#1/a.%04d.exr").string()).resolve(5),
              folder.path() / "C#1/a.0005.exr");
    EXPECT_EQ(output_pattern(folder.path(), "C#2/a.exr").resolve(5), folder.path() / "C52/a.exr");
}

TEST(OutputPattern, FramesHaveAFolderInCommon) {
    EXPECT_EQ(output_pattern("/films/C#1", "a/b/%V/shot.####.exr").common_folder(), "/films/C#1/a/b");
    EXPECT_EQ(output_pattern("/films", "shot.####.exr").common_folder(), "/films");
}

TEST(OutputPattern, FilesOfAllFramesAreCalledByTheStem) {
    for (const char* name :
         {"a/shot.####.exr", "shot_%04d.png", "shot-{frame:04}.tif", "shot.%V.####.exr", "shot.exr"})
        EXPECT_EQ((OutputPattern{"", name}.stem()), "shot") << name;
    EXPECT_EQ((OutputPattern{"", "####.exr"}.stem()), "frame");
}

TEST(OutputPattern, APairNeedsACameraWithTwoEyes) {
    CameraParams camera;
    camera.eye = Eye::right;
    EXPECT_EQ(eyes_of({"", "a.####.exr"}, camera), std::vector{Eye::right});
    EXPECT_EQ(eyes_of({"", "%V/a.####.exr"}, camera), (std::vector{Eye::left, Eye::right}));
    camera.projection = Projection::fisheye;
    EXPECT_THROW(eyes_of({"", "%V/a.####.exr"}, camera), InputError);
}

}  // namespace
}  // namespace astrosplat
