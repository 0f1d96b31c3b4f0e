// Pixels on the screen against those that the writer puts into a file.
#include "gl/display.h"

#include "gl/gl_fixture.h"
#include "gl/objects.h"
#include "output/format.h"
#include "support/color_config.h"
#include "support/test.h"

namespace astrosplat {
namespace {

using test::GlTest;
using View = OutputParams::View;
using Mode = DisplaySettings::Mode;

/// Light from -0.1 to 4 in all combinations, some of it not a number.
Image ramp(std::int64_t width, std::int64_t height, float scale = 1.0f) {
    Image image = make_image(width, height, 4);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x) {
            const float t = float(x) / float(width - 1), u = float(y) / float(height - 1);
            float* p = image.at(x, y);
            p[0] = (t * t * t * 4.1f - 0.1f) * scale;
            p[1] = u * u * scale;
            p[2] = x == 3 ? std::nanf("") : t * u * 0.02f * scale;
            p[3] = t;
        }
    return image;
}

class DisplayPicture : public GlTest {
  protected:
    static constexpr int width = 96, height = 64;
    struct Shown {
        std::vector<unsigned char> bytes;
        int columns;
        const unsigned char* at(int x, int y) const { return &bytes[std::size_t((y * columns + x) * 4)]; }
    };
    Shown show(const DisplaySettings& settings, int columns = width, int rows = height) {
        Display display;
        display.draw(settings, columns, rows);
        return {display.read(), columns};
    }
    /// All of the picture, and of another that it may be compared with.
    DisplaySettings whole(const Image& image) {
        a.emplace().upload(image);
        DisplaySettings settings;
        settings.a = a->handle();
        settings.width = width;
        settings.height = height;
        return settings;
    }
    DisplaySettings compared(const Image& image, const Image& other) {
        DisplaySettings settings = whole(image);
        b.emplace().upload(other);
        settings.b = b->handle();
        return settings;
    }
    static Image grey(float level) { return make_image(width, height, 4, level); }

    std::optional<ImageTexture> a, b;
};

/// The scopes' points: the very pixels of the screen, none of what lies around the picture.
TEST_F(DisplayPicture, PointsAreThoseOfTheScreen) {
    Display display;
    EXPECT_TRUE(display.points().rgba.empty());
    DisplaySettings settings = whole(ramp(width, height));
    settings.inspection.gamma = 1.7f;
    display.draw(settings, width, height);
    EXPECT_EQ(display.points().width, width);
    EXPECT_EQ(display.points().rgba, display.read());
    // In a larger target, moved beyond its left edge, and larger than what is looked at.
    settings.x = -16;
    settings.y = 10;
    settings.background[1] = 1.0f;
    display.draw(settings, 200, 100);
    const ScreenPoints moved = display.points();
    const std::vector<unsigned char> screen = display.read();
    ASSERT_EQ(moved.width, width - 16);
    ASSERT_EQ(moved.rgba.size(), std::size_t((width - 16) * height * 4));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < (width - 16) * 4; ++x)
            ASSERT_EQ(moved.rgba[std::size_t(y * (width - 16) * 4 + x)],
                      screen[std::size_t((y + 10) * 200 * 4 + x)]);
    // Of a larger one every second pixel in x, one of 3.5 in y.
    settings.x = 0;
    settings.width = 1100;
    settings.height = 700;
    display.draw(settings, 1024, 576);
    const ScreenPoints few = display.points();
    const std::vector<unsigned char> large = display.read();
    ASSERT_EQ(few.width, 512);
    ASSERT_EQ(few.rgba.size(), std::size_t(512 * 162 * 4));
    for (std::size_t row = 0; row < 162; row += 8)
        for (std::size_t column = 0; column < 512; column += 16) {
            const unsigned char* const p = &few.rgba[(row * 512 + column) * 4];
            bool found = false;
            for (std::size_t i = 0; i < 10; ++i) {
                const std::size_t x = 2 * column + i % 2,
                                  y = std::min<std::size_t>(575, 10 + row * 566 / 162 + i / 2);
                found = found || std::equal(p, p + 3, &large[(y * 1024 + x) * 4]);
            }
            ASSERT_TRUE(found) << column << " " << row;
        }
    settings.a = 0;
    display.draw(settings, 200, 100);
    EXPECT_TRUE(display.points().rgba.empty());
}

TEST_F(DisplayPicture, EveryViewAsTheWriter) {
    const Image image = ramp(width, height);
    for (const View view : {View::linear, View::srgb, View::soft})
        for (const float stops : {0.0f, 1.5f, -2.0f}) {
            DisplaySettings settings = whole(image);
            settings.view = view;
            settings.exposure = stops;
            const Shown shown = show(settings);
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x)
                    for (int k = 0; k < 3; ++k) {
                        const float light = image.at(x, y)[k] * std::exp2(stops);
                        const float expected = 255.0f * apply_view(view, light);
                        ASSERT_NEAR(float(shown.at(x, y)[k]), expected, 0.51f) << x << " " << y << " " << k;
                    }
        }
}

