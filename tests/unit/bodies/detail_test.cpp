// Details that no telescope saw: invented below a picture's pixels.
#include "bodies/detail_levels.h"
#include "bodies/detail_parts.h"
#include "bodies/detail_picture.h"
#include "bodies/exemplar.h"
#include "core/memory.h"
#include "core/real.h"
#include "image/blur.h"
#include "image/channels.h"
#include "image/resample.h"
#include "support/painted_picture.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// A remnant's threads before a glow, and no stars.
Image threads(std::int64_t width, std::int64_t height) {
    return painted::of_colors(width, height, [](double u, double v) {
        const double glow = 0.02 + 0.1 * std::exp(-8.0 * (u * u + v * v));
        const auto ridge = [&](double frequency, std::uint32_t seed) {
            return std::pow(1.0 - std::min(1.0, std::fabs(4.0 * double(painted::fbm(u, v, frequency, seed)))),
                            4.0);
        };
        const double a = ridge(13.0, 22u), b = ridge(19.0, 23u);
        return std::array{glow * (1.0 + 5.0 * a), glow * (1.2 + 3.0 * (a + b)), glow * (1.5 + 5.0 * b)};
    });
}

DetailWish octaves_of_detail(int octaves, std::uint32_t seed = 7u) { return {octaves, 0.8, seed}; }

double mean_about(const Image& detail, const Image& light, std::int64_t x, std::int64_t y, int channel) {
    const std::int64_t times = detail.width / light.width;
    double sum = 0.0;
    for_each_between(detail, times * x, times * y, times * (x + 1) - 1, times * (y + 1) - 1,
                     [&](std::int64_t i, std::int64_t j) { sum += double(detail.at(i, j)[channel]); });
    return sum / double(times * times);
}

// So many times as large, finite, nowhere negative, and filtered down the picture.
void expect_detail_of(const Image& light, const Image& detail, int octaves) {
    ASSERT_EQ(detail.width, light.width << octaves);
    ASSERT_EQ(detail.height, light.height << octaves);
    ASSERT_EQ(detail.channels, light.channels);
    for (const float value : detail.pixels) ASSERT_TRUE(value >= 0.0f && std::isfinite(value));
    double worst = 0.0;
    for_each_between(light, 0, 0, light.width, light.height, [&](std::int64_t x, std::int64_t y) {
        for (int c = 0; c < light.channels; ++c) {
            const double value = double(light.at(x, y)[c]);
            worst =
                std::max(worst, std::fabs(mean_about(detail, light, x, y, c) - value) / std::max(1.0, value));
        }
    });
    EXPECT_LT(worst, 3e-7);
}

TEST(DetailPicture, FilteredDownItIsThePicture) {
    Image light = threads(75, 51);
    painted::add_point(light, 30.0, 20.0, 1.5, 4.0, 3.0, 2.0);
    for (const int octaves : {1, 2}) {
        expect_detail_of(light, detail_picture(light, {}, octaves_of_detail(octaves)), octaves);
        const Image red = channel_of(light, 0);
        expect_detail_of(red, detail_picture(red, {}, octaves_of_detail(octaves)), octaves);
    }
}

TEST(DetailPicture, SmallAndBlackPicturesHaveDetailPictures) {
    const Image some = threads(3, 2);
    for (const Image& light :
         {make_image(1, 1, 3, 0.4f), some, make_image(33, 20, 3), make_image(1, 9, 1, 2.0f)})
        for (const int octaves : {1, 2})
            expect_detail_of(light, detail_picture(light, {}, octaves_of_detail(octaves)), octaves);
    for (const float value : detail_picture(make_image(33, 20, 3), {}, octaves_of_detail(2)).pixels)
        ASSERT_EQ(value, 0.0f);
}

TEST(DetailPicture, FlatLightStaysFlat) {
    for (const float level : {0.003f, 0.4f, 3.0f})
        for (const float value :
             detail_picture(make_image(40, 30, 3, level), {}, octaves_of_detail(2)).pixels)
            ASSERT_NEAR(value, level, 2e-6f * (level + 0.01f));
}

TEST(DetailPicture, HasTheSameBitsOnAnyNumberOfThreads) {
    const Image light = threads(96, 60);
    test::expect_same_bits([&] { return test::Bits() << detail_picture(light, {}, octaves_of_detail(2)); });
}

