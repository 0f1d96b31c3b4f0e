// The content of frame files: pixels, text, and settings that go together.
#include "core/color.h"
#include "core/text.h"
#include "output/compare.h"
#include "output/format.h"
#include "output/metadata.h"
#include "output/write.h"
#include "support/color_config.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Pixels as a file holds them: closed forms of view, alpha rule and dither.

using Alpha = OutputParams::Alpha;
using Depth = OutputParams::Depth;
using View = OutputParams::View;

FrameFormat format_of(Depth depth, Alpha alpha, View view = View::srgb) {
    FrameFormat format;
    format.kind = FrameKind::tif;
    format.depth = depth;
    format.alpha = alpha;
    format.view = view;
    return format;
}

Image flat(std::int64_t width, std::int64_t height, float r, float g, float b, float a) {
    Image image = make_image(width, height, 4);
    for (std::int64_t i = 0; i < width * height; ++i) {
        float* p = image.pixels.data() + 4 * i;
        p[0] = r, p[1] = g, p[2] = b, p[3] = a;
    }
    return image;
}

TEST(View, SrgbMatchesTheCurve) {
    for (int i = 0; i <= 100000; ++i) {
        float x = float(i) / 100000.0f;
        EXPECT_NEAR(apply_view(View::srgb, x), real::linear_to_srgb(double(x)), 2e-7) << x;
    }
    EXPECT_EQ(apply_view(View::srgb, 1.0f), 1.0f);
    EXPECT_EQ(apply_view(View::srgb, 0.0f), 0.0f);
}

TEST(View, SoftIsItsFormulaThenSrgb) {
    for (double x : {0.001, 0.18, 1.0, 4.0, 100.0}) {
        double soft = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
        EXPECT_NEAR(apply_view(View::soft, float(x)), real::linear_to_srgb(std::fmin(soft, 1.0)), 1e-6);
    }
}

TEST(View, EveryValueStaysInRange) {
    const float odd[] = {
        -1.0f, -0.0f, 1e30f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN(),
        1e-40f};
    for (View view : {View::linear, View::srgb, View::soft})
        for (float x : odd) {
            float y = apply_view(view, x);
            EXPECT_TRUE(y >= 0.0f && y <= 1.0f) << x;
        }
    EXPECT_EQ(apply_view(View::soft, 1e30f), 1.0f);
}

TEST(View, OfAConfigurationIsThatOfTheStraightColour) {
    const TempFolder folder;
    const OcioParams params{test::write_color_config(folder.path()), "", "", ""};
    FrameFormat format = format_of(Depth::uint16, Alpha::premultiplied);
    format.ocio = display_transform(params);
    const float a = 0.5f, rgba[4] = {0.2f * a, 0.05f * a, 0.4f * a, a};
    float stored[4];
    encode_pixel(format, 2.0f, rgba, stored);
    const auto expected = test::film(0.4, 0.1, 0.8);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(stored[c], expected[std::size_t(c)] * 0.5, 1e-6) << c;
    EXPECT_EQ(stored[3], a);
    const std::vector<std::uint16_t> rows = encode_16bit(format, flat(3, 2, 0.2f, 0.05f, 0.4f, 1.0f));
    encode_pixel(format, 1.0f, std::array{0.2f, 0.05f, 0.4f, 1.0f}.data(), stored);
    for (std::size_t i = 0; i < rows.size(); ++i)
        EXPECT_EQ(rows[i], std::uint16_t(stored[i % 4] * 65535.0f + 0.5f)) << i;
}

TEST(Encode, NoneIsOpaqueOverBlack) {
    const float rgba[4] = {0.25f, 0.0f, 0.5f, 0.5f};
    float stored[3];
    encode_pixel(format_of(Depth::uint8, Alpha::none), 1.0f, rgba, stored);
    EXPECT_EQ(stored[0], apply_view(View::srgb, 0.25f));
    EXPECT_EQ(stored[2], apply_view(View::srgb, 0.5f));
}

TEST(Encode, SoftEdgesKeepTheirColour) {
    // The same orange at every alpha.
    for (float a : {1.0f, 0.5f, 0.01f}) {
        const float rgba[4] = {0.8f * a, 0.4f * a, 0.1f * a, a};
        float straight[4], premultiplied[4];
        encode_pixel(format_of(Depth::uint16, Alpha::straight), 1.0f, rgba, straight);
        encode_pixel(format_of(Depth::uint16, Alpha::premultiplied), 1.0f, rgba, premultiplied);
        EXPECT_NEAR(straight[0], apply_view(View::srgb, 0.8f), 1e-6f);
        EXPECT_NEAR(straight[2], apply_view(View::srgb, 0.1f), 1e-6f);
        EXPECT_EQ(straight[3], a);
        EXPECT_NEAR(premultiplied[0], apply_view(View::srgb, 0.8f) * a, 1e-6f);
        EXPECT_EQ(premultiplied[3], a);
    }
}