/// Alone, bent and in bands; negative light and what is no number is dark.
TEST_F(DisplayPicture, AnInspectionIsOfTheWritersPixels) {
    using Channel = Inspection::Channel;
    const Image image = ramp(width, height);
    for (int c = 1; c <= 6; ++c)
        for (const float gamma : {1.0f, 2.0f}) {
            DisplaySettings settings = whole(image);
            settings.exposure = 0.5f;
            settings.inspection = {static_cast<Channel>(c), 1.0f, gamma};
            const Shown shown = show(settings);
            for (int y = 0; y < height; ++y)
                for (int x = 4; x < width; ++x) {
                    const float* const p = image.at(x, y);
                    const float gain = std::exp2(1.5f),
                                sum = 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2];
                    const float one = c <= 3 ? p[c - 1] : sum;
                    const float view =
                        c == 4 ? std::clamp(p[3], 0.0f, 1.0f) : apply_view(View::srgb, one * gain);
                    const glm::vec3 band = shared::band_color(shared::band_of(sum * gain));
                    for (int k = 0; k < 3; ++k)
                        ASSERT_NEAR(float(shown.at(x, y)[k]),
                                    255.0f * (c == 6 ? band[k] : std::pow(view, 1.0f / gamma)), 0.52f)
                            << c << " " << x << " " << y << " " << k;
                }
        }
}

/// Both sides of a wipe are looked at alike; figures of a comparison are those of the pictures.
TEST_F(DisplayPicture, WhatIsComparedIsInspectedAndMeasuredAsItIs) {
    DisplaySettings settings = compared(grey(0.2f), grey(0.5f));
    settings.mode = Mode::wipe;
    settings.inspection.channel = Inspection::Channel::stops;
    const Shown shown = show(settings);
    for (const auto& [x, light] : {std::pair{4, 0.2f}, {width - 4, 0.5f}})
        EXPECT_NEAR(float(shown.at(x, 9)[0]), 255.0f * shared::band_color(shared::band_of(light)).x, 0.51f);
    Display display;
    const Display::Compared inspected = display.read_compared(settings, width, height);
    settings.inspection = {};
    EXPECT_EQ(inspected.a.pixels, display.read_compared(settings, width, height).a.pixels);
}

TEST(ExposureBands, BeginAtStopsAboutMiddleGrey) {
    const float stops[] = {-6.0f, -4.0f, -2.0f, -0.5f, 0.5f, 1.5f};
    for (int i = 0; i < 6; ++i) EXPECT_FLOAT_EQ(shared::band_begin(i + 1), 0.18f * std::exp2(stops[i]));
    for (int band = 0; band < shared::BAND_COUNT; ++band)
        EXPECT_EQ(shared::band_of(shared::band_begin(band)), band);
}

// Matrix and root, a table, and the light itself: at most half a code of 8 bits, what OpenGL's roots lose,
// and of the table of 33 what cards lose that find places between two entries to 1/256 of the step (the least
// that Direct3D asks for; OpenGL names none).
TEST_F(DisplayPicture, ViewsOfAConfigurationAsTheWriter) {
    const TempFolder folder;
    const fs::path config = test::write_color_config(folder.path());
    Image image = ramp(width, height);
    for (float& value : image.pixels)
        if (std::isnan(value)) value = 0.0f;  // a matrix spreads it to all three
    Display display;
    for (const char* view : {"Film", "Negative", "Plain"})
        for (const float stops : {0.0f, 1.5f}) {
            DisplaySettings settings = whole(image);
            settings.ocio = display_transform({config, "Screen", view, ""});
            settings.exposure = stops;
            display.draw(settings, width, height);
            const std::vector<unsigned char> shown = display.read();
            FrameFormat format;
            format.depth = OutputParams::Depth::uint8;
            format.alpha = OutputParams::Alpha::none;
            format.ocio = settings.ocio;
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    float stored[4];
                    encode_pixel(format, std::exp2(stops), image.at(x, y), stored);
                    for (int k = 0; k < 3; ++k)
                        ASSERT_NEAR(float(shown[std::size_t((y * width + x) * 4 + k)]), 255.0f * stored[k],
                                    0.51f + 255.0f / 32.0f / 256.0f)
                            << view << " " << x << " " << y << " " << k;
                }
        }
}

