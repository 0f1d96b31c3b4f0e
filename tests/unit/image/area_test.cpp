// The area filter against sums over the pixels covered.
#include "image/area.h"

#include <gtest/gtest.h>

namespace astrosplat {
namespace {

TEST(Area, EachPixelIsTheMeanOfWhatItCovers) {
    Image image = make_image(3, 2, 2);
    for (std::int64_t i = 0; i < 12; ++i) image.pixels[static_cast<std::size_t>(i)] = static_cast<float>(i);
    const Image out = reduced_by_area(image, 2, 1);
    // The columns' means are 3, 5 and 7 (4, 6 and 8); a new one covers one and a half.
    EXPECT_NEAR(out.at(0, 0)[0], (3.0 + 0.5 * 5.0) / 1.5, 1e-5);
    EXPECT_NEAR(out.at(1, 0)[0], (0.5 * 5.0 + 7.0) / 1.5, 1e-5);
    EXPECT_NEAR(out.at(1, 0)[1], (0.5 * 6.0 + 8.0) / 1.5, 1e-5);
    EXPECT_EQ(reduced_by_area(image, 3, 2).pixels, image.pixels);
}

}  // namespace
}  // namespace astrosplat
