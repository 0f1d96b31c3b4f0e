// XISF as PixInsight writes it, in all the ways in which it stores values.
#include "source/xisf.h"

#include <lcms2.h>
#include <lz4.h>
#include <zlib.h>
#include <zstd.h>

#include "core/text.h"
#include "source/object_metadata.h"
#include "source/picture.h"
#include "source/prepared_picture.h"
#include "source/stored_picture.h"
#include "support/quiet.h"
#include "support/test.h"

namespace astrosplat {
namespace {

constexpr int xisf_columns = 6, xisf_rows = 4;

/// Value of a pixel's channel, y from the top.
double value_of(int x, int y, int c) { return 1.0 + x + 10.0 * y + 50.0 * c; }

template <class T>
std::string values_of_type(int channels, bool by_pixel = false, bool big_endian = false) {
    std::string bytes;
    for (int i = 0; i < xisf_columns * xisf_rows * channels; ++i) {
        const int pixel = by_pixel ? i / channels : i % (xisf_columns * xisf_rows),
                  c = by_pixel ? i % channels : i / (xisf_columns * xisf_rows);
        const T value = T(value_of(pixel % xisf_columns, pixel / xisf_columns, c));
        std::string own(reinterpret_cast<const char*>(&value), sizeof value);
        if (big_endian) std::ranges::reverse(own);
        bytes += own;
    }
    return bytes;
}

std::string zlib_packed(const std::string& bytes) {
    uLongf size = compressBound(bytes.size());
    std::string packed(size, '\0');
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
             bytes.size());
    packed.resize(size);
    return packed;
}

std::string lz4_packed(const std::string& bytes) {
    std::string packed(std::size_t(LZ4_compressBound(int(bytes.size()))), '\0');
    packed.resize(std::size_t(
        LZ4_compress_default(bytes.data(), packed.data(), int(bytes.size()), int(packed.size()))));
    return packed;
}

std::string zstd_packed(const std::string& bytes) {
    std::string packed(ZSTD_compressBound(bytes.size()), '\0');
    packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 3));
    return packed;
}

/// First all first bytes of items of that size, then all second ones.
std::string shuffled(const std::string& bytes, std::size_t item) {
    std::string result;
    for (std::size_t b = 0; b < item; ++b)
        for (std::size_t at = b; at < bytes.size(); at += item) result += bytes[at];
    return result;
}

std::string xisf_file(const std::string& attributes, const std::string& block,
                      const std::string& children = "", const std::string& more = "") {
    constexpr std::size_t data_at = 4096;
    const std::string header = fmt::format(
        R"(<?xml version="1.0" encoding="UTF-8"?><xisf version="1.0" xmlns="http://www.pixinsight.com/xisf"><Image {} location="attachment:{}:{}">{}</Image>{}</xisf>)",
        attributes, data_at, block.size(), children, more);
    std::string file = "XISF0100";
    for (int shift = 0; shift < 32; shift += 8) file += char(header.size() >> shift & 255U);
    file += std::string(4, '\0') + header;
    file.resize(data_at, '\0');
    return file + block;
}

std::string geometry(int channels) {
    return fmt::format(R"(geometry="{}:{}:{}" colorSpace="{}" )", xisf_columns, xisf_rows, channels,
                       channels == 3 ? "RGB" : "Gray");
}

class XisfTest : public testing::Test {
  protected:
    const TempFolder folder;

    FitsPlane read(const std::string& bytes, std::optional<int> plane = {}, const std::string& hdu = "auto") {
        return read_fits(folder.file("a.xisf", bytes), hdu, plane);
    }
    void expect_colors(const std::string& bytes, const std::string& what) {
        const FitsPlane plane = read(bytes);
        ASSERT_EQ(plane.channels, 3) << what;
        for (int y = 0; y < xisf_rows; ++y)
            for (int x = 0; x < xisf_columns; ++x)
                for (int c = 0; c < 3; ++c)
                    ASSERT_EQ(plane.values[3 * (y * xisf_columns + x) + c], value_of(x, y, c)) << what;
    }
};