// Where a part goes on by what detail depends on, wherever it begins.
TEST(DetailPicture, APartHasTheDetailOfTheWhole) {
    const Image light = threads(160, 128);
    DetailWish wish = octaves_of_detail(2);
    wish.slope = detail_slope(light);
    const Image whole = detail_picture(light, {}, wish);
    const Region part{40, 16, 104, 96};
    wish.x = part.x;
    wish.y = part.y;
    const Image alone = detail_picture(part_of(light, part), {}, wish);
    const std::int64_t reach = 4 * detail_reach_px;
    for (std::int64_t y = reach; y < alone.height - reach; ++y)
        for (std::int64_t x = reach; x < alone.width - reach; ++x)
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(alone.at(x, y)[c], whole.at(4 * part.x + x, 4 * part.y + y)[c], 1e-5f)
                    << x << " " << y;
}

// It fades to what is there without.
TEST(DetailPicture, OnlyItsShareCounts) {
    const Image light = threads(48, 40);
    DetailWish wish = octaves_of_detail(1);
    wish.share = [](float x, float, int) { return x < 24.0f ? 0.0f : 1.0f; };
    const Image half = detail_picture(light, {}, wish), all = detail_picture(light, {}, octaves_of_detail(1));
    wish.share = [](float, float, int) { return 0.0f; };
    const Image none = detail_picture(light, {}, wish);
    double away[2] = {};  // on either side, from what is there without
    for_each_between(half, 0, 0, half.width, half.height, [&](std::int64_t x, std::int64_t y) {
        if (x >= 44 && x < 52) return;
        const double differs = std::fabs(double(half.at(x, y)[1]) - double(none.at(x, y)[1]));
        if (x < 48) away[0] += differs;
        if (x >= 52) away[1] += differs;
    });
    EXPECT_LT(away[0], 0.2 * away[1]);
    EXPECT_NEAR(half.at(80, 40)[1], all.at(80, 40)[1], 0.01f * all.at(80, 40)[1]);
}

StructureParams with_tiles(const char* tiles, int most = 2, double margin = 0.0) {
    StructureParams params;
    params.detail = most;
    params.detail_tiles = tiles;
    params.margin = margin;
    return params;
}

TEST(DetailLevels, TilesSayWhere) {
    const DetailLevels levels(with_tiles("012 002"), 300, 200);
    EXPECT_EQ(levels.at(50.0f, 50.0f), 0);
    EXPECT_EQ(levels.at(150.0f, 50.0f), 1);
    EXPECT_EQ(levels.at(199.9f, 50.0f), 1);
    EXPECT_EQ(levels.at(200.0f, 150.0f), 2);
    EXPECT_EQ(levels.at(150.0f, 150.0f), 0);
    EXPECT_EQ(DetailLevels(with_tiles("012 002", 1), 300, 200).at(250.0f, 150.0f), 1);
    EXPECT_FALSE(DetailLevels(with_tiles("012 002", 0), 300, 200).any());
    EXPECT_EQ(DetailLevels(with_tiles("", 2), 300, 200).at(3.0f, 3.0f), 2);
    const Region right = levels.bounds({0, 0, 300, 150}, 2);
    EXPECT_EQ(right.x, 200);
    EXPECT_EQ(right.width, 100);
    EXPECT_EQ(right.height, 150);
    EXPECT_EQ(levels.bounds({0, 0, 100, 200}, 1).width, 0);
    EXPECT_DOUBLE_EQ(levels.area_share(2), 1.0 / 3.0);
}

// In the picture without its margin, beyond which there is none.
TEST(DetailLevels, TilesLieWithinTheMargin) {
    const DetailLevels levels(with_tiles("22 22", 2, 0.1), 240, 160);  // 20 px on each side
    EXPECT_EQ(levels.at(19.5f, 80.0f), 0);
    EXPECT_EQ(levels.at(20.5f, 80.0f), 2);
    EXPECT_EQ(levels.at(219.5f, 139.5f), 2);
    EXPECT_EQ(levels.at(220.5f, 80.0f), 0);
    EXPECT_NEAR(levels.area_share(2), 200.0 * 120.0 / (240.0 * 160.0), 1e-12);
}

TEST(DetailLevels, AnOctaveFadesTowardsThoseThatLackIt) {
    const DetailLevels levels(with_tiles("0122"), 400, 100);
    EXPECT_FLOAT_EQ(levels.share(104.0f, 50.0f, 1), 0.25f);
    EXPECT_FLOAT_EQ(levels.share(196.0f, 50.0f, 1), 1.0f);
    EXPECT_FLOAT_EQ(levels.share(208.0f, 50.0f, 2), 0.5f);
    EXPECT_FLOAT_EQ(levels.share(208.0f, 50.0f, 1), 1.0f);
    EXPECT_FLOAT_EQ(levels.share(399.0f, 1.0f, 2), 1.0f);  // the picture's edge is none
}

