// Bands of a picture, and the dust that takes their light away.
#include "bodies/dust.h"
#include "bodies/picture_light.h"
#include "bodies/picture_splats.h"
#include "image/channels.h"
#include "support/painted_picture.h"
#include "support/test.h"

namespace astrosplat {
namespace {

std::vector<Image> all_bands(const Image& light) {
    std::vector<Image> images;
    const std::vector<Band> bands = make_bands(light.width);
    split_bands(light, bands, false, [&](const Band& band, const Image& image) {
        EXPECT_EQ(band.index, int(images.size()));
        images.push_back(image);
    });
    EXPECT_EQ(images.size(), bands.size());
    return images;
}

/// The sum of all bands.
Image emission_of(const Image& light, bool fill_holes) {
    Image sum = make_image(light.width, light.height, 3);
    split_bands(light, make_bands(light.width), fill_holes, [&](const Band&, const Image& band) {
        for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += band.pixels[i];
    });
    return sum;
}

TEST(Bands, LargerPicturesHaveMoreOfThem) {
    EXPECT_EQ(make_bands(1920).size(), 8u);
    EXPECT_EQ(make_bands(3840).size(), 9u);
    EXPECT_EQ(make_bands(480).size(), 6u);
    for (const Band& band : make_bands(1920)) {
        if (band.index + 1 < 8) {
            EXPECT_NEAR(band.feature, 2.0 * (1 << band.index), 1e-9) << band.index;
        }
    }
}

TEST(Bands, AddUpToThePictureAndAreNeverNegative) {
    const Image light = painted::galaxy(240, 150);
    const std::vector<Image> bands = all_bands(light);
    for (std::size_t i = 0; i < light.pixels.size(); ++i) {
        double sum = 0.0;
        for (const Image& band : bands) {
            ASSERT_GE(band.pixels[i], 0.0f);
            sum += double(band.pixels[i]);
        }
        ASSERT_NEAR(sum, light.pixels[i], 4e-7 * (1.0 + double(light.pixels[i]))) << "at " << i;
    }
}

TEST(Bands, WhatIsEvenIsInTheCoarsest) {
    Image light = make_image(160, 100, 3, 0.25f);
    const std::vector<Image> bands = all_bands(light);
    for (std::size_t k = 0; k + 1 < bands.size(); ++k)
        for (const float v : bands[k].pixels) ASSERT_NEAR(v, 0.0f, 2e-4f) << "band " << k;
    for (const float v : bands.back().pixels) ASSERT_NEAR(v, 0.25f, 1e-3f);
}

// A splat of a size is in the band of that size, not in the finest: this is what gives it a thickness
// of its own.
TEST(Bands, HoldWhatIsOfTheirSize) {
    for (const int wanted : {0, 2}) {
        Image light = make_image(320, 320, 3);
        painted::add_point(light, 160.0, 160.0, wanted == 0 ? 0.8 : 5.0, 1.0, 1.0, 1.0);
        const std::vector<Image> bands = all_bands(light);
        std::size_t strongest = 0;
        for (std::size_t k = 1; k < bands.size(); ++k)
            if (bands[k].at(160, 160)[0] > bands[strongest].at(160, 160)[0]) strongest = k;
        if (wanted == 0) {
            EXPECT_EQ(strongest, 0u);
        } else {
            EXPECT_GE(strongest, 1u);
            EXPECT_LE(strongest, 3u);
        }
    }
}

// Where the sum of filled bands is more than the picture, there is dust.
TEST(Bands, AStarMakesNoDustAroundItButALaneIsDust) {
    Image light = make_image(320, 200, 3, 0.1f);
    painted::add_point(light, 100.0, 100.0, 2.4, 5.0, 5.0, 5.0);
    for (std::int64_t y = 0; y < 200; ++y)
        for (std::int64_t x = 220; x < 226; ++x)
            for (int c = 0; c < 3; ++c) light.at(x, y)[c] = 0.02f;
    const Image sum = emission_of(light, true);
    const auto filled = [&](std::int64_t x, std::int64_t y) { return sum.at(x, y)[1] / light.at(x, y)[1]; };
    for (std::int64_t x = 60; x < 140; ++x) EXPECT_LT(filled(x, 100), 1.3f) << x;
    EXPECT_GT(filled(223, 60), 2.0f);
}

// Dust: what bands with filled holes and what takes it away again make together, and its optical depth.

constexpr std::int64_t size_px = 240;

// Even light with a dark lane of 12 px across.
Image with_lane() {
    Image light = make_image(size_px, size_px, 3, 0.4f);
    for (std::int64_t y = 0; y < size_px; ++y)
        for (std::int64_t x = 0; x < size_px; ++x) {
            const double d = (double(y) - 120.0) / 6.0;
            for (int c = 0; c < 3; ++c) light.at(x, y)[c] *= float(1.0 - 0.6 * std::exp(-0.5 * d * d));
        }
    return light;
}

TEST(Dust, EmissionTimesTransmittanceIsThePicture) {
    for (const Image& light : {with_lane(), painted::galaxy(size_px, size_px)}) {
        const Image emission = emission_of(light, true);
        const Image transmittance = transmittance_of(brightest_channel(light), emission);
        for (std::size_t i = 0; i < transmittance.pixels.size(); ++i) {
            const auto brightest = [&](const Image& image) {
                const float* const p = image.pixels.data() + 3 * i;
                return std::max({p[0], p[1], p[2]});
            };
            ASSERT_GE(brightest(emission), brightest(light) - 1e-6f) << i;
            // Both with .004 of sky, which keeps noise of the dark from becoming dust.
            ASSERT_NEAR((brightest(emission) + 0.004f) * transmittance.pixels[i], brightest(light) + 0.004f,
                        1e-5)
                << i;
        }
    }
}

TEST(Dust, IsTheLaneAndNothingElse) {
    const Image light = with_lane();
    const Image transmittance = transmittance_of(brightest_channel(light), emission_of(light, true));
    EXPECT_LT(*transmittance.at(120, 120), 0.85f);
    EXPECT_GT(*transmittance.at(120, 20), 0.97f);
    EXPECT_GT(*transmittance_of(brightest_channel(light), emission_of(light, false)).at(120, 120),
              0.9999f);  // bands without dust
}

Placement flat_placement() {
    Placement placement;
    placement.scale = 0.5;
    placement.height = 10.0;
    placement.seed = 7u;
    placement.picture_width = placement.picture_height = size_px;
    placement.thickness = make_image(size_px, size_px, 1, 10.0f);
    placement.structure = make_image(size_px, size_px, 1, 1.0f);
    return placement;
}

// Mean optical depth at an exponent of 1 of splats of Gaussian s: 2 pi sigma^2 Li2(s) each.
double optical_depth(const PictureSplats& set, std::int64_t first = 0) {
    double sum = 0.0;
    for (std::int64_t i = first; i < set.splats.size(); ++i) {
        const double s = set.splats.alpha[std::size_t(i)], sigma = 1.3;
        double dilogarithm = 0.0, power = s;
        for (int k = 1; k < 200; ++k, power *= s) dilogarithm += power / (k * k);
        sum += 2.0 * 3.14159265358979 * sigma * sigma * 0.9494 * dilogarithm;
    }
    return sum / double(size_px * size_px);
}

TEST(Dust, ASheetBeforeAllLightHasTheDepthThatIsSeen) {
    for (const float seen : {0.95f, 0.6f, 0.2f}) {
        PictureSplats set;
        add_dust(make_image(size_px, size_px, 1, seen), 1.0, dust_exponents, flat_placement(), set);
        EXPECT_TRUE(set.absorbs);
        EXPECT_TRUE(set.ranges.empty());  // the fit leaves dust alone
        EXPECT_NEAR(optical_depth(set), -std::log(seen), -0.03 * std::log(seen)) << seen;
    }
}

TEST(Dust, AmountIsAShareOfTheDepth) {
    PictureSplats set;
    add_dust(make_image(size_px, size_px, 1, 0.6f), 0.5, dust_exponents, flat_placement(), set);
    EXPECT_NEAR(optical_depth(set), -0.5 * std::log(0.6), 0.01);
}

// Half of the light lies before the sheet and is not dimmed: the rest has to lose twice as much.
TEST(Dust, LightBeforeTheSheetIsMadeUpFor) {
    PictureSplats set;
    for (int y = 2; y < size_px; y += 4)
        for (int x = 2; x < size_px; x += 4)
            for (const float z : {-20.0f, 20.0f}) {
                set.splats.position.emplace_back(float(x - 120), float(120 - y), z);
                set.splats.color.emplace_back(1.0f);
                set.splats.alpha.push_back(0.1f);
                set.splats.radius.push_back(2.0f * radius_sigmas);
                set.splats.id.push_back(set.splats.id.size());
                set.distance.push_back(20.0f);
            }
    const std::int64_t first = set.splats.size();
    add_dust(make_image(size_px, size_px, 1, 0.8f), 1.0, dust_exponents, flat_placement(), set);
    EXPECT_NEAR(optical_depth(set, first), -std::log(0.6), 0.02);
}

TEST(Dust, LiesTornAboutASheetBeforeTheMiddle) {
    PictureSplats set;
    add_dust(make_image(size_px, size_px, 1, 0.5f), 1.0, dust_exponents, flat_placement(), set);
    double sum = 0.0, squares = 0.0;
    for (const glm::vec3& p : set.splats.position) {
        sum += double(p.z);
        squares += double(p.z * p.z);
    }
    const double count = double(set.splats.size()), mean = sum / count;
    EXPECT_NEAR(mean, 2.0, 1.2);  // .2 H, give or take the widest waves
    const double deviation = std::sqrt(squares / count - mean * mean);
    EXPECT_GT(deviation, 1.6);  // more than the sheet's own .05 H
    EXPECT_LT(deviation, 5.0);
    for (const glm::vec3& color : set.splats.color) ASSERT_EQ(color, -dust_exponents);
}

TEST(Dust, OfAGreyPictureIsGrey) {
    Image light = make_image(8, 8, 3, 0.25f);
    EXPECT_EQ(dust_exponents_of(light), glm::vec3(1.0f));
    light.pixels[3 * 20 + 2] = 0.251f;  // noise of a conversion
    EXPECT_EQ(dust_exponents_of(light), glm::vec3(1.0f));
    light.pixels[3 * 63 + 2] = 0.27f;
    EXPECT_EQ(dust_exponents_of(light), dust_exponents);
    PictureSplats set;
    add_dust(make_image(size_px, size_px, 1, 0.5f), 1.0, glm::vec3(1.0f), flat_placement(), set);
    ASSERT_GT(set.splats.size(), 100);
    for (const glm::vec3& color : set.splats.color) ASSERT_EQ(color, glm::vec3(-1.0f));
}

// A lane stays one when a camera comes close: at every place the sheet is thin, whatever its waves.
TEST(Dust, IsThinAtEveryPlace) {
    PictureSplats set;
    add_dust(make_image(size_px, size_px, 1, 0.5f), 1.0, dust_exponents, flat_placement(), set);
    constexpr std::size_t cells = size_px / 4;
    std::vector<std::array<double, 3>> sums(cells * cells);  // of 1, z, z^2
    for (const glm::vec3& p : set.splats.position) {
        const auto column = std::size_t(p.x + 0.5f * size_px) / 4,
                   row = std::size_t(0.5f * size_px - p.y) / 4;
        auto& sum = sums[std::min(row, cells - 1) * cells + std::min(column, cells - 1)];
        const auto z = double(p.z);
        sum = {sum[0] + 1.0, sum[1] + z, sum[2] + z * z};
    }
    double within = 0.0;
    for (const auto& [count, z, square] : sums)
        if (count > 0.0) within += square - z * z / count;
    EXPECT_LT(std::sqrt(within / double(set.splats.size())), 0.8);  // .08 H
}

// As far as 24 bits tell them apart.
TEST(EvenNumber, EveryBlockOfCellsHasOneInEachShare) {
    for (const std::uint32_t key : {1u, 77u})
        for (int p = 0; p <= 6; ++p)
            for (int q = 0; q <= 6; ++q) {
                const std::int64_t wide = std::int64_t{1} << p, high = std::int64_t{1} << q;
                std::vector<int> found(std::size_t(wide * high));
                for (std::int64_t y = 5 * high; y < 6 * high; ++y)
                    for (std::int64_t x = 11 * wide; x < 12 * wide; ++x)
                        ++found[std::size_t(even_number({x, y}, key) * float(wide * high))];
                EXPECT_EQ(std::ranges::count(found, 1), wide * high) << wide << " x " << high;
            }
}

TEST(EvenNumber, IsAnotherWithEveryKey) {
    int equal = 0;
    for (std::int64_t x = 0; x < 100; ++x) equal += even_number({x, 3}, 1u) == even_number({x, 3}, 2u);
    EXPECT_LT(equal, 3);
}

}  // namespace
}  // namespace astrosplat
