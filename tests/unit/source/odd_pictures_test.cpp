// What a file says and few files do: values that are none, nothing to see, depths, masks in alpha, pixels
// that are not square, Radiance's exposure, meshes without a picture.
#include "support/test.h"
// its fmt first: OpenImageIO's copy would turn exceptions off
#include <OpenImageIO/imageio.h>

#include <fstream>

#include "core/color.h"
#include "core/memory.h"
#include "core/text.h"
#include "source/picture.h"
#include "source/prepared_picture.h"
#include "source/texture.h"
#include "source/tiled_sky.h"
#include "support/fits_text.h"
#include "support/quiet.h"

namespace astrosplat {
namespace {

constexpr float no_value = std::numeric_limits<float>::quiet_NaN(),
                overflowed = std::numeric_limits<float>::infinity();

// value(x, y, channel) of each pixel; `names` such as "RGB", one letter a channel.
template <class Value>
fs::path write_odd(const fs::path& file, int width, int height, const std::string& names, const Value& value,
                   OIIO::TypeDesc type = OIIO::TypeFloat, float aspect = 1.0f) {
    OIIO::ImageSpec spec(width, height, int(names.size()), type);
    spec.channelnames.clear();
    for (const char name : names) spec.channelnames.emplace_back(1, name);
    spec.alpha_channel = names.find('A') == std::string::npos ? -1 : int(names.find('A'));
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("PixelAspectRatio", aspect);
    std::vector<float> values;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < int(names.size()); ++c) values.push_back(float(value(x, y, c)));
    const auto out = OIIO::ImageOutput::create(file.string());
    EXPECT_TRUE(out && out->open(file.string(), spec) && out->write_image(OIIO::TypeFloat, values.data()) &&
                out->close());
    return file;
}

Texture odd_texture(const fs::path& file, const TextureSettings& settings = {}) {
    return load_texture({file}, settings, TextureSettings::Wrap::clamp);
}

class OddPictures : public testing::Test {
  protected:
    const TempFolder folder;
};

// ---- an environment shows everywhere

TEST_F(OddPictures, AnEnvironmentIsFilledWhereItHasNoValueAndNowhereInfinite) {
    const fs::path file = write_odd(folder / "sky.exr", 8, 4, "RGB", [](int x, int y, int c) {
        if (x == 2 && y == 1) return c == 1 ? no_value : 9.0f;
        return x == 6 && y == 3 ? overflowed : 0.5f;
    });
    std::vector<Image> pictures;
    const std::vector<std::string> warnings =
        warnings_of([&] { pictures = load_environment_pictures(file, 1); });
    const Image& sky = pictures.at(0);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(sky.at(3, 2)[c], 0.5f, 1e-4f);
        EXPECT_EQ(sky.at(7, 4)[c], 65504.0f);
        EXPECT_EQ(sky.at(1, 1)[c], 0.5f);
    }
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0], file.string() +
                               ": 1 pixel without a value (NaN) is filled from around, 1 infinite "
                               "pixel counts as 65504");
}

TEST_F(OddPictures, AnEnvironmentWithoutAnyValueIsBlack) {
    const fs::path file = write_odd(folder / "sky.exr", 8, 4, "RGB", [](int, int, int) { return no_value; });
    const Said said;
    const std::vector<Image> pictures = load_environment_pictures(file, 0);
    for (const float value : pictures.at(0).pixels) EXPECT_EQ(value, 0.0f);
    EXPECT_HAS(said.one_warning(), "32 pixels without a value");
}

TEST_F(OddPictures, ATiledSkyIsFilledToo) {
    const fs::path file = write_odd(folder / "tile.exr", 64, 64, "RGB", [](int x, int y, int) {
        return x < 3 && y < 3 ? no_value : x == 40 && y == 40 ? overflowed : 0.25f + 0.001f * float(x);
    });
    SkyTiling tiling;
    tiling.face_px = 16;
    const Said said;
    for (const Image& face : tiled_sky_of(file, tiling))
        for (const float value : face.pixels) ASSERT_TRUE(std::isfinite(value));
    EXPECT_HAS(said.one_warning(), "9 pixels without a value (NaN) are filled from around, 1 infinite");
}

// ---- nothing to see