TEST(DetailLevels, FaultyTilesAreRefused) {
    EXPECT_EQ(fault_of_tiles(""), "");
    EXPECT_EQ(fault_of_tiles("01 20"), "");
    EXPECT_EQ(fault_of_tiles("01 2"), "expected rows of 2 tiles as the first, found 1 in '2'");
    EXPECT_EQ(fault_of_tiles("01 3x"), "expected rows of 0, 1 and 2 with a blank between, found '3x'");
    EXPECT_EQ(fault_of_tiles("01  20"), "expected rows of 0, 1 and 2 with a blank between, found ''");
}

TEST(DetailPicture, AnotherSeedInventsSomethingElse) {
    const Image light = threads(48, 30);
    const auto of_seed = [&](std::uint32_t seed) {
        return detail_picture(light, {}, octaves_of_detail(1, seed));
    };
    EXPECT_FALSE(same_bits(of_seed(1u).pixels, of_seed(2u).pixels));
}

// Four times as large, linear between the pixels.
Image large(const Image& light) {
    Image image = unfilled_image(4 * light.width, 4 * light.height, 3);
    for_each_pixel(image, [&](std::int64_t x, std::int64_t y) {
        const LinearSample near(light, (float(x) + 0.5f) / 4.0f, (float(y) + 0.5f) / 4.0f);
        for (int c = 0; c < 3; ++c) image.at(x, y)[c] = near.of(light, c);
    });
    return image;
}

// Mean square, dB, of what lies between two blurs of the logarithm.
double power_between(const Image& light, double fine_px, double coarse_px) {
    Image logs = mean_of_channels(light);
    change_pixels(logs, [](float* value) { *value = float(real::log(double(*value) + 0.01)); });
    const Image fine = gaussian_blur(logs, fine_px), coarse = gaussian_blur(logs, coarse_px);
    double sum = 0.0;
    for (std::size_t i = 0; i < fine.pixels.size(); ++i)
        sum += std::pow(double(fine.pixels[i] - coarse.pixels[i]), 2.0);
    return 10.0 * std::log10(sum / double(fine.pixels.size()));
}

TEST(DetailPicture, InventedOctavesAreAsStrongAsTrueOnes) {
    const Image truth = threads(640, 400), light = reduced_by_area(truth, 160, 100);
    const Image detail = detail_picture(light, {}, octaves_of_detail(2)), soft = large(light);
    for (const auto& [fine, coarse] : {std::pair(0.0, 0.7), std::pair(0.7, 1.4)}) {
        const double expected = power_between(truth, fine, coarse);
        EXPECT_NEAR(power_between(detail, fine, coarse), expected, 4.0) << fine;
        EXPECT_LT(power_between(soft, fine, coarse), expected - 8.0) << fine;
    }
}

TEST(DetailPicture, WhereNothingIsCopiedThereIsNoise) {
    const Image truth = threads(640, 400), light = reduced_by_area(truth, 160, 100);
    const auto power_of = [&](double strength) {
        return power_between(detail_picture(light, make_image(160, 100, 1), {2, strength, 7u}), 0.0, 1.4);
    };
    const double expected = power_between(truth, 0.0, 1.4), none = power_of(0.0), full = power_of(1.0);
    EXPECT_LT(none, expected - 6.0);
    EXPECT_NEAR(full, expected, 4.0) << none;
    EXPECT_GT(power_of(0.5), none + 1.0) << none << ' ' << full;
}

// 0 within so many pixels of a place.
Image sources_but_about(const Image& light, double x, double y, double radius) {
    Image sources = make_image(light.width, light.height, 1, 1.0f);
    for_each_within(sources, x, y, radius,
                    [&](std::int64_t i, std::int64_t j, double, double) { *sources.at(i, j) = 0.0f; });
    return sources;
}