TEST_F(XisfTest, ValuesOfEveryTypeAndStorage) {
    const std::string rgb = geometry(3);
    expect_colors(xisf_file(rgb + R"(sampleFormat="UInt8")", values_of_type<std::uint8_t>(3)), "u8");
    expect_colors(xisf_file(rgb + R"(sampleFormat="UInt16")", values_of_type<std::uint16_t>(3)), "u16");
    expect_colors(xisf_file(rgb + R"(sampleFormat="UInt32")", values_of_type<std::uint32_t>(3)), "u32");
    expect_colors(xisf_file(rgb + R"(sampleFormat="UInt64")", values_of_type<std::uint64_t>(3)), "u64");
    expect_colors(xisf_file(rgb + R"(sampleFormat="Float32" bounds="0:1")", values_of_type<float>(3)), "f32");
    expect_colors(xisf_file(rgb + R"(sampleFormat="Float64")", values_of_type<double>(3)), "f64");
    expect_colors(xisf_file(rgb + R"(sampleFormat="UInt16" pixelStorage="Normal")",
                            values_of_type<std::uint16_t>(3, true)),
                  "by pixel");
    expect_colors(
        xisf_file(rgb + R"(sampleFormat="Float32" byteOrder="big")", values_of_type<float>(3, false, true)),
        "big endian");
    const std::string grey = xisf_file(geometry(1) + R"(sampleFormat="Float32")", values_of_type<float>(1));
    EXPECT_EQ(read(grey).channels, 1);
    EXPECT_EQ(read(grey).values[0], 1.0) << "the first row is on top";
    const std::string file = xisf_file(rgb + R"(sampleFormat="Float32")", values_of_type<float>(3));
    EXPECT_EQ(read(file, 2).values[1], value_of(1, 0, 2));
    EXPECT_HAS(ERROR_OF(read(file, 3)), "expected a plane from 0 to 2, found plane = 3");
    const fs::path path = folder.file("b.xisf", file);
    EXPECT_EQ(describe_fits(path)[0].range.max, value_of(xisf_columns - 1, xisf_rows - 1, 2));
    EXPECT_NO_THROW(require_fits_picture(path));
    EXPECT_EQ(read_stored(path, {}, {}).picture.image.channels, 3);
}

TEST_F(XisfTest, BlocksOfEveryCompression) {
    const std::string values = values_of_type<float>(3), mixed = shuffled(values, 4);
    const auto file = [&](const std::string& codec, const std::string& packed, const std::string& more = "") {
        const std::string item = codec.ends_with("+sh") ? ":4" : "";
        return xisf_file(geometry(3) + fmt::format(R"(sampleFormat="Float32" compression="{}:{}{}" {})",
                                                   codec, values.size(), item, more),
                         packed);
    };
    expect_colors(file("zlib", zlib_packed(values)), "zlib");
    expect_colors(file("lz4", lz4_packed(values)), "lz4");
    expect_colors(file("lz4hc", lz4_packed(values)), "lz4hc");
    expect_colors(file("zstd", zstd_packed(values)), "zstd");
    expect_colors(file("zlib+sh", zlib_packed(mixed)), "zlib+sh");
    expect_colors(file("lz4+sh", lz4_packed(mixed)), "lz4+sh");
    expect_colors(file("zstd+sh", zstd_packed(mixed)), "zstd+sh");
    const std::string first = lz4_packed(values.substr(0, 100)), second = lz4_packed(values.substr(100));
    const std::string parts =
        fmt::format(R"(subblocks="{},100:{},{}")", first.size(), second.size(), values.size() - 100);
    expect_colors(file("lz4", first + second, parts), "subblocks");
    EXPECT_HAS(ERROR_OF(read(file("bzip2", values))),
               "expected compression zlib, lz4, lz4hc, zstd, found bzip2");
    for (const char* codec : {"zlib", "lz4", "zstd"})
        EXPECT_HAS(ERROR_OF(read(file(codec, values))), "bytes compressed by") << codec;
    const std::string sum = R"(checksum="sha-1:)" + std::string(40, '0') + "\"";
    EXPECT_HAS(ERROR_OF(read(file("zlib", zlib_packed(values), sum))),
               "expected data of the sha-1 that it names");
}