TEST_F(OddPictures, NothingToSeeIsSaid) {
    const fs::path none = folder.file("none.fits", fits_file(8, 8, "", [](int, int) { return no_value; })),
                   even = folder.file("even.fits", fits_file(8, 8, "", [](int, int) { return 7.0f; })),
                   clear = write_odd(folder / "clear.exr", 4, 4, "RGBA", [](int, int, int) { return 0.0f; }),
                   black = write_odd(folder / "black.png", 4, 4, "RGB", [](int, int, int) { return 0.0f; }),
                   white = write_odd(folder / "white.png", 4, 4, "RGB", [](int, int, int) { return 1.0f; });
    const auto said_of = [](const fs::path& file) {
        const Said said;
        odd_texture(file);
        return said.one_warning();
    };
    EXPECT_EQ(said_of(none), none.string() + ": nothing to see: every pixel is undefined (NaN)");
    EXPECT_EQ(said_of(even), even.string() + ": nothing to see: all pixels are equal, black or transparent");
    EXPECT_EQ(said_of(black),
              black.string() + ": nothing to see: all pixels are equal, black or transparent");
    EXPECT_EQ(said_of(clear),
              clear.string() + ": nothing to see: all pixels are equal, black or transparent");
    EXPECT_EQ(said_of(white), "0 warnings") << "a colour is something";
    TextureSettings filled;
    filled.prepare.fill = white;
    const fs::path light =
        write_odd(folder / "light.exr", 4, 4, "RGB", [](int x, int, int) { return float(x); });
    const Said said;
    prepare_picture({light}, filled);
    EXPECT_EQ(said.one_warning(),
              light.string() + ": nothing to see: all pixels are equal, black or transparent");
}

TEST_F(OddPictures, LightThatNoScreenShowsIsSaid) {
    const auto said_of = [&](float light) {
        const Said said;
        odd_texture(write_odd(folder / "a.tif", 4, 4, "RGB", [=](int, int, int) { return light; }));
        return said.one_warning();
    };
    EXPECT_EQ(said_of(5e-5f),
              (folder / "a.tif").string() + ": nothing to see: no light is more than 5e-05 of white");
    EXPECT_EQ(said_of(2e-4f), "0 warnings");
}

TEST_F(OddPictures, APictureIsNotItsOwnStars) {
    TextureSettings settings;
    settings.prepare.starless = write_odd(folder / "a.exr", 4, 4, "RGB", [](int x, int, int) { return x; });
    EXPECT_EQ(
        ERROR_OF(prepare_picture({folder / "." / "a.exr"}, settings)),
        (folder / "a.exr").string() + ": expected another picture than the one of the stars, found the same");
}

// ---- channels

TEST_F(OddPictures, ChannelsThatAreNotTakenAreSaid) {
    const auto said_of = [&](const char* name, const std::string& names) {
        const Said said;
        read_picture(write_odd(folder / name, 4, 4, names, [](int x, int, int c) { return x + c; }));
        return said.one_warning();
    };
    EXPECT_EQ(said_of("a.exr", "RGBNM"),
              (folder / "a.exr").string() + ": 2 channels more than R, G, B are not followed");
    EXPECT_EQ(said_of("b.exr", "RG"),
              (folder / "b.exr").string() + ": 1 channel more than R is not followed");
    EXPECT_HAS(said_of("c.tif", "RGBNM"), "2 channels more than R, G, B are not followed");
    EXPECT_EQ(said_of("d.exr", "RGBA"), "0 warnings");
}

TEST_F(OddPictures, XyzIsFollowed) {
    constexpr float white[] = {0.9505f, 1.0f, 1.089f};  // of D65: IEC 61966-2-1
    const Said said;
    const Image light = load_linear_image(write_odd(
        folder / "a.exr", 2, 2, "XYZ", [&](int x, int, int c) { return x == 0 ? white[c] : 0.0f; }));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(light.at(0, 0)[c], 1.0f, 1e-3f);
    EXPECT_EQ(said.lines.size(), 0u);
}

TEST_F(OddPictures, WindowsThatDoNotMeetAreSaid) {
    OIIO::ImageSpec spec(2, 2, 3, OIIO::TypeFloat);
    spec.x = spec.y = 100;
    spec.full_width = spec.full_height = 8;
    const fs::path file = folder / "a.exr";
    const std::vector<float> values(12, 0.5f);
    const auto out = OIIO::ImageOutput::create(file.string());
    ASSERT_TRUE(out->open(file.string(), spec) && out->write_image(OIIO::TypeFloat, values.data()) &&
                out->close());
    const Said said;
    EXPECT_EQ(read_picture(file).image.at(0, 0)[0], 0.5f);
    EXPECT_HAS(said.one_warning(), "its display window, which has none of its pixels, is not followed");
}

// ---- depths

