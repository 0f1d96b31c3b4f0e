// Small pictures written here and read back: colour space, alpha rules, windows, FITS, messages.
#include "support/test.h"
// its fmt first: OpenImageIO's copy would turn exceptions off
#include <OpenImageIO/imageio.h>
#include <fitsio.h>

#include "core/color.h"
#include "source/fits.h"
#include "source/picture.h"
#include "source/texture.h"

namespace astrosplat {
namespace {

using Alpha = TextureSettings::Alpha;
using Colorspace = TextureSettings::Colorspace;
using Stretch = TextureSettings::Stretch;
using Unpremultiply = TextureSettings::Unpremultiply;
using Wrap = TextureSettings::Wrap;
using Pixels = std::vector<float>;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

struct Written {
    int width, height;
    std::vector<std::string> channels;
    OIIO::TypeDesc type = OIIO::TypeFloat;
    bool straight = false;  // files that can say so: alpha is unassociated
};

fs::path write(const fs::path& file, const Written& what, const Pixels& pixels) {
    OIIO::ImageSpec spec(what.width, what.height, int(what.channels.size()), what.type);
    spec.channelnames = what.channels;
    for (std::size_t c = 0; c < what.channels.size(); ++c)
        if (what.channels[c] == "A") spec.alpha_channel = int(c);
    if (what.straight) spec.attribute("oiio:UnassociatedAlpha", 1);
    const auto out = OIIO::ImageOutput::create(file.string());
    EXPECT_TRUE(out && out->open(file.string(), spec) && out->write_image(OIIO::TypeFloat, pixels.data()) &&
                out->close());
    return file;
}

Pixels pixels_of(const fs::path& file, const TextureSettings& settings = {}) {
    const Texture texture = load_texture({file}, settings, Wrap::clamp);
    return {texture.image.pixels.begin(), texture.image.pixels.end()};
}

const std::vector<std::string> rgb{"R", "G", "B"}, rgba{"R", "G", "B", "A"};

class TextureTest : public testing::Test {
  protected:
    const TempFolder folder;
};

TEST_F(TextureTest, EightBitsAreSrgbFloatIsLinear) {
    const fs::path png =
        write(folder / "ä b.png", {1, 1, rgb, OIIO::TypeUInt8}, {1.0f, 128.0f / 255.0f, 0.0f});
    const fs::path exr = write(folder / "x.exr", {1, 1, rgb}, {1.0f, 0.5f, 0.0f});
    TextureSettings settings;
    settings.alpha = Alpha::one;
    const auto middle = float(real::srgb_to_linear(128.0 / 255.0));
    EXPECT_EQ(pixels_of(png, settings), (Pixels{1.0f, middle, 0.0f, 1.0f}));
    EXPECT_EQ(pixels_of(exr, settings), (Pixels{1.0f, 0.5f, 0.0f, 1.0f}));
    settings.colorspace = Colorspace::linear;
    EXPECT_EQ(pixels_of(png, settings), (Pixels{1.0f, 128.0f / 255.0f, 0.0f, 1.0f}));
    settings.colorspace = Colorspace::srgb;
    EXPECT_EQ(pixels_of(exr, settings)[1], float(real::srgb_to_linear(0.5)));
}

TEST_F(TextureTest, SixteenBitsAreSrgbToTheLastStep) {
    const fs::path tif =
        write(folder / "x.tif", {1, 1, rgb, OIIO::TypeUInt16}, {1.0f / 65535, 30000.0f / 65535, 1.0f});
    EXPECT_EQ(pixels_of(tif)[1], float(real::srgb_to_linear(30000.0 / 65535.0)));
}

TEST_F(TextureTest, DerivedAlphaIsTheBrightestChannelAndKeepsThePicture) {
    const fs::path exr = write(folder / "x.exr", {1, 1, rgb}, {0.25f, 0.5f, 0.125f});
    const Texture texture = load_texture({exr}, {}, Wrap::clamp);
    EXPECT_TRUE(texture.divided);
    EXPECT_EQ(pixels_of(exr), (Pixels{0.25f, 0.5f, 0.125f, 0.5f}));
    const TextureSample s = sample(texture, {0.5f, 0.5f});
    EXPECT_EQ(s.color, glm::vec3(0.5f, 1.0f, 0.25f));
    EXPECT_EQ(s.alpha, 0.5f);
    TextureSettings settings;
    settings.alpha = Alpha::luminance;
    EXPECT_FLOAT_EQ(pixels_of(exr, settings)[3], 0.2126f * 0.25f + 0.7152f * 0.5f + 0.0722f * 0.125f);
    settings.alpha = Alpha::max;
    settings.unpremultiply = Unpremultiply::no;  // the picture squared, for those who ask for it
    EXPECT_EQ(pixels_of(exr, settings), (Pixels{0.125f, 0.25f, 0.0625f, 0.5f}));
}

TEST_F(TextureTest, StraightFileAlphaIsMultipliedInLinearLight) {
    const fs::path png = write(folder / "x.png", {1, 1, rgba, OIIO::TypeUInt8, true},
                               {1.0f, 128.0f / 255.0f, 0.0f, 51.0f / 255.0f});
    const Texture texture = load_texture({png}, {}, Wrap::clamp);
    EXPECT_FALSE(texture.divided);
    const TextureSample s = sample(texture, {0.5f, 0.5f});
    EXPECT_FLOAT_EQ(s.alpha, 0.2f);
    EXPECT_FLOAT_EQ(s.color.x, 1.0f);
    EXPECT_FLOAT_EQ(s.color.y, float(real::srgb_to_linear(128.0 / 255.0)));
}

TEST_F(TextureTest, AssociatedFileAlphaIsDividedOut) {
    const fs::path exr = write(folder / "x.exr", {1, 1, rgba}, {0.25f, 0.5f, 0.0f, 0.5f});
    const Texture texture = load_texture({exr}, {}, Wrap::clamp);
    EXPECT_TRUE(texture.divided);
    EXPECT_EQ(sample(texture, {0.5f, 0.5f}).color, glm::vec3(0.5f, 1.0f, 0.0f));
    TextureSettings settings;
    settings.unpremultiply = Unpremultiply::no;
    EXPECT_EQ(pixels_of(exr, settings), (Pixels{0.125f, 0.25f, 0.0f, 0.5f}));
}

TEST_F(TextureTest, AssociatedIntegersWereMultipliedEncoded) {
    const fs::path tif = write(folder / "x.tif", {1, 1, rgba, OIIO::TypeUInt16}, {0.5f, 0.25f, 0.0f, 0.5f});
    const Texture texture = load_texture({tif}, {}, Wrap::clamp);
    EXPECT_TRUE(texture.divided);
    const TextureSample s = sample(texture, {0.5f, 0.5f});
    EXPECT_NEAR(s.color.x, 1.0f, 1e-4f);  // white at half alpha stays white
    EXPECT_NEAR(s.color.y, real::srgb_to_linear(0.5), 1e-4);
}

TEST_F(TextureTest, UnusualValues) {
    const fs::path exr = write(folder / "x.exr", {5, 1, rgba},
                               {nan, 1, 1, 1, infinity, 0, 0, 1, -1, 0, 2, 1, 1, 1, 1, 7, 1, 1, 1, -3});
    EXPECT_EQ(pixels_of(exr), (Pixels{0, 0, 0, 0, 65504, 0, 0, 1, 0, 0, 2, 1, 1, 1, 1, 1, 1, 1, 1, 0}));
    EXPECT_EQ(sample(load_texture({exr}, {}, Wrap::clamp), {1.0f, 0.5f}).alpha, 0.0f);
}

TEST_F(TextureTest, SingleChannelsAndGrayBecomeGray) {
    for (const char* channel : {"Y", "G", "Z"}) {
        const fs::path exr = write(folder / (std::string(channel) + ".exr"), {1, 1, {channel}}, {0.5f});
        EXPECT_EQ(pixels_of(exr), (Pixels{0.5f, 0.5f, 0.5f, 0.5f})) << channel;
    }
    const fs::path ya = write(folder / "ya.exr", {1, 1, {"Y", "A"}}, {0.25f, 0.5f});
    EXPECT_EQ(pixels_of(ya), (Pixels{0.25f, 0.25f, 0.25f, 0.5f}));
}

TEST_F(TextureTest, LuminanceAndChromaBecomeRgb) {
    const float r = 0.5f, g = 0.25f, b = 1.0f, y = luminance(r, g, b);
    // EXR files order their channels by name.
    const fs::path exr = write(folder / "x.exr", {1, 1, {"BY", "RY", "Y"}}, {(b - y) / y, (r - y) / y, y});
    const Pixels pixels = pixels_of(exr);
    EXPECT_NEAR(pixels[0], r, 1e-6f);
    EXPECT_NEAR(pixels[1], g, 1e-6f);
    EXPECT_NEAR(pixels[2], b, 1e-6f);
}

TEST_F(TextureTest, DisplayWindowOfAnExr) {
    const fs::path file = folder / "window.exr";
    OIIO::ImageSpec spec(2, 1, 3, OIIO::TypeFloat);  // data at x = 1, 2; display from 0 to 1
    spec.x = 1;
    spec.full_x = 0;
    spec.full_width = 2;
    spec.full_height = 1;
    const auto out = OIIO::ImageOutput::create(file.string());
    const Pixels pixels{1, 1, 1, 5, 5, 5};
    ASSERT_TRUE(out->open(file.string(), spec) && out->write_image(OIIO::TypeFloat, pixels.data()) &&
                out->close());
    EXPECT_EQ(pixels_of(file), (Pixels{0, 0, 0, 0, 1, 1, 1, 1}));
}

TEST_F(TextureTest, FirstRowOfAPictureIsTheTop) {
    const fs::path exr = write(folder / "x.exr", {1, 2, rgb}, {1, 1, 1, 0.5f, 0.5f, 0.5f});
    const Texture texture = load_texture({exr}, {}, Wrap::clamp);
    EXPECT_EQ(sample(texture, {0.5f, 0.75f}).alpha, 1.0f);
    EXPECT_EQ(sample(texture, {0.5f, 0.25f}).alpha, 0.5f);
}

TEST_F(TextureTest, ThreePicturesAreRedGreenAndBlue) {
    std::vector<fs::path> files;
    for (const float value : {0.25f, 0.5f, 0.75f})
        files.push_back(write(folder / fmt::format("{}.exr", value), {2, 1, {"Y"}}, {value, value / 2}));
    TextureSettings settings;
    settings.alpha = Alpha::one;
    const Texture texture = load_texture(files, settings, Wrap::clamp);
    const Pixels pixels(texture.image.pixels.begin(), texture.image.pixels.end());
    EXPECT_EQ(pixels, (Pixels{0.25f, 0.5f, 0.75f, 1, 0.125f, 0.25f, 0.375f, 1}));
}

TEST_F(TextureTest, LinearImagesOfEncodedFilesAreLight) {
    const Pixels codes{188.0f / 255.0f, 0.0f, 1.0f};
    const Image light = load_linear_image(write(folder / "a.png", {1, 1, rgb, OIIO::TypeUInt8}, codes));
    EXPECT_NEAR(light.pixels[0], real::srgb_to_linear(188.0 / 255.0), 1e-6);
    EXPECT_EQ(light.pixels[1], 0.0f);
    EXPECT_EQ(light.pixels[2], 1.0f);
    EXPECT_EQ(light.pixels[3], 1.0f);
}

TEST_F(TextureTest, RawImagesKeepStoredValues) {
    const fs::path png =
        write(folder / "x.png", {1, 1, rgba, OIIO::TypeUInt8, true}, {1.0f, 51.0f / 255.0f, 0.0f, 0.2f});
    const Image raw = load_raw_image(png);
    EXPECT_EQ(raw.channels, 3);
    EXPECT_FLOAT_EQ(raw.pixels[1], 0.2f);
}

TEST(TextureErrors, OneLineEach) {
    const TempFolder folder;
    const auto error = [](const std::vector<fs::path>& files, const TextureSettings& settings = {}) {
        const std::string message = ERROR_OF(load_texture(files, settings, Wrap::clamp));
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        return message;
    };
    const fs::path a = write(folder / "a.exr", {1, 1, rgb}, {1, 1, 1});
    const fs::path b = write(folder / "b.exr", {2, 1, rgb}, {1, 1, 1, 1, 1, 1});
    const std::string cannot = ": cannot be read as a picture: ";
    EXPECT_EQ(error({folder / "no.png"}),
              (folder / "no.png").string() + ": cannot be read: No such file or directory");
    EXPECT_EQ(error({folder.path()}), folder.path().string() + ": cannot be read: it is a folder");
    EXPECT_EQ(error({folder.file("junk.png", "hello")}).rfind((folder / "junk.png").string() + cannot, 0),
              0u);
    EXPECT_EQ(error({folder.file("empty.exr", "")}).rfind((folder / "empty.exr").string() + cannot, 0), 0u);
    EXPECT_EQ(error({a, b}), "expected one texture, or three for red, green and blue, found 2");
    EXPECT_EQ(error({a, a, b}), b.string() + ": expected 1x1 px like " + a.string() + ", found 2x1 px");
    TextureSettings settings;
    settings.alpha = Alpha::file;
    EXPECT_EQ(error({a}, settings),
              a.string() + ": expected an alpha channel (alpha = \"file\"), found none");
}

fs::path write_fits(const fs::path& file, std::vector<long> axes, std::vector<float> values) {
    fitsfile* out = nullptr;
    int status = 0;
    fits_create_diskfile(&out, file.c_str(), &status);
    fits_create_img(out, FLOAT_IMG, int(axes.size()), axes.data(), &status);
    fits_write_img(out, TFLOAT, 1, static_cast<LONGLONG>(values.size()), values.data(), &status);
    fits_close_file(out, &status);
    EXPECT_EQ(status, 0);
    return file;
}

TEST(Fits, FirstRowOfTheFileIsTheBottomOne) {
    const TempFolder folder;
    const fs::path file = write_fits(folder / "a [1] (b).fits", {2, 2}, {1, 2, 3, 4});
    const FitsPlane plane = read_fits(file, "auto", 0);
    EXPECT_EQ(std::vector<double>(plane.values.begin(), plane.values.end()),
              (std::vector<double>{3, 4, 1, 2}));
    TextureSettings settings;
    settings.stretch = Stretch::linear;
    settings.black = 0.0;
    settings.white = 4.0;
    const Texture texture = load_texture({file}, settings, Wrap::clamp);
    EXPECT_EQ(sample(texture, {0.25f, 0.25f}).alpha, 0.25f);
    EXPECT_EQ(sample(texture, {0.75f, 0.75f}).alpha, 1.0f);
}

TEST(Fits, UndefinedPixelsAreEmptyAndCounted) {
    const TempFolder folder;
    const fs::path file = write_fits(folder / "x.fits", {2, 1}, {nan, 5});
    TextureSettings settings;
    settings.alpha = Alpha::one;
    settings.black = 0.0;
    settings.white = 5.0;
    EXPECT_EQ(pixels_of(file, settings), (Pixels{0, 0, 0, 0, 1, 1, 1, 1}));
    const std::vector<FitsHdu> hdus = describe_fits(file);
    EXPECT_EQ(hdus[0].nan_count, 1);
    EXPECT_EQ(hdus[0].range.min, 5.0);
}

TEST(Fits, AxesOfLengthOneDoNotMakeACube) {
    const TempFolder folder;
    const fs::path file = write_fits(folder / "x.fits", {1, 2, 3, 1}, {1, 2, 3, 4, 5, 6});
    const FitsPlane plane = read_fits(file, "auto", 0);
    EXPECT_EQ(plane.width, 2);
    EXPECT_EQ(plane.height, 3);
    const fs::path cube = write_fits(folder / "cube.fits", {1, 2, 2}, {1, 2, 3, 4});
    EXPECT_EQ(read_fits(cube, "auto", 0).width, 2);
}

TEST(Fits, Errors) {
    const TempFolder folder;
    const fs::path file = write_fits(folder / "x.fits", {2, 2}, {1, 2, 3, 4});
    const auto error = [&](const char* hdu, int plane) {
        const std::string message = ERROR_OF(read_fits(file, hdu, plane));
        return message.substr(std::min(message.size(), file.string().size()));
    };
    EXPECT_EQ(error("7", 0), ": expected an HDU from 0 to 0, found hdu = 7");
    EXPECT_EQ(error("SCI", 0), ": expected an HDU named 'SCI', found none in 1 HDUs");
    EXPECT_EQ(error("auto", 1), ":HDU 0: expected a plane from 0 to 0, found plane = 1");
    TextureSettings settings;
    settings.black = 2.0;
    settings.white = 1.0;
    EXPECT_EQ(
        ERROR_OF(pixels_of(file, settings)),
        file.string() + ": expected a black point below the white point, found black = 2 and white = 1");
    fs::resize_file(write_fits(folder / "cut.fits", {100, 100}, std::vector<float>(10000)), 2880 + 1000);
    const std::string cut = ERROR_OF(pixels_of(folder / "cut.fits"));
    EXPECT_EQ(cut.rfind((folder / "cut.fits").string() + ": FITS ", 0), 0u) << cut;
}

// libjpeg would show the rest in grey; cuts in the header, in the data and before the very end are all seen.
TEST(Picture, ACutJpegIsAnError) {
    const TempFolder folder;
    Pixels pixels;
    for (int i = 0; i < 64 * 48 * 3; ++i) pixels.push_back(float(i * 37 % 101) / 100.0f);
    const fs::path whole = write(folder / "whole.jpg", {64, 48, rgb, OIIO::TypeUInt8}, pixels);
    EXPECT_EQ(read_picture(whole).image.width, 64);
    const std::uintmax_t size = fs::file_size(whole);
    for (const std::uintmax_t kept : {size / 2, size - 100, size - 1}) {
        const fs::path cut = folder / "cut.jpg";
        fs::copy_file(whole, cut, fs::copy_options::overwrite_existing);
        fs::resize_file(cut, kept);
        EXPECT_EQ(ERROR_OF(read_picture(cut)),
                  cut.string() + ": cannot be read as a picture: the file ends before the picture does");
    }
}

TEST(Stretch, CurvesAtKnownPlaces) {
    const Limits limits{10.0, 20.0};
    EXPECT_EQ(StretchCurve(limits, Stretch::linear, 0.1)(15.0), 0.5);
    EXPECT_EQ(StretchCurve(limits, Stretch::linear, 0.1)(5.0), 0.0);
    EXPECT_EQ(StretchCurve(limits, Stretch::asinh, 0.1)(25.0), 1.0);
    EXPECT_NEAR(StretchCurve(limits, Stretch::asinh, 0.1)(15.0), std::asinh(5.0) / std::asinh(10.0), 1e-15);
    EXPECT_NEAR(StretchCurve(limits, Stretch::log, 0.1)(15.0), std::log(501.0) / std::log(1001.0), 1e-15);
    EXPECT_TRUE(std::isnan(StretchCurve(limits, Stretch::asinh, 0.1)(std::nan(""))));
}

TEST(Stretch, AsinhIsADisplayValueLinearIsLight) {
    const TempFolder folder;
    const fs::path file = write_fits(folder / "x.fits", {3, 1}, {0, 1, 2});
    TextureSettings settings;
    settings.alpha = Alpha::one;
    settings.black = 0.0;
    settings.white = 2.0;
    const auto display = float(real::asinh(5.0) / real::asinh(10.0));
    EXPECT_EQ(pixels_of(file, settings)[4], float(real::srgb_to_linear(display)));
    settings.stretch = Stretch::linear;
    EXPECT_EQ(pixels_of(file, settings)[4], 0.5f);
    settings.stretch = Stretch::asinh;
    settings.colorspace = Colorspace::linear;
    EXPECT_EQ(pixels_of(file, settings)[4], display);
}

TEST(Stretch, PercentilesInterpolateBetweenRanks) {
    std::vector<double> values;
    for (int i = 1000; i >= 0; --i) values.push_back(i);
    values.push_back(std::nan(""));
    values.push_back(infinity);
    const ValueRange range = value_range(values);
    EXPECT_EQ(range.min, 0.0);
    EXPECT_EQ(range.max, 1000.0);
    EXPECT_DOUBLE_EQ(range.black, 2.5);
    EXPECT_DOUBLE_EQ(range.white, 997.5);
    const std::vector<double> same(5, 3.0);
    const Limits limits = choose_limits(value_range(same), {}, "f");
    EXPECT_EQ(limits.white, 4.0);
}

}  // namespace
}  // namespace astrosplat