TEST_F(DisplayPicture, AConfigurationsViewIsNotThatOfAReference) {
    const TempFolder folder;
    const fs::path config = test::write_color_config(folder.path());
    DisplaySettings settings = compared(grey(0.25f), grey(0.25f));
    settings.ocio = display_transform({config, "Screen", "Film", ""});
    settings.b_is_display = true;
    settings.mode = Mode::wipe;
    const Shown shown = show(settings);
    EXPECT_EQ(shown.at(10, 10)[0], 128);
    EXPECT_EQ(shown.at(width - 10, 10)[0], 64);
    settings.b_is_display = false;
    EXPECT_EQ(show(settings).at(width - 10, 10)[0], 128);
}

TEST_F(DisplayPicture, DithersAsTheWriter) {
    const Image image = ramp(width, height);
    DisplaySettings settings = whole(image);
    settings.dither = true;
    const Shown shown = show(settings);
    FrameFormat format;
    format.alpha = OutputParams::Alpha::none;
    format.view = OutputParams::View::srgb;
    int different = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int k = 0; k < 3; ++k) {
                const float value = apply_view(format.view, image.at(x, y)[k]) * 255.0f + dither(x, y, k);
                const float expected = std::fmin(std::fmax(std::floor(value + 0.5f), 0.0f), 255.0f);
                ASSERT_NEAR(float(shown.at(x, y)[k]), expected, 1.0f);
                different += float(shown.at(x, y)[k]) != expected;
            }
    EXPECT_LT(different, width * height * 3 / 1000);  // only where rounding of the curve decides
}

TEST_F(DisplayPicture, LiesWhereItIsPutWithBackgroundAround) {
    Image image = make_image(4, 2, 4, 1.0f);
    image.at(0, 0)[1] = 0.0f;  // upper left: magenta
    DisplaySettings settings = whole(image);
    settings.view = View::linear;
    settings.x = 10, settings.y = 20;
    settings.width = 40, settings.height = 20;
    settings.background[0] = 0.2f;
    const Shown shown = show(settings);
    const auto expect = [&](int x, int y, const std::array<int, 3>& rgb) {
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(int(shown.at(x, y)[k]), rgb[k]) << x << " " << y << " channel " << k;
    };
    expect(9, 25, {51, 0, 0});
    expect(10, 19, {51, 0, 0});
    expect(10, 20, {255, 0, 255});
    expect(19, 29, {255, 0, 255});  // ten times as large, with hard edges
    expect(20, 29, {255, 255, 255});
    expect(10, 30, {255, 255, 255});
    expect(49, 39, {255, 255, 255});
    expect(50, 39, {51, 0, 0});
    expect(49, 40, {51, 0, 0});
}

TEST_F(DisplayPicture, LargerThanTheTargetItIsCut) {
    const Image image = ramp(2 * width, 2 * height);
    DisplaySettings settings = whole(image);
    settings.x = -30, settings.y = -17;
    settings.width = 2 * width, settings.height = 2 * height;
    const Shown shown = show(settings);
    for (const auto& [x, y] : {std::pair{0, 0}, std::pair{95, 63}, std::pair{40, 7}})
        EXPECT_NEAR(float(shown.at(x, y)[0]),
                    255.0f * apply_view(OutputParams::View::srgb, image.at(x + 30, y + 17)[0]), 0.51f);
}

TEST_F(DisplayPicture, ShrunkItIsTheMean) {
    Image image = make_image(8 * width, 8 * height, 4, 0.0f);
    for (std::int64_t y = 0; y < image.height; ++y)
        for (std::int64_t x = 0; x < image.width; ++x) image.at(x, y)[0] = (x + y) % 2 == 0 ? 1.0f : 0.0f;
    DisplaySettings settings = whole(image);
    settings.view = View::linear;
    const Shown shown = show(settings);
    for (int x = 0; x < width; ++x) EXPECT_NEAR(int(shown.at(x, 11)[0]), 128, 1);
}

TEST_F(DisplayPicture, WipeShowsAToTheLeftAndBToTheRightOfALine) {
    DisplaySettings settings = compared(grey(0.25f), grey(0.75f));
    settings.view = View::linear;
    settings.mode = Mode::wipe;
    settings.wipe = 0.25f;
    const Shown shown = show(settings);
    EXPECT_EQ(int(shown.at(23, 5)[0]), 64);
    EXPECT_EQ(int(shown.at(24, 5)[0]), 217);  // the line
    EXPECT_EQ(int(shown.at(25, 5)[0]), 191);
    settings.mode = Mode::b;
    EXPECT_EQ(int(show(settings).at(0, 0)[0]), 191);
    settings.mode = Mode::a;
    EXPECT_EQ(int(show(settings).at(95, 0)[0]), 64);
    settings.mode = Mode::wipe;
    settings.wipe = 0.0f;  // all B, no line
    EXPECT_EQ(int(show(settings).at(0, 0)[0]), 191);
}