// Of a sheet of 64 x 64 places whose map is depth(x), at the places x of the map's pixels.
template <class Depth>
std::vector<float> heights_of(const TempFolder& folder, const std::string& channels, const Depth& depth,
                              std::vector<std::string>* lines = nullptr) {
    ShapeParams shape;
    shape.depth_map = write_odd(folder / "depth.exr", 64, 64, channels, [&](int x, int, int c) {
        return c + 1 < int(channels.size()) ? 3 : depth(x);
    });
    shape.depth = 0.2;
    shape.blur = 0.0;
    Texture texture;
    texture.image = make_image(8, 8, 4, 1.0f);
    const Said said;
    const Mesh sheet = sheet_mesh(texture, shape);
    if (lines) *lines = said.lines;
    std::vector<float> heights(64);
    for (const glm::vec3& p : sheet.positions)
        heights[std::size_t(std::clamp((double(p.x) + 5.0) * 6.4, 0.0, 63.0))] = p.y;
    return heights;
}

TEST_F(OddPictures, WhatIsFarBeyondAllDepthsIsSky) {
    const auto with_sky = [&](float sky) {
        std::vector<std::string> lines;
        const std::vector<float> heights = heights_of(
            folder, "Z", [&](int x) { return x >= 48 ? sky : 1.0f + 0.1f * float(x); }, &lines);
        EXPECT_NEAR(heights[0], 1.0f, 0.05f) << sky << ": the nearest";
        EXPECT_NEAR(heights[24], 0.0f, 0.05f) << sky;
        EXPECT_NEAR(heights[60], -1.0f, 1e-3f) << sky << ": the sky is as far as the farthest";
        EXPECT_EQ(lines, (std::vector<std::string>{(folder / "depth.exr").string() +
                                                   ": distances from 1 to 5.7; 1024 pixels are sky"}));
    };
    for (const float sky : {1e10f, 65504.0f, overflowed, no_value}) with_sky(sky);
}

TEST_F(OddPictures, OfDepthsWithColoursZIsTaken) {
    const std::vector<float> near_left =
        heights_of(folder, "RGBAZ", [](int x) { return 1.0f + 0.1f * float(x); });
    EXPECT_NEAR(near_left[0], 1.0f, 0.05f);
    EXPECT_NEAR(near_left[63], -1.0f, 0.05f);
    const std::vector<float> white_right = heights_of(folder, "Y", [](int x) { return 0.1f * float(x); });
    EXPECT_NEAR(white_right[0], -1.0f, 0.05f) << "of greys, black is the farthest";
}

TEST_F(OddPictures, DepthsHaveSeveralNames) {
    for (const char* const name : {"depth", "ViewLayer.Depth.V", "ViewLayer.Depth.Z"}) {
        OIIO::ImageSpec spec(2, 1, 4, OIIO::TypeFloat);
        spec.channelnames = {"R", "G", "B", name};
        const std::vector<float> values{1, 2, 3, 40, 5, 6, 7, 80};
        const fs::path file = folder / "z.exr";
        const auto out = OIIO::ImageOutput::create(file.string());
        EXPECT_TRUE(out->open(file.string(), spec) && out->write_image(OIIO::TypeFloat, values.data()) &&
                    out->close());
        const Picture depths = read_picture(file, {}, "auto", Wanted::depths);
        EXPECT_TRUE(depths.distances) << name;
        EXPECT_EQ(depths.image.at(1, 0)[0], 80.0f) << name;
    }
}

TEST_F(OddPictures, DepthsThatAreAllSkyAreFlat) {
    std::vector<std::string> lines;
    for (const float height : heights_of(
             folder, "Z", [](int) { return no_value; }, &lines))
        EXPECT_EQ(height, 0.0f);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_HAS(lines[0], "no depths: every pixel is undefined or sky");
}

// ---- masks, half floats, shapes of pixels

