// Picture differences against sums done by hand.
#include "output/compare.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "output/write.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

TEST(Compare, EqualPicturesAreIdentical) {
    Image a = make_image(10, 10, 4, 0.5f);
    a.pixels[7] = std::numeric_limits<float>::quiet_NaN();
    ImageComparison result = compare_images(a, a);
    EXPECT_TRUE(result.identical());
    EXPECT_EQ(result.max_difference, 0.0);
    EXPECT_EQ(result.mean_difference, 0.0);
    EXPECT_TRUE(std::isinf(result.psnr_db));
}

TEST(Compare, OneChannelOfOnePixel) {
    Image a = make_image(10, 5, 4, 0.0f), b = a;
    b.at(7, 3)[2] = 0.5f;
    ImageComparison result = compare_images(a, b);
    EXPECT_EQ(result.width, 10);
    EXPECT_EQ(result.height, 5);
    EXPECT_EQ(result.differing_pixels, 1);
    EXPECT_EQ(result.max_difference, 0.5);
    EXPECT_EQ(result.max_x, 7);
    EXPECT_EQ(result.max_y, 3);
    EXPECT_EQ(result.max_channel, 2);
    EXPECT_DOUBLE_EQ(result.mean_difference, 0.5 / 200);
    EXPECT_NEAR(result.psnr_db, 10.0 * std::log10(200 / 0.25), 1e-9);
    EXPECT_EQ(result.percentile_999, 0.5);  // 99.9 % of 50 pixels is all of them
}

TEST(Compare, PercentileLeavesOneInAThousandAside) {
    Image a = make_image(100, 20, 1, 0.0f), b = a;
    b.pixels[0] = b.pixels[1] = 9.0f;
    b.pixels[2] = 0.25f;
    EXPECT_EQ(compare_images(a, b).percentile_999, 0.25);  // of 2000 pixels, two may be worse
}

TEST(Compare, ZerosOfOtherSignDifferOnlyInBits) {
    Image a = make_image(2, 2, 1, 0.0f), b = make_image(2, 2, 1, -0.0f);
    ImageComparison result = compare_images(a, b);
    EXPECT_EQ(result.differing_pixels, 4);
    EXPECT_EQ(result.max_difference, 0.0);
}

TEST(Compare, NanAgainstANumberIsInfinite) {
    Image a = make_image(2, 2, 1, 0.0f), b = a;
    b.pixels[3] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(std::isinf(compare_images(a, b).max_difference));
}

TEST(Compare, FilesOfDifferentSizesAreAnError) {
    const fs::path folder = fs::temp_directory_path() / fmt::format("astrosplat compare {}", getpid());
    RenderedFrame small, large;
    small.beauty = make_image(4, 4, 4, 0.25f);
    large.beauty = make_image(5, 4, 4, 0.25f);
    OutputParams output;
    output.depth = OutputParams::Depth::float32;
    write_frame({folder / "a.exr", output, 4, 4}, small, {});
    write_frame({folder / "b.exr", output, 5, 4}, large, {});
    write_frame({folder / "c.tif", output, 4, 4}, small, {});
    EXPECT_TRUE(compare_files(folder / "a.exr", folder / "c.tif").identical());
    try {
        compare_files(folder / "a.exr", folder / "b.exr");
        ADD_FAILURE() << "no error";
    } catch (const InputError& error) {
        EXPECT_EQ(error.what(), fmt::format("{}: expected 4 x 4 pixels as in {}, found 5 x 4",
                                            (folder / "b.exr").string(), (folder / "a.exr").string()));
    }
    fs::remove_all(folder);
}

}  // namespace
}  // namespace astrosplat