TEST_F(XisfTest, KeywordsAndSky) {
    const std::string values = values_of_type<float>(1), start = geometry(1) + R"(sampleFormat="Float32")";
    const auto card = [](const char* name, const std::string& value) {
        return fmt::format(R"(<FITSKeyword name="{}" value="{}" comment=""/>)", name, value);
    };
    const std::string sky = card("CTYPE1", "'RA---TAN'") + card("CTYPE2", "'DEC--TAN'") +
                            card("CRVAL1", "83.8") + card("CRVAL2", "-5.4") + card("CRPIX1", "2") +
                            card("CRPIX2", "1") + card("CD1_1", "-0.01") + card("CD2_2", "0.01");
    const FitsPlane told =
        read(xisf_file(start, values, card("OBJECT", "'M 42'") + card("AUTHOR", "'A. Nobody'") + sky));
    EXPECT_EQ(told.object, "M 42");
    EXPECT_EQ(told.credit, "A. Nobody");
    ASSERT_TRUE(told.sky.grid);
    std::array lowest{glm::dvec2(2.0, 1.0)};
    told.sky.grid->to_sky(lowest);
    EXPECT_NEAR(lowest[0].x, 83.8, 1e-9);
    EXPECT_NEAR(lowest[0].y, -5.4, 1e-9);
    // The same by PixInsight's own properties: places from the upper left corner.
    const auto numbers = [](const std::string& name, const std::vector<double>& list) {
        const std::string bytes(reinterpret_cast<const char*>(list.data()), 8 * list.size());
        return fmt::format(
            R"(<Property id="PCL:AstrometricSolution:{}" type="F64Vector" length="{}" location="inline:base64">{}</Property>)",
            name, list.size(), base64(bytes));
    };
    const std::string own =
        R"(<Property id="PCL:AstrometricSolution:ProjectionSystem" type="String">Gnomonic</Property>)" +
        numbers("ReferenceCelestialCoordinates", {83.8, -5.4}) +
        numbers("ReferenceImageCoordinates", {1.5, xisf_rows - 0.5}) +
        numbers("LinearTransformationMatrix", {-0.01, 0.0, 0.0, -0.01});
    const FitsPlane solved = read(xisf_file(start, values, own));
    ASSERT_TRUE(solved.sky.grid);
    EXPECT_TRUE(*solved.sky.grid == *told.sky.grid);
    const std::string mosaic = R"(<ColorFilterArray pattern="RGGB" width="2" height="2"/>)";
    EXPECT_EQ(read(xisf_file(start, values, mosaic)).channels, 3);
    const std::vector<std::string> said = warnings_of([&] {
        EXPECT_EQ(read(xisf_file(start, values, R"(<ColorFilterArray pattern="CMYG"/>)")).channels, 1);
    });
    ASSERT_EQ(said.size(), 1u);
    EXPECT_HAS(said[0], "its colour filter array 'CMYG' is not followed");
    const Said once;
    const fs::path more =
        folder.file("m.xisf", xisf_file(geometry(2) + R"(sampleFormat="Float32")", values_of_type<float>(2)));
    require_picture(more);
    open_stored(more, {}, {});
    forget_warnings();
    EXPECT_HAS(once.one_warning(), "1 channel more than its colours is not followed");
}

// Of colours that are squares of light: for pictures and for prepared ones, and not where they are stretched.
TEST_F(XisfTest, Profiles) {
    const cmsCIExyY white{0.3127, 0.3290, 1.0};
    const cmsCIExyYTRIPLE primaries{{0.64, 0.33, 1.0}, {0.30, 0.60, 1.0}, {0.15, 0.06, 1.0}};
    cmsToneCurve* const squares = cmsBuildGamma(nullptr, 2.0);
    cmsToneCurve* curves[] = {squares, squares, squares};
    const cmsHPROFILE made = cmsCreateRGBProfile(&white, &primaries, curves);
    cmsUInt32Number size = 0;
    cmsSaveProfileToMem(made, nullptr, &size);
    std::string profile(size, '\0');
    cmsSaveProfileToMem(made, profile.data(), &size);
    cmsCloseProfile(made);
    cmsFreeToneCurve(squares);
    const fs::path file = folder.file(
        "a.xisf", xisf_file(geometry(3) + R"(sampleFormat="Float32" bounds="0:200")",
                            values_of_type<float>(3), R"(<Reference ref="other"/><Reference ref="p"/>)",
                            fmt::format(R"(<ICCProfile uid="p" location="inline:base64">{}</ICCProfile>)",
                                        base64(profile))));
    TextureSettings settings;
    settings.stretch = TextureSettings::Stretch::linear;
    settings.black = 0.0;
    settings.white = 200.0;
    settings.alpha = TextureSettings::Alpha::one;
    const Image shown = load_texture({file}, settings, Wrap::clamp).image,
                prepared = prepare_picture({file}, settings, {}).image;
    for (const Image* image : {&shown, &prepared})
        for (int c = 0; c < 3; ++c) {
            const double stored = value_of(5, 3, c) / 200.0;
            EXPECT_NEAR(image->at(5, 3)[c], stored * stored, 1e-3) << c << (image == &shown);
        }
    settings.stretch = TextureSettings::Stretch::asinh;
    for (const bool prepare : {false, true}) {
        const std::vector<std::string> said = warnings_of([&] {
            prepare ? void(prepare_picture({file}, settings, {}))
                    : void(load_texture({file}, settings, Wrap::clamp));
        });
        ASSERT_EQ(said.size(), 1u) << prepare;
        EXPECT_HAS(said[0], "is not followed: the stretch makes colours of sRGB");
    }
}