TEST_F(OddPictures, AMaskPaintedInAlphaIsThatAlpha) {
    const auto mask = [&](float color) {
        return write_odd(
            folder / "m.png", 4, 1, "RGBA",
            [&](int x, int, int c) { return c == 3 ? float(x) / 3.0f : color; }, OIIO::TypeUInt8);
    };
    const Image like = make_image(4, 1, 3), light = make_image(4, 1, 4, 1.0f);
    for (const float color : {0.0f, 1.0f}) {
        const fs::path file = mask(color);
        const Image read = read_mask_like(like, "--mask", file);
        EXPECT_NEAR(read.at(0, 0)[0], 0.0f, 1e-6f);
        EXPECT_NEAR(read.at(1, 0)[1], 1.0f / 3.0f, 1e-6f);
        EXPECT_EQ(bright_pixels(read).pixels[0], 0);
        EXPECT_EQ(bright_pixels(read).pixels[3], 1);
        MaskParams params;
        params.image = file;
        EXPECT_NEAR(*mask_weights(light, std::span(&params, 1)).at(1, 0), 1.0f / 3.0f, 1e-6f);
    }
    const fs::path painted = write_odd(
        folder / "p.png", 4, 1, "RGBA", [](int x, int, int c) { return c == 3 ? 0.5f : float(x) / 3.0f; },
        OIIO::TypeUInt8);
    EXPECT_NEAR(read_mask_like(like, "--mask", painted).at(1, 0)[0], 1.0f / 3.0f, 1e-6f);
}

TEST_F(OddPictures, AMaskHasNoValueThatIsNone) {
    const fs::path file = write_odd(folder / "m.exr", 2, 1, "RGB",
                                    [](int x, int, int) { return x == 0 ? no_value : overflowed; });
    const Image mask = load_raw_image(file);
    EXPECT_EQ(mask.at(0, 0)[0], 0.0f);
    EXPECT_EQ(mask.at(1, 0)[0], 65504.0f);
}

TEST_F(OddPictures, PreparationKeepsWhatOverflowedAHalf) {
    const fs::path file = write_odd(
        folder / "h.exr", 8, 8, "RGB", [](int x, int y, int) { return x == 4 && y == 4 ? 1e6f : 0.25f; },
        OIIO::TypeHalf);
    const PreparedPicture prepared = prepare_picture({file}, {});
    EXPECT_EQ(prepared.image.at(4, 4)[0], 65504.0f);
    EXPECT_EQ(prepared.image.at(4, 4)[3], 1.0f);
}

TEST_F(OddPictures, PixelsThatAreNotSquareAreMadeSo) {
    const auto ramp = [](int x, int y, int c) { return c == 0 ? float(x) : float(y); };
    const fs::path wide = write_odd(folder / "w.exr", 8, 4, "RGB", ramp, OIIO::TypeFloat, 2.0f),
                   high = write_odd(folder / "h.exr", 8, 4, "RGB", ramp, OIIO::TypeFloat, 0.5f),
                   odd = write_odd(folder / "o.exr", 8, 4, "RGB", ramp, OIIO::TypeFloat, 40.0f);
    {
        const Said said;
        const Image image = read_picture(wide).image;
        ASSERT_EQ(image.width, 16);
        ASSERT_EQ(image.height, 4);
        EXPECT_FLOAT_EQ(image.at(5, 2)[0], 2.25f) << "between the second and the third";
        EXPECT_FLOAT_EQ(image.at(15, 2)[0], 7.0f);
        EXPECT_EQ(image.at(5, 2)[1], 2.0f);
        EXPECT_EQ(said.text(),
                  wide.string() + ": read as 16x4 px, as its pixels are 2 times as wide as high\n");
    }
    const Said said;
    EXPECT_EQ(read_picture(high).image.height, 8);
    EXPECT_EQ(read_picture(odd).image.width, 8);
    EXPECT_HAS(said.one_warning(), "PixelAspectRatio 40 is not followed");
}

TEST_F(OddPictures, RadianceIsDividedByItsExposure) {
    const auto radiance = [&](const std::string& lines) {
        std::string text = "#?RADIANCE\n" + lines + "FORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n";
        text += std::string("\x80\x40\x20\x81", 4);  // 1, 0.5, 0.25 (+ half a step)
        const Image image = read_picture(folder.file("a.hdr", text)).image;
        return glm::vec3(image.at(0, 0)[0], image.at(0, 0)[1], image.at(0, 0)[2]);
    };
    const glm::vec3 plain = radiance("");
    EXPECT_NEAR(plain.x, 1.0f, 0.01f);
    EXPECT_EQ(radiance("EXPOSURE=2\nEXPOSURE= 4.0\n"), plain / 8.0f);
    EXPECT_EQ(radiance("EXPOSURE=0.5\nCOLORCORR= 1 2 4\n"), plain * 2.0f / glm::vec3(1.0f, 2.0f, 4.0f));
    const Said said;
    EXPECT_EQ(radiance("EXPOSURE=0\n"), plain);
    EXPECT_HAS(said.one_warning(), "its EXPOSURE=0 is not followed");
}