TEST(Encode, SceneLightIsCopiedOrDivided) {
    const float rgba[4] = {3.0f, -0.25f, 0.5f, 0.5f};
    float stored[4];
    encode_pixel(format_of(Depth::float32, Alpha::premultiplied, View::linear), 1.0f, rgba, stored);
    for (int c = 0; c < 4; ++c) EXPECT_EQ(stored[c], rgba[c]);
    encode_pixel(format_of(Depth::float32, Alpha::straight, View::linear), 1.0f, rgba, stored);
    EXPECT_EQ(stored[0], 6.0f);
    EXPECT_EQ(stored[3], 0.5f);
}

TEST(Encode, LightWithoutAlphaCannotBeStraight) {
    const float rgba[4] = {1.0f, 1.0f, 1.0f, 0.0f};
    float stored[4];
    for (Depth depth : {Depth::uint8, Depth::float32}) {
        encode_pixel(format_of(depth, Alpha::straight), 1.0f, rgba, stored);
        for (float x : stored) EXPECT_EQ(x, 0.0f);
    }
}

TEST(Encode, ExposureIsAPowerOfTwoBeforeTheView) {
    FrameFormat format = format_of(Depth::uint16, Alpha::none);
    format.exposure = 2.0;
    const std::uint16_t brighter = encode_16bit(format, flat(1, 1, 0.1f, 0, 0, 1))[0];
    format.exposure = 0.0;
    EXPECT_EQ(brighter, encode_16bit(format, flat(1, 1, 0.4f, 0, 0, 1))[0]);
}

TEST(Encode, SixteenBitCodesSurvive) {
    FrameFormat format = format_of(Depth::uint16, Alpha::none);
    for (int code = 0; code <= 65535; ++code) {
        auto linear = float(real::srgb_to_linear(code / 65535.0));
        ASSERT_EQ(encode_16bit(format, flat(1, 1, linear, 0, 0, 1))[0], code);
    }
}

TEST(Dither, KeepsEveryCodeAtEveryPlace) {
    FrameFormat format = format_of(Depth::uint8, Alpha::none);
    for (int code = 0; code <= 255; ++code) {
        auto linear = float(real::srgb_to_linear(code / 255.0));
        for (std::uint8_t stored : encode_8bit(format, flat(40, 40, linear, linear, linear, 1), 1000, 77))
            ASSERT_EQ(stored, code);
    }
}

TEST(Dither, KeepsTheMeanBetweenCodes) {
    FrameFormat format = format_of(Depth::uint8, Alpha::none, View::linear);
    for (double value : {100.25, 100.5, 100.9, 0.3}) {
        double sum = 0.0;
        auto x = float(value / 255.0);
        std::vector<std::uint8_t> bytes = encode_8bit(format, flat(64, 64, x, x, x, 1), 0, 0);
        for (std::uint8_t b : bytes) {
            EXPECT_LE(std::fabs(b - value), 1.0);
            sum += b;
        }
        EXPECT_NEAR(sum / double(bytes.size()), value, 0.01);
    }
}

TEST(Dither, BelongsToThePlaceInTheWholePicture) {
    FrameFormat format = format_of(Depth::uint8, Alpha::none);
    Image image = flat(32, 32, 0.2f, 0.3f, 0.4f, 1);
    std::vector<std::uint8_t> whole = encode_8bit(format, image, 0, 0);
    std::vector<std::uint8_t> part = encode_8bit(format, flat(8, 8, 0.2f, 0.3f, 0.4f, 1), 20, 11);
    for (std::size_t y = 0; y < 8; ++y)
        for (std::size_t x = 0; x < 24; ++x) EXPECT_EQ(part[y * 24 + x], whole[(y + 11) * 96 + 60 + x]);
}

TEST(Dither, StaysWithinHalfACodeAndDiffersByChannel) {
    int equal = 0;
    for (std::int64_t x = 0; x < 100; ++x) {
        EXPECT_LT(std::fabs(dither(x, -x * 3, 2)), 0.5f);
        equal += dither(x, 5, 0) == dither(x, 5, 1);
    }
    EXPECT_LT(equal, 10);
}

