// Measures of a front view against closed forms, and against the measures that the targets were set with:
// numbers of an independent program in double precision (numpy and scipy) for the same drawn pictures.
#include "fidelity/front.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/color.h"
#include "drawn.h"
#include "image/resample.h"

namespace astrosplat {
namespace {

Image times(Image image, float r, float g, float b) {
    for (std::int64_t i = 0; i < image.width * image.height; ++i) {
        float* const p = image.pixels.data() + i * image.channels;
        p[0] *= r, p[1] *= g, p[2] *= b;
    }
    return image;
}

// Displayed values a and b everywhere.
double psnr_of_flat(double a, double b) {
    const auto flat = [](double displayed) {
        return make_image(40, 30, 3, static_cast<float>(real::srgb_to_linear(displayed)));
    };
    return psnr_db(flat(a), flat(b));
}

TEST(Psnr, OfAKnownError) {
    EXPECT_NEAR(psnr_of_flat(0.5, 0.6), 20.0, 1e-4);
    EXPECT_NEAR(psnr_of_flat(0.30, 0.31), 40.0, 1e-3);
    EXPECT_NEAR(psnr_of_flat(0.3, 0.3), 120.0, 1e-9);
    EXPECT_NEAR(psnr_of_flat(0.9, 1.7), 20.0, 1e-4) << "what is displayed ends at white";
}

TEST(Ssim, OfItselfIsOneAndOfFlatPicturesItsFormula) {
    const Image image = waves_and_stars(1);
    EXPECT_NEAR(ssim(image, image), 1.0, 1e-12);
    const Image dark = make_image(30, 20, 3, static_cast<float>(real::srgb_to_linear(0.2)));
    const Image light = make_image(30, 20, 3, static_cast<float>(real::srgb_to_linear(0.6)));
    EXPECT_NEAR(ssim(dark, light), (2 * 0.2 * 0.6 + 1e-4) / (0.04 + 0.36 + 1e-4), 1e-4);
}

// Floats instead of doubles move the displayed values by 1e-7, a sixtieth of a thousandth of the error
// measured.
TEST(FrontFidelity, IsTheNumbersOfTheMeasuresThatTargetsWereSetWith) {
    const Image picture = waves_and_stars(2), seen = rendered_waves_and_stars();
    const Image reference = resampled(picture, map_to_width(picture, 240, 160), 240, 160, 0.5);
    const FrontFidelity front = front_fidelity(seen, reference);
    EXPECT_NEAR(front.psnr_db, 41.407099483, 1e-3);
    EXPECT_NEAR(front.ssim, 0.953323037, 1e-4);
    EXPECT_NEAR(front.flux.frame, 0.9999702084, 1e-6);
    EXPECT_EQ(front.width_px, 240);
    EXPECT_EQ(front.height_px, 160);
}

TEST(FrontFidelity, LeavesTheBorderOut) {
    const Image a = waves_and_stars(1);
    Image b = a;
    for (std::int64_t y = 0; y < b.height; ++y)
        for (std::int64_t x = 0; x < b.width; ++x)
            if (x < 24 || y < 24 || x >= b.width - 24 || y >= b.height - 24) b.at(x, y)[1] = 0.0f;
    EXPECT_LT(front_fidelity(b, a).psnr_db, 20.0);
    EXPECT_LT(front_fidelity(b, a, 0.09).psnr_db, 50.0);
    EXPECT_EQ(front_fidelity(b, a, 0.1).psnr_db, psnr_db(a, a));
}

TEST(Flux, OfAScaledPictureIsTheScale) {
    const Image picture = waves_and_stars(1);
    const FluxRatios flux = flux_ratios(times(picture, 1.25f, 1.0f, 0.5f), picture);
    EXPECT_NEAR(flux.channels[0], 1.25, 1e-6);
    EXPECT_NEAR(flux.channels[1], 1.0, 1e-6);
    EXPECT_NEAR(flux.channels[2], 0.5, 1e-6);
    const FluxRatios even = flux_ratios(times(picture, 1.1f, 1.1f, 1.1f), picture);
    for (const double cell : even.cells) EXPECT_NEAR(cell, 1.1, 1e-6);
    for (const double p : {even.frame, even.cells_5, even.cells_50, even.cells_95}) EXPECT_NEAR(p, 1.1, 1e-6);
}

TEST(Flux, ThePercentilesAreThoseOfTheCells) {
    const Image reference = make_image(320, 320, 3, 0.5f);
    Image seen = reference;  // the columns of cells hold 1.00, 1.01 ... 1.31 of the light
    for (std::int64_t y = 0; y < 320; ++y)
        for (std::int64_t x = 0; x < 320; ++x) seen.at(x, y)[1] *= 1.0f + 0.03f * static_cast<float>(x / 10);
    const FluxRatios flux = flux_ratios(seen, reference);
    EXPECT_NEAR(flux.cells_5, 1.01, 1e-5);
    EXPECT_NEAR(flux.cells_50, 1.155, 1e-5);
    EXPECT_NEAR(flux.cells_95, 1.30, 1e-5);
}

TEST(Flux, ACellIsAPlaceAndADarkOneCountsForNothing) {
    Image reference = make_image(64, 96, 3, 0.5f), seen = reference;  // cells of 2 x 3 px
    const auto set_cell = [](Image& image, std::int64_t column, std::int64_t row, float value) {
        for (std::int64_t y = 3 * row; y < 3 * row + 3; ++y)
            for (std::int64_t x = 2 * column; x < 2 * column + 2; ++x) std::fill_n(image.at(x, y), 3, value);
    };
    set_cell(seen, 5, 7, 1.0f);
    set_cell(reference, 31, 0, 0.001f);
    const FluxRatios flux = flux_ratios(seen, reference);
    for (std::size_t i = 0; i < flux.cells.size(); ++i) {
        if (i == 31)
            EXPECT_TRUE(std::isnan(flux.cells[i]));
        else
            EXPECT_NEAR(flux.cells[i], i == 7 * 32 + 5 ? 2.0 : 1.0, 1e-9) << i;
    }
    EXPECT_TRUE(std::isnan(flux_ratios(seen, make_image(64, 96, 3)).frame));
}

TEST(ScalePower, OfAScaledWaveIsTheSquareInItsBandAlone) {
    // Waves of displayed values about one half, of periods 8 and 64 px; the short one is drawn at 60 %.
    const auto wave = [](double share) {
        return drawn(256, 256, [&](std::int64_t x, std::int64_t, int) {
            const double phase = 2.0 * 3.14159265358979 * static_cast<double>(x);
            return real::srgb_to_linear(0.5 + 0.1 * share * std::sin(phase / 8.0) +
                                        0.1 * std::sin(phase / 64.0));
        });
    };
    const std::vector<ScalePower> bands = power_by_scale(wave(0.6), wave(1.0));
    ASSERT_EQ(bands.size(), 6u);  // up to 32 px, an eighth of the side
    EXPECT_EQ(bands[0].finer_px, 0.0);
    EXPECT_EQ(bands[0].coarser_px, 1.0);
    EXPECT_EQ(bands[5].coarser_px, 32.0);
    EXPECT_NEAR(bands[0].ratio, 0.36, 0.01);
    EXPECT_NEAR(bands[1].ratio, 0.36, 0.01);
    EXPECT_NEAR(bands[4].ratio, 1.0, 0.01);
    EXPECT_TRUE(std::isnan(power_by_scale(wave(1.0), make_image(256, 256, 3, 0.2f))[2].ratio));
}

}  // namespace
}  // namespace astrosplat