TEST_F(OddPictures, ATiffThatDoesNotSayItsBitsIsRefused) {
    std::string tiff("II*\0\x0a\0\0\0\xaa\x55", 10);  // two rows of eight pixels
    const std::vector<std::pair<int, int>> tags = {{256, 8}, {257, 2}, {259, 1}, {262, 1},
                                                   {273, 8}, {278, 2}, {279, 2}};
    tiff += std::string("\x07\0", 2);
    for (const auto& [tag, value] : tags)
        tiff += std::string{char(tag & 255), char(tag >> 8), 3, 0, 1, 0, 0, 0, char(value), 0, 0, 0};
    tiff += std::string(4, '\0');
    const fs::path file = folder.file("one.tif", tiff);
    EXPECT_EQ(ERROR_OF(read_picture(file)),
              file.string() +
                  ": cannot be read as a picture: it does not say how many bits a value has "
                  "(BitsPerSample); save it with 8");
}

// A tag's entry in a directory: type 2 of bytes, 3 of 16 bits, 5 of fractions.
struct TiffTag {
    int tag, type, count;
    std::string data;
};

// 8x4 px of one channel in one strip behind the directory, and the data of `more` behind it; little-endian.
std::string grey_tiff(int bits, int photometric, int sample_format, const std::vector<TiffTag>& more = {}) {
    const int bytes = 8 * 4 * bits / 8, data_at = 8 + 2 + (10 + int(more.size())) * 12 + 4;
    std::vector<TiffTag> tags = more;
    for (const auto& [tag, value] : std::initializer_list<std::pair<int, int>>{{256, 8},
                                                                               {257, 4},
                                                                               {258, bits},
                                                                               {259, 1},
                                                                               {262, photometric},
                                                                               {273, data_at},
                                                                               {277, 1},
                                                                               {278, 4},
                                                                               {279, bytes},
                                                                               {339, sample_format}})
        tags.push_back({tag, 3, 1, std::string{char(value & 255), char(value >> 8), 0, 0}});
    std::ranges::sort(tags, {}, &TiffTag::tag);
    std::string tiff("II*\0\x08\0\0\0", 8), behind;
    const auto add = [&](int value, int size) {
        for (int i = 0; i < size; ++i) tiff += char(value >> 8 * i & 255);
    };
    add(int(tags.size()), 2);
    for (const TiffTag& tag : tags) {
        add(tag.tag, 2);
        add(tag.type, 2);
        add(tag.count, 4);
        if (tag.data.size() == 4) {
            tiff += tag.data;
        } else {
            add(data_at + bytes + int(behind.size()), 4);
            behind += tag.data;
        }
    }
    add(0, 4);
    for (int i = 0; i < bytes; ++i) tiff += char(i);
    return tiff + behind;
}

// OpenImageIO says nothing, and has black rows.
TEST_F(OddPictures, ATiffThatEndsEarlyIsRefused) {
    const std::string whole = grey_tiff(8, 1, 1);
    EXPECT_NEAR(read_picture(folder.file("a.tif", whole)).image.at(1, 0)[0], 1.0f / 255.0f, 1e-6f);
    const fs::path cut = folder.file("cut.tif", whole.substr(0, whole.size() - 1));
    EXPECT_EQ(ERROR_OF(read_picture(cut)),
              cut.string() + ": cannot be read as a picture: the file ends before the picture does");
}

TEST_F(OddPictures, ValuesOfATiffThatAreNotFollowedAreSaid) {
    const auto said_of = [&](int bits, int photometric, int sample_format) {
        const Said said;
        read_picture(folder.file("a.tif", grey_tiff(bits, photometric, sample_format)));
        return said.warnings.empty() ? "" : said.warnings[0];
    };
    EXPECT_EQ(said_of(8, 1, 1), "");
    EXPECT_EQ(said_of(16, 1, 1), "");
    EXPECT_EQ(said_of(8, 0, 1), "") << "which is";
    EXPECT_EQ(read_picture(folder / "a.tif").image.at(0, 0)[0], 1.0f);
    EXPECT_HAS(said_of(16, 0, 1), "that 0 is white (PhotometricInterpretation) is not followed");
    EXPECT_HAS(said_of(16, 1, 2), "its whole numbers have a sign: those below 0 are black");
    EXPECT_HAS(said_of(16, 32803, 1), "that its values are a camera's (PhotometricInterpretation) is not");
}