TEST(Dither, PremultipliedColourNeverExceedsAlpha) {
    FrameFormat format = format_of(Depth::uint8, Alpha::premultiplied);
    std::vector<std::uint8_t> bytes = encode_8bit(format, flat(64, 64, 0.3f, 0.3f, 0.2f, 0.3f), 0, 0);
    for (std::size_t i = 0; i < bytes.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c) ASSERT_LE(bytes[i + c], bytes[i + 3]);
}

// Picture differences against sums done by hand.

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
    const TempFolder folder;
    RenderedFrame small, large;
    small.beauty = make_image(4, 4, 4, 0.25f);
    large.beauty = make_image(5, 4, 4, 0.25f);
    OutputParams output;
    output.depth = OutputParams::Depth::float32;
    write_frame({folder / "a.exr", output, 4, 4}, small, {});
    write_frame({folder / "b.exr", output, 5, 4}, large, {});
    write_frame({folder / "c.tif", output, 4, 4}, small, {});
    EXPECT_TRUE(compare_files(folder / "a.exr", folder / "c.tif").identical());
    EXPECT_EQ(ERROR_OF(compare_files(folder / "a.exr", folder / "b.exr")),
              fmt::format("{}: expected 4 x 4 pixels as in {}, found 5 x 4", (folder / "b.exr").string(),
                          (folder / "a.exr").string()));
}

// Which settings go together, and each message where they do not.

using Compression = OutputParams::Compression;

OutputParams to(const char* path, Depth depth = Depth::automatic,
                Compression compression = Compression::automatic) {
    OutputParams output;
    output.path = path;
    output.depth = depth;
    output.compression = compression;
    return output;
}

std::string error_of(const OutputParams& output) { return ERROR_OF(check_output(output)); }

TEST(Format, AutoFollowsTheEnding) {
    OutputParams output;
    output.exposure = 1.5;
    FrameFormat exr = resolve_format(output, "a.exr"), tif = resolve_format(output, "a.TIFF"),
                png = resolve_format(output, "a.png");
    EXPECT_EQ(exr.depth, Depth::half_float);
    EXPECT_EQ(exr.compression, Compression::zip);
    EXPECT_EQ(exr.alpha, Alpha::premultiplied);
    EXPECT_EQ(exr.view, View::linear);
    EXPECT_EQ(exr.exposure, 0.0);
    EXPECT_EQ(tif.kind, FrameKind::tif);
    EXPECT_EQ(tif.depth, Depth::uint16);
    EXPECT_EQ(tif.compression, Compression::deflate);
    EXPECT_EQ(tif.alpha, Alpha::premultiplied);
    EXPECT_EQ(tif.view, View::srgb);
    EXPECT_EQ(tif.exposure, 1.5);
    EXPECT_EQ(png.depth, Depth::uint8);
    EXPECT_EQ(png.alpha, Alpha::none);
    EXPECT_EQ(png.view, View::srgb);
}

TEST(Format, FilesOfSceneLightTakeNoViewAndNoExposure) {
    OutputParams output;
    output.view = View::soft;
    output.exposure = 2.0;
    output.depth = Depth::float32;
    for (const char* file : {"a.exr", "a.tif"}) {
        EXPECT_EQ(resolve_format(output, file).view, View::linear);
        EXPECT_EQ(resolve_format(output, file).exposure, 0.0);
    }
    output.depth = Depth::uint8;
    EXPECT_EQ(resolve_format(output, "a.tif").view, View::soft);
}

TEST(Format, OnlyExrHoldsOtherPrimaries) {
    OutputParams output = to("a.exr");
    output.primaries = OutputParams::Primaries::acescg;
    EXPECT_EQ(resolve_format(output, "a.exr").primaries, OutputParams::Primaries::acescg);
    EXPECT_EQ(resolve_format(output, "a.png").primaries, OutputParams::Primaries::rec709);
    EXPECT_EQ(resolve_format(output, "a.tif").primaries, OutputParams::Primaries::rec709);
    output = to("a.tif", Depth::float32);
    EXPECT_EQ(error_of(output), "no error");
    output.primaries = OutputParams::Primaries::acescg;
    EXPECT_EQ(error_of(output), "output.primaries: expected rec709 in float tif files, found acescg");
}

TEST(Format, EveryGoodCombinationPasses) {
    for (Compression c :
         {Compression::zip, Compression::zips, Compression::piz, Compression::dwaa, Compression::none}) {
        OutputParams output = to("a.####.exr", Depth::float32, c);
        output.aovs = {"depth", "coverage", "count", "layers"};
        EXPECT_EQ(error_of(output), "no error");
    }
    for (Compression c : {Compression::deflate, Compression::lzw, Compression::none})
        EXPECT_EQ(error_of(to("a.####.tif", Depth::automatic, c)), "no error");
}

