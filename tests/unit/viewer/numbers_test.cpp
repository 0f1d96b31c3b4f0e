// Small computations of the viewer by hand: how far a rendering is, thumbnails of snapshots.
#include <gtest/gtest.h>

#include "viewer/comparison.h"
#include "viewer/render_job.h"

namespace astrosplat {
namespace {

TEST(RenderingLine, SaysTheShareOfAllFrames) {
    EXPECT_EQ(share_of_line("astrosplat: preparing 50% eta 00:00:02"), 0.5f);
    EXPECT_EQ(share_of_line("astrosplat: frame 12 (3/10) 50% eta 00:04:10"), 0.25f);
    EXPECT_EQ(share_of_line("astrosplat: frame 12 (10/10) 100% eta 00:00:00"), 1.0f);
    for (const char* other : {"", "saved a.0001.exr", "37% of nothing", "about x% more", "37%"})
        EXPECT_FALSE(share_of_line(other)) << other;
}

TEST(Thumbnail, AveragesBoxes) {
    // 4 x 3 px into boxes of 2 x 2; the row that is left over is dropped.
    std::vector<unsigned char> rgba;
    for (int i = 0; i < 12; ++i)
        for (int c = 0; c < 4; ++c) rgba.push_back(static_cast<unsigned char>(c == 3 ? 255 : 10 * i + c));
    const Image small = thumbnail_of(rgba, 4, 3, 2);
    ASSERT_EQ(small.width, 2);
    ASSERT_EQ(small.height, 1);
    for (int c = 0; c < 3; ++c) {
        EXPECT_FLOAT_EQ(small.at(0, 0)[c], (25.0f + static_cast<float>(c)) / 255.0f);
        EXPECT_FLOAT_EQ(small.at(1, 0)[c], (45.0f + static_cast<float>(c)) / 255.0f);
    }
    EXPECT_EQ(small.at(1, 0)[3], 1.0f);
    EXPECT_EQ(thumbnail_of(rgba, 4, 3, 8).width, 4) << "small pictures stay as they are";
}

}  // namespace
}  // namespace astrosplat