// TIFF 6.0, section 20: a curve of 256 steps; GDAL's value for none, in floats.
TEST_F(OddPictures, TagsOfATiffAreFollowed) {
    std::string line, primaries;
    for (int i = 0; i < 256; ++i) line += std::string{char(i), char(i)};
    const Image even = load_linear_image(folder.file("t.tif", grey_tiff(8, 1, 1, {{301, 3, 256, line}})));
    EXPECT_NEAR(even.at(7, 3)[0], 31.0f / 255.0f, 1e-5f) << "by sRGB 0.0137";
    for (const int tenths : {7, 3, 2, 8, 1, 1}) primaries += std::string{char(tenths), 0, 0, 0, 10, 0, 0, 0};
    const Picture wide = read_picture(folder.file("p.tif", grey_tiff(8, 1, 1, {{319, 5, 6, primaries}})));
    ASSERT_TRUE(wide.colors);
    const glm::dmat3 wanted = primaries_matrix(
        {{0.7, 0.3}, {0.2, 0.8}, {0.1, 0.1}, rec709_chromaticities.white}, rec709_chromaticities);
    EXPECT_NEAR(wide.colors->to_rec709[0][0], wanted[0][0], 1e-5);
    const std::vector<TiffTag> none{{42113, 2, 15, std::string("3.82047143e-37\0", 15)}};
    const Image gap = read_picture(folder.file("n.tif", grey_tiff(32, 1, 3, none))).image;
    EXPECT_TRUE(std::isnan(gap.at(0, 0)[0])) << "bytes 0 1 2 3";
    EXPECT_FALSE(std::isnan(gap.at(1, 0)[0]));
    const Said said;
    read_picture(folder.file("n.tif", grey_tiff(8, 1, 1, {{42113, 2, 2, std::string("0\0\0\0", 4)}})));
    EXPECT_HAS(said.one_warning(), "n.tif: its GDAL_NODATA 0 is not followed");
}

// The fourth byte of BMP is alpha where a mask says so, and its colours are not multiplied by it.
TEST_F(OddPictures, AlphaOfBmp) {
    const auto bmp = [&](bool masks) {
        std::string text = "BM";
        const auto add = [&](std::uint32_t value, int size = 4) {
            for (int i = 0; i < size; ++i) text += char(value >> 8 * i);
        };
        const std::uint32_t header = masks ? 108 : 40;
        for (const std::uint32_t value : {14 + header + 8, 0u, 14 + header, header, 2u, 1u}) add(value);
        add(1, 2);
        add(32, 2);
        for (const std::uint32_t value : {masks ? 3u : 0u, 8u, 0u, 0u, 0u, 0u}) add(value);
        if (masks)
            for (const std::uint32_t value : {0xff0000u, 0xff00u, 0xffu, 0xff000000u}) add(value);
        text.resize(14 + header, '\0');
        add(0x40302010);
        add(0x80706050);
        return read_picture(folder.file("a.bmp", text));
    };
    const Picture plain = bmp(false), masked = bmp(true);
    EXPECT_EQ(plain.image.channels, 3) << "else it is thin, and often empty";
    EXPECT_EQ(masked.image.channels, 4);
    EXPECT_FALSE(masked.associated);
    for (const Picture* picture : {&plain, &masked})
        EXPECT_NEAR(picture->image.at(0, 0)[0], 48.0f / 255.0f, 1e-6f);
}

TEST_F(OddPictures, WholeNumbersOfAnExrAreLight) {
    OIIO::ImageSpec spec(2, 1, 3, OIIO::TypeUInt);
    const std::vector<std::uint32_t> values = {0, 1, 2, 1000, 70000, 5};
    const fs::path file = folder / "counts.exr";
    const auto out = OIIO::ImageOutput::create(file.string());
    ASSERT_TRUE(out->open(file.string(), spec) && out->write_image(OIIO::TypeUInt, values.data()) &&
                out->close());
    const Image light = load_linear_image(file);
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_FLOAT_EQ(light.pixels[i / 3 * 4 + i % 3], float(values[i])) << i;
}

// ---- formats that OpenImageIO reads in its own way

// Rows go up: the lower one is the file's first. A negative scale means that the lowest byte comes first.
TEST_F(OddPictures, PfmIsReadFromItsLowestRow) {
    const float values[] = {0.25f, 0.5f, 1.5f, 2.0f};
    std::string little(reinterpret_cast<const char*>(values), sizeof values), big;
    for (std::size_t i = 0; i < 16; ++i) big += little[4 * (i / 4) + 3 - i % 4];
    for (const std::string& bytes : {"Pf\n2 2\n-1\n" + little, "Pf\n2 2\n1\n" + big}) {
        const Picture picture = read_picture(folder.file("a.pfm", bytes));
        EXPECT_EQ(picture.image.at(0, 0)[0], 1.5f);
        EXPECT_EQ(picture.image.at(1, 0)[0], 2.0f);
        EXPECT_EQ(picture.image.at(0, 1)[0], 0.25f);
    }
}