TEST(Format, EachMisfitHasItsMessage) {
    EXPECT_EQ(error_of(to("a.####.jpg")),
              "output.path: expected a file ending in .exr, .tif, .tiff or .png, found 'a.####.jpg'");
    EXPECT_EQ(error_of(to("frames")),
              "output.path: expected a file ending in .exr, .tif, .tiff or .png, found 'frames'");
    EXPECT_EQ(error_of(to("a.png", Depth::float32)),
              "output.depth: expected 8 or 16 in png files, found float");
    EXPECT_EQ(error_of(to("a.tif", Depth::half_float)),
              "output.depth: expected 8, 16 or float in tif files, found half");
    EXPECT_EQ(error_of(to("a.exr", Depth::uint8)),
              "output.depth: expected half or float in exr files, found 8");
    EXPECT_EQ(error_of(to("a.exr", Depth::automatic, Compression::lzw)),
              "output.compression: expected zip, zips, piz, dwaa or none in exr files, found lzw");
    EXPECT_EQ(error_of(to("a.tif", Depth::automatic, Compression::piz)),
              "output.compression: expected deflate, lzw or none in tif files, found piz");
    EXPECT_EQ(error_of(to("a.png", Depth::automatic, Compression::zip)),
              "output.compression: expected auto in png files, found zip");
    OutputParams png = to("a.png");
    png.aovs = {"depth"};
    EXPECT_EQ(error_of(png),
              "output.aovs: expected none in png files (extra channels need exr), found 'depth'");
    OutputParams unknown = to("a.exr");
    unknown.aovs = {"normals"};
    EXPECT_EQ(error_of(unknown), "output.aovs: expected depth, coverage, count or layers, found 'normals'");
    OutputParams empty = to("a.exr");
    empty.width = 0;
    EXPECT_EQ(error_of(empty), "output.resolution: expected at least 1 x 1 px, found 0 x 1080");
}

// The canonical text as a frame file carries it: there and back, and what two texts do not share.

TEST(HashedText, ComesBackAsItWas) {
    std::string text = "pixels = 2\nlayer.\xc3\xbc.name = \"\xc3\xbc\"\n";
    EXPECT_EQ(unpack_hashed_text(pack_hashed_text(text)), text);
    for (int i = 0; i < 20000; ++i) text += "key" + std::to_string(i) + " = 0.25\n";
    const std::string packed = pack_hashed_text(text);
    EXPECT_EQ(unpack_hashed_text(packed), text);
    EXPECT_LT(packed.size(), text.size() / 3);
    EXPECT_EQ(packed.find_first_of(" \n\t"), packed.npos);
}

TEST(HashedText, DamagedOnesAreNone) {
    const std::string packed = pack_hashed_text("output.exposure = 0.5\noutput.view = \"srgb\"\n");
    EXPECT_FALSE(unpack_hashed_text(""));
    EXPECT_FALSE(unpack_hashed_text("no base64!"));
    EXPECT_FALSE(unpack_hashed_text(packed.substr(0, packed.size() / 8 * 4)));
    EXPECT_FALSE(unpack_hashed_text(base64("bytes that were never deflated")));
    EXPECT_FALSE(unpack_hashed_text(pack_hashed_text(std::string(std::size_t{70} << 20, '0'))))
        << "few bytes that claim a lot of memory";
}

TEST(HashedText, TellsWhichKeysDiffer) {
    const std::string a =
        "pixels = 2\nx.both = 1\nx.other = [1, 2]\nx.gone = \"a = b\"\nx.path = 1\nx.path = 2\n";
    const std::string b = "pixels = 2\nx.both = 1\nx.other = [1, 3]\nx.path = 1\nx.path = 3\nx.new = 0.5\n";
    const std::vector<KeyDifference> expected = {{"x.other", "[1, 2]", "[1, 3]"},
                                                 {"x.gone", "\"a = b\"", ""},
                                                 {"x.path", "1; 2", "1; 3"},
                                                 {"x.new", "", "0.5"}};
    EXPECT_EQ(differing_keys(a, b), expected);
    EXPECT_TRUE(differing_keys(a, a).empty());
    EXPECT_EQ(hashed_value(a, "x.other"), "[1, 2]");
    EXPECT_FALSE(hashed_value(a, "x.new"));
}

}  // namespace
}  // namespace astrosplat
