// Peaks, connected parts and backgrounds against what one counts by hand.
#include "detect/background.h"
#include "detect/parts.h"
#include "detect/peaks.h"
#include "support/test.h"

namespace astrosplat {
namespace {

Image picture_of(std::int64_t width, const std::vector<float>& values) {
    Image image = make_image(width, std::int64_t(values.size()) / width, 1);
    std::ranges::copy(values, image.pixels.begin());
    return image;
}

PixelMask mask_of(std::int64_t width, const std::vector<unsigned char>& pixels) {
    PixelMask mask = make_mask(width, std::int64_t(pixels.size()) / width);
    std::ranges::copy(pixels, mask.pixels.begin());
    return mask;
}

TEST(Peaks, OfEqualNeighboursTheFirstCountsOrEach) {
    const Image image = picture_of(5, {1, 2, 2, 0, 3,  //
                                       0, 2, 0, 0, 0});
    const auto peaks = [&](std::int64_t reach, EqualPeaks equal) {
        std::vector<std::int64_t> found;
        for (std::int64_t i = 0; i < 10; ++i)
            if (is_peak(image, i % 5, i / 5, reach, equal)) found.push_back(i);
        return found;
    };
    EXPECT_EQ(peaks(1, EqualPeaks::first), (std::vector<std::int64_t>{1, 4}));
    EXPECT_EQ(peaks(1, EqualPeaks::all), (std::vector<std::int64_t>{1, 2, 4, 6}));
    EXPECT_EQ(peaks(4, EqualPeaks::all), (std::vector<std::int64_t>{4}));
}

TEST(Peaks, AreFoundInOrderOfRowsWithinTheMargin) {
    const Image image = make_image(7, 50, 1);
    const auto found = found_by_rows(image, 2, [&](std::int64_t x, std::int64_t y) {
        return x % 2 == 0 ? std::optional(10 * y + x) : std::nullopt;
    });
    ASSERT_EQ(found.size(), 2u * 46u);
    EXPECT_EQ(found.front(), 22);
    EXPECT_EQ(found.back(), 474);
    EXPECT_TRUE(std::ranges::is_sorted(found));
}

TEST(Peaks, LightAboutAPixelHasItsMiddle) {
    const Image image = picture_of(3, {0.5f, 0.5f, 0.5f, 0.5f, 1.5f, 1.0f, 0.5f, 0.5f, 0.5f});
    const PointLight light = light_about(image, 1, 1, 1, 0.5f);
    EXPECT_EQ(light.sum, 1.5);
    EXPECT_FLOAT_EQ(light.x, 1.5f + 1.0f / 3.0f);
    EXPECT_FLOAT_EQ(light.y, 1.5f);
}

TEST(Parts, TouchBySidesOrByCorners) {
    const PixelMask mask = mask_of(4, {1, 0, 0, 1,  //
                                       0, 1, 0, 1,  //
                                       0, 0, 0, 0});
    const std::vector<PixelPart> parts = connected_parts(mask);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].pixels, (std::vector<std::int64_t>{0, 5}));
    EXPECT_EQ(parts[1].pixels, (std::vector<std::int64_t>{3, 7}));
    EXPECT_EQ(parts[0].box.width, 2);
    EXPECT_EQ(parts[0].box.height, 2);
    EXPECT_EQ(parts[1].box.x, 3);
    EXPECT_EQ(connected_parts(mask, Touching::sides).size(), 3u);
    EXPECT_EQ(std::ranges::count(grown(mask).pixels, 1), 12);
    PixelMask left = mask;
    EXPECT_TRUE(take_part(left, 2).pixels.empty()) << "not of the mask";
}

TEST(Backgrounds, AreMediansThatForgetWhatStandsOut) {
    std::vector<float> values{5.0f, 1.0f, 2.0f, 3.0f, 1000.0f};
    const Background found = background_of(values);
    EXPECT_EQ(found.level, 3.0f);
    EXPECT_EQ(found.median_distance, 2.0f);
    EXPECT_FLOAT_EQ(found.noise(), 2.9652f);
}

TEST(Backgrounds, MedianAboutAPixelIsThatOfItsSquare) {
    Image image = make_image(40, 30, 1);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = float(i * 7919 % 1000) / 1000.0f;
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(20, 15), std::pair(39, 12)}) {
        std::vector<float> square;
        for (int j = std::max(0, y - 5); j <= std::min(29, y + 5); ++j)
            for (int i = std::max(0, x - 5); i <= std::min(39, x + 5); ++i) square.push_back(*image.at(i, j));
        std::ranges::sort(square);
        EXPECT_EQ(median_about(image, x, y), square[square.size() / 2]) << x << " " << y;
    }
}

}  // namespace
}  // namespace astrosplat
