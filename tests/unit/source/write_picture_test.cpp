// A picture made in memory is the file that a reader takes.
#include "source/write_image.h"

#include <gtest/gtest.h>

#include <vector>

#include "source/texture.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

TEST(PngBytes, AreAFileWithTheseValues) {
    const TempFolder folder;
    std::vector<unsigned char> rgb;
    for (int i = 0; i < 19 * 7 * 3; ++i) rgb.push_back(static_cast<unsigned char>(i * 37));
    const std::string png = png_bytes(19, 7, rgb);
    const Image read = load_raw_image(folder.file("memory.png", png));
    ASSERT_EQ(read.width, 19);
    ASSERT_EQ(read.height, 7);
    for (std::size_t i = 0; i < rgb.size(); ++i) ASSERT_NEAR(read.pixels[i] * 255.0f, rgb[i], 1e-3) << i;
    EXPECT_EQ(png_bytes(19, 7, rgb), png) << "no time, no chance";
}

}  // namespace
}  // namespace astrosplat