TEST_F(OddPictures, OnesOfAPbmAreBlack) {
    for (const std::string bytes : {"P1\n2 1\n1 0\n", "P4\n2 1\n\x80"}) {
        const Picture picture = read_picture(folder.file("a.pbm", bytes));
        EXPECT_EQ(picture.image.at(0, 0)[0], 0.0f);
        EXPECT_EQ(picture.image.at(1, 0)[0], 1.0f);
    }
    const fs::path tight = folder.file("tight.pbm", "P1\n2 1\n10\n");
    EXPECT_EQ(ERROR_OF(read_picture(tight)), tight.string() +
                                                 ": cannot be read as a picture: its pixels end early, "
                                                 "or are not as its header has them");
}

TEST_F(OddPictures, ALargestValueThatIsScaledWronglyIsRefused) {
    const Picture picture = read_picture(folder.file("a.pgm", std::string("P5\n1 1\n4095\n\x08\x00", 15)));
    EXPECT_NEAR(picture.image.at(0, 0)[0], 2048.0 / 4095.0, 1e-5);
    const fs::path file = folder.file("b.pgm", "P5\n1 1\n40000\n\x9c\x40");
    EXPECT_EQ(ERROR_OF(read_picture(file)),
              file.string() +
                  ": cannot be read as a picture: its largest value is 40000; save it with at most 32768, or "
                  "with 65535");
}

TEST_F(OddPictures, NetpbmHasItsOwnLargestValue) {
    for (const int largest : {31, 100, 254, 1000}) {
        std::string bytes = fmt::format("P5\n# a comment\n{} 1\n{}\n", largest + 1, largest);
        for (int i = 0; i <= largest; ++i)
            bytes += largest < 256 ? std::string(1, char(i)) : std::string{char(i >> 8), char(i & 255)};
        const Image light = load_linear_image(folder.file("a.pgm", bytes));
        for (int i = 0; i <= largest; ++i)
            ASSERT_NEAR(light.at(i, 0)[1], real::srgb_to_linear(double(i) / largest), 1e-6) << largest;
    }
    for (const char* largest : {"0", "70000"})
        EXPECT_HAS(
            ERROR_OF(read_picture(folder.file("b.pgm", std::string("P5\n1 1\n") + largest + "\nxxxx"))),
            std::string("its largest value is ") + largest);
}

// 32 x 24 px by Pillow, with the orientation 6 in its EXIF.
TEST_F(OddPictures, WebpIsTurnedAsItsExifSays) {
    const std::string bytes = *bytes_of_base64(
        "UklGRuIAAABXRUJQVlA4WAoAAAAIAAAAHwAAFwAAVlA4TKEAAAAvH8AFAE0ARNL+3jNE9D91ARCE/28PlRjw/ofAYN"
        "y2bSC94/0XbnuRbwMhQQppKiAokQTatm0zyGOhQrkCMe6zn5cIE5OgcLSJjhRGm2hQGDHRkcLRJhqUM2ISGWcEbhDu"
        "PGyz84zAQtFF4Iaii8CiostG22Xp2nZZurZdiq7WpenadeHYzy676tB0kZ+Ejaar3G1991/qu48+9Hc/KNqFAQBFWE"
        "lGGgAAAE1NACoAAAAIAAEBEgADAAAAAQAGAAAAAAAA");
    EXPECT_EQ(read_picture(folder.file("a.webp", bytes)).image.width, 24);
}

// Of a few bytes; OpenImageIO says so at the first rows, before which nothing as large as it is made.
TEST_F(OddPictures, ALargePictureOfNothingIsRefusedAtOnce) {
    std::string png = test::bytes_of(write_odd(
        folder / "a.png", 16384, 1, "RGB", [](int, int, int) { return 0.0f; }, OIIO::TypeUInt8));
    png.replace(20, 4, std::string("\0\0\x40\0", 4));
    png.replace(29, 4, "\x26\xaa\x87\xd3");
    const fs::path file = folder.file("a.png", png);
    std::ofstream("/proc/self/clear_refs") << "5";  // forgets the peak of the tests before
    const std::int64_t before = peak_memory_bytes();
    EXPECT_HAS(ERROR_OF(read_picture(file)), "cannot be read as a picture");
    EXPECT_LT(peak_memory_bytes() - before, std::int64_t{300} << 20);  // its pixels are 3 GiB
}