// As NINA writes it: FITS' keyword alone.
TEST_F(XisfTest, AMosaicOfAKeywordIsAPictureOfColours) {
    const std::string grey = geometry(1) + R"(sampleFormat="Float32")", pixels = values_of_type<float>(1);
    EXPECT_EQ(read(xisf_file(grey, pixels)).channels, 1);
    EXPECT_EQ(read(xisf_file(grey, pixels, R"(<FITSKeyword name="BAYERPAT" value="'RGGB    '"/>)")).channels,
              3);
}

TEST_F(XisfTest, SeveralImages) {
    const std::string other = fmt::format(
        R"(<Image id="second" geometry="2:1:1" sampleFormat="UInt8" location="inline:hex">0a0b</Image>)");
    const std::string file =
        xisf_file(geometry(1) + R"(sampleFormat="Float32")", values_of_type<float>(1), "", other);
    FitsPlane plane;
    EXPECT_EQ(warnings_of([&] { plane = read(file); }).size(), 1u);
    EXPECT_EQ(plane.width, xisf_columns);
    EXPECT_EQ(read(file, {}, "second").values[1], 11.0);
    EXPECT_EQ(read(file, {}, "1").width, 2);
    EXPECT_HAS(ERROR_OF(read(file, {}, "third")), "expected one of 2 images, found hdu = third");
}

TEST_F(XisfTest, WhatCannotBeIsOneLine) {
    const auto error = [&](const std::string& attributes) {
        return ERROR_OF(read(xisf_file(attributes + R"( sampleFormat="Float32")", values_of_type<float>(3))));
    };
    EXPECT_HAS(error(R"(geometry="6:4")"), "expected an image of WIDTH:HEIGHT:CHANNELS, found 6:4");
    EXPECT_HAS(error(R"(geometry="-6:4:3")"), "expected a width, a whole number, found '-6'");
    EXPECT_HAS(error(R"(geometry="6:4:4")"), "expected 384 bytes of data, found 288");
    EXPECT_HAS(error(R"(geometry="4294967296:4294967296:3")"), "a picture that fits into memory");
    EXPECT_HAS(error(R"(geometry="6:4:3" colorSpace="CIELab")"),
               "expected colours of RGB or Gray, found CIELab");
    EXPECT_THROW(
        read(xisf_file(
            R"(geometry="2000000:2000000:1" sampleFormat="Float32" compression="zlib:16000000000000")", "x")),
        InputError);
    EXPECT_HAS(ERROR_OF(read(xisf_file(geometry(1) + R"(sampleFormat="Complex64")", ""))), "found Complex64");
    const std::string whole = xisf_file(geometry(3) + R"(sampleFormat="Float32")", values_of_type<float>(3));
    for (const std::size_t size : {9u, 16u, 100u, 400u, 4096u, 4200u})
        EXPECT_THROW(read(whole.substr(0, size)), InputError) << size;
    std::string wrong = whole;
    wrong[11] = '\x7f';
    EXPECT_HAS(ERROR_OF(read(wrong)), "expected a header within the file");
}

}  // namespace
}  // namespace astrosplat