// A green star among grey ones: what is copied from it shows its colour. It reaches 5 texels, and what lies
// below a texel is known from those up to 5 away.
TEST(DetailPicture, NothingIsCopiedFromWhereAStarWasTakenOut) {
    const double x = 40.0, y = 25.0;
    Image light = threads(80, 50);
    change_pixels(light, [](float* rgb) { rgb[0] = rgb[2] = rgb[1]; });
    for (int i = 0; i < 8; ++i)
        painted::add_point(light, 12.0 + 8.0 * i, i % 2 == 0 ? 16.0 : 34.0, 1.0, 0.6, 0.6, 0.6);
    painted::add_point(light, x, y, 1.0, 0.0, 1.0, 0.0);
    const auto coloured = [&](const Image& sources) {
        const Image detail = detail_picture(light, sources, octaves_of_detail(2));
        int count = 0;
        for_each_between(detail, 0, 0, detail.width, detail.height, [&](std::int64_t i, std::int64_t j) {
            const double from = std::hypot((double(i) + 0.5) / 4.0 - x, (double(j) + 0.5) / 4.0 - y);
            if (from > 9.0 && std::fabs(detail.at(i, j)[0] / detail.at(i, j)[1] - 1.0f) > 0.001f) ++count;
        });
        return count;
    };
    EXPECT_EQ(coloured(sources_but_about(light, x, y, 10.0)), 0);
    EXPECT_GT(coloured({}), 50);
}

TEST(DetailPicture, StopsWhenAsked) {
    const std::atomic<bool> cancelled = true;
    EXPECT_THROW(detail_picture(threads(32, 20), {}, {}, Progress{{}, &cancelled}), Cancelled);
}

TEST(DetailPicture, SaysWhatMemoryItLacks) {
    limit_memory(1);
    const std::string message = ERROR_OF(detail_picture(make_image(64, 64, 3), {}, {}));
    limit_memory(0);
    EXPECT_HAS(message, "details");
}

// A front, dark to the left: a bright thread lies on its bright side, a dark one beside it.
Exemplar upright_front() {
    Exemplar front{make_image(32, 32, 1), make_image(32, 32, 3), {}};
    for_each_pixel(front.coarse, [&](std::int64_t x, std::int64_t y) {
        *front.coarse.at(x, y) = std::clamp(0.1f * float(x - 12), 0.0f, 0.7f);
        std::fill_n(front.fine.at(x, y), 3, x == 16 ? 0.3f : x == 15 ? -0.2f : 0.0f);
    });
    return front;
}

TEST(ExemplarDetails, FrontsGetTheirThreadsWhicheverWayTheyRun) {
    const Exemplar front = upright_front();
    for (int way = 0; way < 4; ++way) {
        Image base = make_image(64, 64, 1);
        for_each_pixel(base, [&](std::int64_t x, std::int64_t y) {
            const std::int64_t along = way < 2 ? x : y, from_dark = way % 2 == 0 ? along : 63 - along;
            *base.at(x, y) = std::clamp(0.1f * float(from_dark - 28), 0.0f, 0.7f);
        });
        const Image details = exemplar_details(base, front, 2, {}, 5u);
        ASSERT_EQ(details.channels, 3);
        const auto at = [&](std::int64_t from_dark) {
            const std::int64_t along = way % 2 == 0 ? from_dark : 63 - from_dark;
            return details.at(way < 2 ? along : 32, way < 2 ? 32 : along)[1];
        };
        EXPECT_NEAR(at(32), 0.3f, 0.05f) << way;
        EXPECT_NEAR(at(31), -0.2f, 0.05f) << way;
        EXPECT_NEAR(at(24), 0.0f, 0.02f) << way;
        EXPECT_NEAR(at(40), 0.0f, 0.02f) << way;
    }
}

TEST(ExemplarDetails, NothingComesFromWhatIsNoSource) {
    Exemplar front = upright_front();
    front.sources = sources_but_about(front.coarse, 17.0, 9.0, 4.0);
    for_each_pixel(front.fine, [&](std::int64_t x, std::int64_t y) {
        if (*front.sources.at(x, y) == 0.0f) *front.fine.at(x, y) = std::numeric_limits<float>::quiet_NaN();
    });
    Image base = make_image(64, 64, 1);
    for_each_pixel(base,
                   [&](std::int64_t x, std::int64_t y) { *base.at(x, y) = *front.coarse.at(x / 2, y / 2); });
    double energy = 0.0;
    for (const float value : exemplar_details(base, front, 2, {}, 5u).pixels) {
        ASSERT_TRUE(std::isfinite(value));
        energy += double(value * value);
    }
    EXPECT_GT(energy, 1.0);
    front.sources = make_image(32, 32, 1);
    for (const float value : exemplar_details(base, front, 2, {}, 5u).pixels) ASSERT_EQ(value, 0.0f);
}

}  // namespace
}  // namespace astrosplat