// 40 x 24 px of OpenJPEG by Pillow: 5 columns of alpha 0, 5 of 128, the upper left of (220, 40, 20).
TEST_F(OddPictures, AlphaOfJpeg2000IsNotMultipliedIntoItsColours) {
    const std::string bytes = *bytes_of_base64(
        "AAAADGpQICANCocKAAAAFGZ0eXBqcDIgAAAAAGpwMiAAAAAtanAyaAAAABZpaGRyAAAAGAAAACgABAcHAAAAAAAPY2"
        "9scgEAAAAAABAAAAKWanAyY/9P/1EAMgAAAAAAKAAAABgAAAAAAAAAAAAAACgAAAAYAAAAAAAAAAAABAcBAQcBAQcB"
        "AQcBAf9SAAwAAAABAAQEBAAB/1wAEEBASEhQSEhQSEhQSEhQ/2QAJQABQ3JlYXRlZCBieSBPcGVuSlBFRyB2ZXJzaW"
        "9uIDIuNS4w/5AACgAAAAACDwAB/5P/GEgSlfMnEcBILZ/fgEAS3Uv1e9JOl9+AOAaGaO0AqS/fgDgIEFoHXcHhz8Aa"
        "fgCx+AIADkCpwhRfDcLLlH8MTfN/x9oLB84OA+QEDQlKR6kOIN8L/cHzhI+0EgHwhA+s0G8I1GVvDC/B84UAAjhIAx"
        "/H2hUfaHQfUDgYiI7s8v93anDZGRQ3auzgm9R1Kq0XiL8YWkGAa0yAx9oTA+QNAPhEGdVL/GWfOHC/Ho6VIb6/GFTg"
        "f8D5A0faFwB0MBWXLMLT5x6uQjOTHYA/yskHGDt/x9oQAA8lmZz3Qmrfz8A+fgJR+AQAKMIl/TQMndTxRI6D2QiAKL"
        "/AngquPr/DWmfrDgYRkz+iKMNuc7Tn4L/H2hsHzioD5Aomj6bwcEh3/sc1IoF/LSPnErsavg2SjyjEjfpvwfOKj7Q6"
        "AfCGcWK9RMIKgpL/fwcYT4gmKaOx8yBAqDgvKMNGx9oaABfYg4zTA6kQsbKvVCXH2h0faIw+0EBA4Iuf5G9YWxQ3Jt"
        "jIj3gPDFa+yYlFJNpVqs0iqlqSiPYBGMfaGQfOKgPkCEA0xSJH3GSoi6Vjk4nWgywtYl9bvVaI9mN/wPkEx9opAHRA"
        "QDTFIkfctFxfd2MRukOjCJ86v+c7QzQ0Yt2lYeeI9f9/x9oyABz5xuEuemru3tsFAWCObc7sZ6jfOKiLvm//2Q==");
    const fs::path file = folder.file("a.jp2", bytes);
    const Picture picture = read_picture(file);
    EXPECT_FALSE(picture.associated);
    const float* const pixel = picture.image.at(7, 3);
    EXPECT_NEAR(pixel[0], 220.0 / 255.0, 1e-6);
    EXPECT_NEAR(pixel[3], 128.0 / 255.0, 1e-6);
    // Decoded where it is opened: a size of 31 bits is refused before.
    std::string large = bytes;
    const std::size_t size = large.find("\xff\x4f\xff\x51") + 8;
    for (const std::size_t side : {0, 4, 16, 20}) large.replace(size + side, 4, "\x7f\xff\xff\xff");
    EXPECT_NE(ERROR_OF(require_picture(folder.file("b.jp2", large))).find(" of memory, but only "),
              std::string::npos);
}

TEST_F(OddPictures, JpegXlSaysWhatReadsIt) {
    const fs::path file = folder.file("a.jxl", "\xff\x0a\x05\x08\x08");
    if (OIIO::ImageInput::create("jpegxl")) GTEST_SKIP() << "this OpenImageIO reads JPEG XL";
    EXPECT_EQ(ERROR_OF(require_picture(file)),
              file.string() +
                  ": cannot be read as a picture: this OpenImageIO reads no JPEG XL; djxl "
                  "FILE.jxl FILE.png, of the package libjxl-tools, makes a PNG of it");
}

}  // namespace
}  // namespace astrosplat