TEST_F(DisplayPicture, DifferenceIsOfDisplayValuesTimesGainAboutGrey) {
    DisplaySettings settings = compared(grey(0.5f), grey(0.7f));
    settings.mode = Mode::difference;
    settings.difference_gain = 2.0f;
    const float srgb_half = apply_view(OutputParams::View::srgb, 0.5f);
    const float srgb_other = apply_view(OutputParams::View::srgb, 0.7f);
    EXPECT_NEAR(float(show(settings).at(7, 7)[1]), 127.5f + 255.0f * (srgb_half - srgb_other), 0.6f);
    settings.b_is_display = true;
    settings.difference_gain = 10.0f;
    EXPECT_NEAR(float(show(settings).at(7, 7)[1]), 127.5f + 1275.0f * (srgb_half - 0.7f), 0.6f);
    settings.b = a->handle();
    settings.b_is_display = false;
    EXPECT_EQ(int(show(settings).at(7, 7)[1]), 128) << "equal pictures are grey, not black";
}

/// Half as wide as the frame, a quarter turn counter-clockwise: its upper left corner lies at the lower left.
TEST_F(DisplayPicture, APlacedPictureLiesOverAWhereItIsPut) {
    Image picture = make_image(2, 2, 4, 0.0f);
    picture.at(0, 0)[0] = 1.0f;  // upper left: red
    picture.at(1, 0)[1] = 1.0f;  // upper right: green
    DisplaySettings settings = compared(grey(0.25f), picture);
    settings.view = View::linear;
    settings.b_is_display = true;
    settings.mode = Mode::b;
    settings.b_place = PicturePlace{{20.0, 50.0}, {0.0, -40.0}, {40.0, 0.0}};
    const auto color = [](const Shown& shown, int x, int y) {
        return std::array{int(shown.at(x, y)[0]), int(shown.at(x, y)[1]), int(shown.at(x, y)[2])};
    };
    const Shown shown = show(settings);
    EXPECT_EQ(color(shown, 22, 47), (std::array{255, 0, 0}));
    EXPECT_EQ(color(shown, 22, 12), (std::array{0, 255, 0}));
    EXPECT_EQ(color(shown, 57, 47), (std::array{0, 0, 0}));
    EXPECT_EQ(color(shown, 19, 47), (std::array{64, 64, 64})) << "A shows around it";
    EXPECT_EQ(color(shown, 22, 51), (std::array{64, 64, 64}));
    settings.b_opacity = 0.5f;
    EXPECT_EQ(color(show(settings), 22, 47), (std::array{159, 32, 32}));
    settings.mode = Mode::difference;
    EXPECT_EQ(color(show(settings), 22, 47), (std::array{32, 159, 159})) << "as if it were opaque";
    EXPECT_EQ(color(show(settings), 5, 5), (std::array{64, 64, 64})) << "not compared";
}

TEST_F(DisplayPicture, WhatIsComparedCanBeReadWithTheMaskOfB) {
    DisplaySettings settings = compared(grey(0.5f), make_image(8, 8, 4, 0.75f));
    settings.view = View::linear;
    settings.x = 10.0f;
    settings.b_is_display = true;
    settings.b_opacity = 0.1f;
    settings.b_place = PicturePlace{{20.0, 0.0}, {16.0, 0.0}, {0.0, 16.0}};
    Display display;
    const Display::Compared sides = display.read_compared(settings, width, height);
    ASSERT_EQ(sides.a.width, width - 10);
    ASSERT_EQ(sides.b.height, height);
    int inside = 0;
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width - 10; ++x) {
            ASSERT_EQ(sides.a.at(x, y)[1], 0.5f);
            const float* p = sides.b.at(x, y);
            inside += p[3] == 1.0f;
            ASSERT_EQ(p[1], p[3] == 1.0f ? 0.75f : 0.5f);
        }
    EXPECT_EQ(inside, 16 * 16);
    EXPECT_EQ(sides.b.at(10, height - 1)[3], 1.0f) << "rows begin at the bottom";
}

TEST_F(DisplayPicture, ATileAloneIsReplaced) {
    const DisplaySettings settings = whole(grey(0.0f));
    a->upload(grey(1.0f), {16, 8, 32, 24});
    const Shown shown = show(settings);
    EXPECT_EQ(int(shown.at(15, 8)[0]), 0);
    EXPECT_EQ(int(shown.at(16, 8)[0]), 255);
    EXPECT_EQ(int(shown.at(47, 31)[0]), 255);
    EXPECT_EQ(int(shown.at(48, 31)[0]), 0);
    EXPECT_EQ(int(shown.at(16, 32)[0]), 0);
}

}  // namespace
}  // namespace astrosplat
