// Several pictures in one file, and the colours that a file names.
#include "support/test.h"
// its fmt first: OpenImageIO's copy would turn exceptions off
#include <OpenImageIO/imageio.h>
#include <lcms2.h>
#include <zlib.h>

#include <fstream>

#include "core/color.h"
#include "core/file.h"
#include "source/color_encoding.h"
#include "source/picture.h"
#include "source/stored_picture.h"
#include "source/texture.h"
#include "support/quiet.h"

namespace astrosplat {
namespace {

using Spec = OIIO::ImageSpec;

struct Page {
    Spec spec;
    std::vector<float> first_pixel;  // all others are a little brighter, so that it is not blank
    bool blank = false;
};

Page page(int size, std::vector<std::string> channels, std::vector<float> first, OIIO::TypeDesc type) {
    Spec spec(size, size, int(channels.size()), type);
    spec.channelnames = std::move(channels);
    return {spec, std::move(first)};
}

fs::path write_pages(const fs::path& file, const std::vector<Page>& pages) {
    const auto out = OIIO::ImageOutput::create(file.string());
    std::vector<Spec> specs;
    for (const Page& p : pages) specs.push_back(p.spec);
    const bool exr = file.extension() == ".exr";
    for (std::size_t i = 0; i < pages.size(); ++i) {
        const bool open =
            exr && i == 0 ? out->open(file.string(), int(specs.size()), specs.data())
                          : out->open(file.string(), specs[i],
                                      i == 0 ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendSubimage);
        EXPECT_TRUE(open) << out->geterror();
        std::vector<float> values;
        for (int n = 0; n < specs[i].width * specs[i].height; ++n)
            for (const float v : pages[i].first_pixel)
                values.push_back(n == 0 || pages[i].blank ? v : v + 0.01f);
        EXPECT_TRUE(out->write_image(OIIO::TypeFloat, values.data())) << out->geterror();
    }
    EXPECT_TRUE(out->close());
    return file;
}

std::vector<float> first_pixel(const fs::path& file, const std::string& part = "auto") {
    const Image image = read_picture(file, {}, part).image;
    return {image.pixels.begin(), image.pixels.begin() + image.channels};
}

TEST(SeveralPictures, OfAnExrThePartWithColoursIsTaken) {
    const TempFolder folder;
    const auto part = [](const char* name, Page p) {
        p.spec.attribute("name", name);
        return p;
    };
    const Page depth = part("depth", page(4, {"Z"}, {50.0f}, OIIO::TypeFloat)),
               beauty =
                   part("rgba", page(4, {"R", "G", "B", "A"}, {0.5f, 0.25f, 0.125f, 1.0f}, OIIO::TypeFloat)),
               grey = part("light", page(4, {"Y"}, {0.75f}, OIIO::TypeFloat));
    const fs::path file = write_pages(folder / "a.exr", {depth, grey, beauty});
    std::vector<float> taken;
    EXPECT_EQ(warnings_of([&] { taken = first_pixel(file); }).size(), 0u);
    EXPECT_EQ(taken, beauty.first_pixel);
    EXPECT_EQ(first_pixel(file, "depth"), (std::vector<float>{50.0f, 50.0f, 50.0f}));
    EXPECT_EQ(first_pixel(file, "1"), (std::vector<float>{0.75f, 0.75f, 0.75f}));
    EXPECT_EQ(ERROR_OF(first_pixel(file, "normals")),
              file.string() + ": expected a picture of depth, light, rgba, found hdu = normals");
    EXPECT_EQ(ERROR_OF(first_pixel(file, "3")),
              file.string() + ": expected a picture of depth, light, rgba, found hdu = 3");
    const PictureParts parts = describe_parts(file);
    EXPECT_EQ(parts.taken, 2);
    EXPECT_EQ(parts.parts[2], "2: 4x4 px, 4 channels, 'rgba'");
    const fs::path none = write_pages(folder / "b.exr", {depth, grey});
    const std::vector<std::string> said = warnings_of([&] { taken = first_pixel(none); });
    EXPECT_EQ(taken[0], 0.75f);
    EXPECT_EQ(said, std::vector<std::string>{
                        none.string() +
                        ": it holds 2 pictures; 1 'light' is taken (hdu = NAME or NUMBER takes another)"});
    TextureSettings settings;
    settings.hdu = "depth";
    EXPECT_EQ(read_stored(file, settings, {}).picture.image.pixels[0], 50.0f);
    EXPECT_EQ(open_stored(file, settings, {}).stored.picture.image.channels, 3);
}

TEST(SeveralPictures, OfAnExrTheFirstLayerOrTheNamed) {
    const TempFolder folder;
    const fs::path file = write_pages(
        folder / "a.exr", {page(4, {"gas.R", "gas.G", "gas.B", "stars.R", "stars.G", "stars.B", "stars.A"},
                                {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 1.0f}, OIIO::TypeFloat)});
    std::vector<float> taken;
    EXPECT_EQ(warnings_of([&] { taken = first_pixel(file); }),
              std::vector<std::string>{file.string() + ": 4 channels more than gas.R, gas.G, gas.B are not "
                                                       "followed (hdu = stars takes another)"});
    EXPECT_EQ(taken, (std::vector<float>{0.1f, 0.2f, 0.3f}));
    EXPECT_EQ(first_pixel(file, "Stars"), (std::vector<float>{0.4f, 0.5f, 0.6f, 1.0f}));
    EXPECT_HAS(ERROR_OF(first_pixel(file, "dust")), "gas, stars, found hdu = dust");
}

TEST(SeveralPictures, OfATiffTheLargestPageThatShows) {
    const TempFolder folder;
    const auto rgb = [](int size, float v) {
        return page(size, {"R", "G", "B"}, {v, v, v}, OIIO::TypeFloat);
    };
    Page reduced = rgb(2, 0.1f), large_mask = rgb(8, 0.2f), black = rgb(4, 0.0f);
    reduced.spec.attribute("tiff:subfiletype", 1);
    large_mask.spec.attribute("tiff:subfiletype", 4);
    black.blank = true;
    std::vector<float> taken;
    const auto said_of = [&](const std::vector<Page>& pages) {
        const fs::path file = write_pages(folder / "x.tif", pages);
        return warnings_of([&] { taken = first_pixel(file); }).size();
    };
    EXPECT_EQ(said_of({reduced, rgb(4, 0.5f)}), 0u);
    EXPECT_FLOAT_EQ(taken[0], 0.5f);
    EXPECT_EQ(said_of({rgb(4, 0.5f), reduced}), 0u);
    EXPECT_FLOAT_EQ(taken[0], 0.5f);
    EXPECT_EQ(said_of({black, rgb(4, 0.6f)}), 1u);
    EXPECT_FLOAT_EQ(taken[0], 0.6f);
    EXPECT_EQ(said_of({rgb(3, 0.3f), rgb(4, 0.7f)}), 1u);
    EXPECT_FLOAT_EQ(taken[0], 0.7f);
    EXPECT_EQ(said_of({rgb(4, 0.8f), rgb(4, 0.9f)}), 1u);
    EXPECT_FLOAT_EQ(taken[0], 0.8f) << "the first of the same size";
    EXPECT_EQ(said_of({black, black}), 1u);
    EXPECT_FLOAT_EQ(taken[0], 0.0f);
}

TEST(SeveralPictures, ChannelsOfImageJ) {
    const TempFolder folder;
    std::vector<Page> pages;
    for (const float v : {0.25f, 0.5f, 0.75f}) pages.push_back(page(4, {"Y"}, {v}, OIIO::TypeFloat));
    pages[0].spec.attribute("ImageDescription", "ImageJ=1.53\nimages=3\nchannels=3\n");
    const fs::path file = write_pages(folder / "x.tif", pages);
    EXPECT_EQ(first_pixel(file), (std::vector<float>{0.25f, 0.5f, 0.75f}));
    EXPECT_EQ(first_pixel(file, "1"), (std::vector<float>{0.5f, 0.5f, 0.5f}));
    pages[0].spec.attribute("ImageDescription", "ImageJ=1.53\nimages=3\nslices=3\n");
    EXPECT_EQ(first_pixel(write_pages(folder / "x.tif", pages))[1], 0.25f);
}

TEST(SeveralPictures, FramesOfAnAnimation) {
    const TempFolder folder;
    std::vector<Page> pages;
    for (const float v : {1.0f, 0.0f}) pages.push_back(page(4, {"R", "G", "B"}, {v, v, v}, OIIO::TypeUInt8));
    const fs::path file = write_pages(folder / "x.gif", pages);
    std::vector<float> first;
    const std::vector<std::string> said = warnings_of([&] { first = first_pixel(file); });
    EXPECT_EQ(first[0], 1.0f);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_HAS(said[0], "it holds 2 pictures; 0 is taken");
    EXPECT_EQ(first_pixel(file, "1")[0], 0.0f);
}

TEST(SeveralPictures, CameraRawIsNotItsThumbnail) {
    const TempFolder folder;
    for (const char* name : {"x.nef", "x.dng"}) {
        write_pages(folder / "x.tif", {page(4, {"R", "G", "B"}, {0.5f, 0.5f, 0.5f}, OIIO::TypeUInt8)});
        fs::rename(folder / "x.tif", folder / name);
        EXPECT_HAS(ERROR_OF(read_picture(folder / name)), "cannot be read as a picture") << name;
    }
}

// ---- colours

fs::path write_pixels(const fs::path& file, Spec spec, const std::vector<float>& values) {
    const auto out = OIIO::ImageOutput::create(file.string());
    EXPECT_TRUE(out && out->open(file.string(), spec) && out->write_image(OIIO::TypeFloat, values.data()) &&
                out->close());
    return file;
}

const std::vector<float> some_colors = {0.2f, 0.4f, 0.6f, 0.8f,  0.4f, 0.0f,
                                        1.0f, 1.0f, 1.0f, 0.05f, 0.5f, 0.95f};

/// What they become, by a curve and a matrix.
template <class Curve>
void expect_light(const fs::path& file, const Curve& curve, const glm::dmat3& matrix,
                  const std::string& what) {
    const Image light = load_linear_image(file);
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec3 stored(some_colors[3 * i], some_colors[3 * i + 1], some_colors[3 * i + 2]);
        const glm::dvec3 wanted = matrix * glm::dvec3(curve(stored.x), curve(stored.y), curve(stored.z));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(light.pixels[4 * i + std::size_t(c)], wanted[c], 0.003)
                << what << " " << i << " " << c;
    }
}

constexpr Chromaticities p3{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}};
constexpr Chromaticities adobe{{0.64, 0.33}, {0.21, 0.71}, {0.15, 0.06}, {0.3127, 0.3290}};
double linear(double x) { return x; }
double srgb(double x) { return real::srgb_to_linear(x); }
double gamma_22(double x) { return std::pow(x, 2.19921875); }

std::vector<std::uint8_t> profile_bytes(cmsHPROFILE profile) {
    cmsUInt32Number size = 0;
    cmsSaveProfileToMem(profile, nullptr, &size);
    std::vector<std::uint8_t> bytes(size);
    cmsSaveProfileToMem(profile, bytes.data(), &size);
    cmsCloseProfile(profile);
    return bytes;
}

std::vector<std::uint8_t> profile_of(const Chromaticities& set, cmsToneCurve* curve) {
    const auto xyy = [](const glm::dvec2& c) { return cmsCIExyY{c.x, c.y, 1.0}; };
    const cmsCIExyY white = xyy(set.white);
    const cmsCIExyYTRIPLE primaries{xyy(set.red), xyy(set.green), xyy(set.blue)};
    cmsToneCurve* curves[] = {curve, curve, curve};
    std::vector<std::uint8_t> bytes = profile_bytes(cmsCreateRGBProfile(&white, &primaries, curves));
    cmsFreeToneCurve(curve);
    return bytes;
}

cmsToneCurve* gamma_of(double gamma) { return cmsBuildGamma(nullptr, gamma); }
cmsToneCurve* srgb_curve() {
    const cmsFloat64Number p[] = {2.4, 1.0 / 1.055, 0.055 / 1.055, 1.0 / 12.92, 0.04045};
    return cmsBuildParametricToneCurve(nullptr, 4, p);
}
cmsToneCurve* table_of_squares() {
    std::vector<cmsUInt16Number> table;
    for (int i = 0; i < 1024; ++i)
        table.push_back(cmsUInt16Number(65535.0 * i * i / (1023.0 * 1023.0) + 0.5));
    return cmsBuildTabulatedToneCurve16(nullptr, cmsUInt32Number(table.size()), table.data());
}

TEST(FileColors, ProfilesOfMatrixAndCurves) {
    const TempFolder folder;
    const auto check = [&](const char* name, OIIO::TypeDesc type, const std::vector<std::uint8_t>& profile,
                           const auto& curve, const Chromaticities& set) {
        Spec spec(2, 2, 3, type);
        spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, int(profile.size())),
                       profile.data());
        expect_light(write_pixels(folder / name, spec, some_colors), curve,
                     primaries_matrix(set, rec709_chromaticities), name);
    };
    const auto squares = [](double x) { return x * x; };
    for (const OIIO::TypeDesc& type : {OIIO::TypeUInt8, OIIO::TypeUInt16}) {
        check("p3.png", type, profile_of(p3, srgb_curve()), srgb, p3);
        check("linear.png", type, profile_of(rec709_chromaticities, gamma_of(1.0)), linear,
              rec709_chromaticities);
        check("adobe.tif", type, profile_of(adobe, gamma_of(2.19921875)), gamma_22, adobe);
        check("table.tif", type, profile_of(p3, table_of_squares()), squares, p3);
    }
    // ICC.1:2022, table 68, functions 2 and 4 (lcms counts from 1): with an offset, and with a line below.
    const cmsFloat64Number offset[] = {2.0, 0.8, 0.1, 0.05}, line[] = {2.0, 0.9, 0.1, 0.5, 0.3, 0.02, 0.01};
    check(
        "offset.tif", OIIO::TypeFloat, profile_of(p3, cmsBuildParametricToneCurve(nullptr, 3, offset)),
        [](double x) { return (0.8 * x + 0.1) * (0.8 * x + 0.1) + 0.05; }, p3);
    check(
        "line.tif", OIIO::TypeFloat, profile_of(p3, cmsBuildParametricToneCurve(nullptr, 5, line)),
        [](double x) { return x < 0.3 ? 0.5 * x + 0.01 : (0.9 * x + 0.1) * (0.9 * x + 0.1) + 0.02; }, p3);
    check("srgb.tif", OIIO::TypeFloat, profile_of(rec709_chromaticities, srgb_curve()), srgb,
          rec709_chromaticities);
    check("linear.tif", OIIO::TypeFloat, profile_of(p3, gamma_of(1.0)), linear, p3);
    for (const bool named : {false, true}) {  // sRGB by its profile has the bits that it has without
        Spec spec(2, 2, 3, OIIO::TypeUInt8);
        const std::vector<std::uint8_t> profile = profile_of(rec709_chromaticities, srgb_curve());
        if (named)
            spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, int(profile.size())),
                           profile.data());
        write_pixels(folder / (named ? "named.png" : "plain.png"), spec, some_colors);
    }
    EXPECT_EQ(load_linear_image(folder / "named.png").pixels, load_linear_image(folder / "plain.png").pixels);
}

TEST(FileColors, WhatIsNotFollowedIsSaid) {
    const TempFolder folder;
    Spec spec(2, 2, 3, OIIO::TypeUInt8);
    const auto said = [&](const std::vector<std::uint8_t>& profile) {
        spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, int(profile.size())),
                       profile.data());
        const fs::path file = write_pixels(folder / "x.tif", spec, some_colors);
        const std::vector<std::string> lines =
            warnings_of([&] { expect_light(file, srgb, glm::dmat3(1.0), "sRGB"); });
        return lines.size() == 1 ? lines[0].substr(file.string().size()) : "";
    };
    EXPECT_HAS(said(profile_bytes(cmsCreateLab4Profile(nullptr))),
               "which is not one of matrix and curves, is not "
               "followed; colours are read as sRGB");
    EXPECT_HAS(said(std::vector<std::uint8_t>(200, 7)), "which is damaged, is not followed");
    std::vector<std::uint8_t> cut = profile_of(p3, gamma_of(2.2));
    for (std::size_t size = 0; size < cut.size(); size += 13) {  // none crashes
        std::string problem;
        EXPECT_TRUE(!icc_encoding({cut.data(), size}, problem) || problem.empty());
    }
}

TEST(FileColors, ChromaticitiesOfExr) {
    const TempFolder folder;
    Spec spec(2, 2, 3, OIIO::TypeFloat);
    const auto with = [&](const Chromaticities& set) {
        const float xy[] = {float(set.red.x),  float(set.red.y),  float(set.green.x), float(set.green.y),
                            float(set.blue.x), float(set.blue.y), float(set.white.x), float(set.white.y)};
        spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), xy);
        return write_pixels(folder / "x.exr", spec, some_colors);
    };
    for (const Chromaticities& set : {acescg_chromaticities, p3, rec709_chromaticities})
        expect_light(with(set), linear, primaries_matrix(set, rec709_chromaticities), "chromaticities");
    const Image plain = load_linear_image(with(rec709_chromaticities));
    for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(plain.pixels[i / 3 * 4 + i % 3], some_colors[i]);
    const Said said;
    expect_light(with({{0, 0}, {0, 0}, {0, 0}, {0, 0}}), linear, glm::dmat3(1.0), "none");
    EXPECT_HAS(said.one_warning(), "its set of chromaticities is not followed; colours are read as linear");
    TextureSettings settings;
    settings.colorspace = TextureSettings::Colorspace::linear;  // wins
    Stored stored = read_stored(with(p3), settings, {});
    make_linear(stored, settings.colorspace, false);
    EXPECT_EQ(stored.picture.image.pixels[0], some_colors[0]);
}

std::string chunk(const std::string& name, const std::string& data) {
    const auto number = [](unsigned long n) {
        std::string bytes;
        for (int shift = 24; shift >= 0; shift -= 8) bytes += char(n >> shift & 255U);
        return bytes;
    };
    const std::string body = name + data;
    return number(data.size()) + body +
           number(crc32(0, reinterpret_cast<const Bytef*>(body.data()), unsigned(body.size())));
}

TEST(FileColors, ChunksOfPng) {
    const TempFolder folder;
    const std::string plain =
        test::bytes_of(write_pixels(folder / "plain.png", Spec(2, 2, 3, OIIO::TypeUInt16), some_colors));
    const auto with = [&](const std::string& chunks) {
        constexpr std::size_t after_header = 8 + 25;
        std::string bytes = plain;
        // OpenImageIO's own chunks about colour, which come next
        for (const char* name : {"sRGB", "gAMA", "cHRM", "iCCP"})
            if (const std::size_t at = bytes.find(name); at != std::string::npos) {
                std::size_t size = 0;
                for (std::size_t i = 0; i < 4; ++i) size = size << 8U | std::uint8_t(bytes[at - 4 + i]);
                bytes.erase(at - 4, size + 12);
            }
        bytes.insert(after_header, chunks);
        return folder.file("x.png", bytes);
    };
    const auto numbers = [](const std::vector<unsigned>& values) {
        std::string bytes;
        for (const unsigned n : values)
            for (int shift = 24; shift >= 0; shift -= 8) bytes += char(n >> shift & 255U);
        return bytes;
    };
    const glm::dmat3 same(1.0), of_p3 = primaries_matrix(p3, rec709_chromaticities);
    const auto cicp = [](int primaries, int transfer) {
        return chunk("cICP", {char(primaries), char(transfer), '\0', '\1'});
    };
    const std::string gamma = chunk("gAMA", numbers({100000})),
                      srgb_chunk = chunk("sRGB", std::string(1, '\0'));
    const std::string chrm = chunk("cHRM", numbers({31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000}));
    expect_light(with(""), srgb, same, "none");
    const std::vector<std::string> refused = warnings_of([&] {
        expect_light(with(chunk("iCCP", std::string("x\0\0no profile", 13)) + gamma), srgb, same, "iCCP");
    });
    ASSERT_EQ(refused.size(), 1u);
    EXPECT_HAS(refused[0], "ICC profile, which libpng refuses, is not followed");
    expect_light(with(gamma), linear, same, "gAMA");
    expect_light(
        with(chunk("gAMA", numbers({50000}))), [](double x) { return x * x; }, same, "gAMA 1/2");
    expect_light(with(gamma + chrm), linear, of_p3, "gAMA and cHRM");
    expect_light(with(chrm), srgb, of_p3, "cHRM");
    expect_light(with(srgb_chunk + gamma + chrm), srgb, same, "sRGB comes before them");
    expect_light(with(cicp(12, 13) + srgb_chunk), srgb, of_p3, "cICP comes first");
    expect_light(with(cicp(1, 8)), linear, same, "linear");
    expect_light(with(cicp(9, 8)), linear,
                 primaries_matrix({{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}},
                                  rec709_chromaticities),
                 "BT.2020");
    const auto video = [](double x) {
        return x < 0.081 ? x / 4.5 : std::pow((x + 0.099) / 1.099, 1.0 / 0.45);
    };
    expect_light(with(cicp(1, 1)), video, same, "BT.709");
    const std::vector<std::string> said =
        warnings_of([&] { expect_light(with(cicp(2, 2)), srgb, same, "2/2"); });
    ASSERT_EQ(said.size(), 1u);
    EXPECT_HAS(said[0], "its cICP 2/2/0/1 is not followed");
    const std::vector<std::string> moves = warnings_of([&] {
        expect_light(with(chunk("acTL", numbers({3, 0}))), srgb, same, "animated");
    });
    ASSERT_EQ(moves.size(), 1u);
    EXPECT_HAS(moves[0], "it holds 3 pictures; 0 is taken, as the others are not followed");
}

// ITU-R BT.2408-7, table 1: reference white is 203 cd/m^2, 58 % of PQ's and 75 % of HLG's signal.
TEST(FileColors, ReferenceWhiteIsOne) {
    const TransferCurve pq{TransferCurve::Kind::pq, {}, {}}, hlg{TransferCurve::Kind::hlg, {}, {}};
    EXPECT_NEAR(pq(0.5806888810416109), 1.0, 1e-6);
    EXPECT_NEAR(pq(1.0), 10000.0 / 203.0, 1e-9);
    EXPECT_EQ(pq(0.0), 0.0);
    EXPECT_EQ(hlg(0.75), 1.0);
    EXPECT_NEAR(hlg(0.5) / hlg(1.0), 1.0 / 12.0, 1e-6);
}

// DPX and Targa by OpenImageIO's names, EXR by the Color Interop Forum's.
TEST(FileColors, NamesOfColourSpaces) {
    const TempFolder folder;
    const auto check = [&](const char* name, OIIO::TypeDesc type, const char* key, const std::string& space,
                           const auto& curve) {
        Spec spec(2, 2, 3, type);
        spec.attribute(key, space);
        if (space == "Gamma1.8") spec.attribute("oiio:Gamma", 1.8f);
        expect_light(write_pixels(folder / name, spec, some_colors), curve, glm::dmat3(1.0), name + space);
    };
    check("a.dpx", OIIO::TypeUInt16, "oiio:ColorSpace", "Linear", linear);
    check("a.dpx", OIIO::TypeUInt16, "oiio:ColorSpace", "Rec709",
          [](double x) { return x < 0.081 ? x / 4.5 : std::pow((x + 0.099) / 1.099, 1.0 / 0.45); });
    check("a.tga", OIIO::TypeUInt8, "oiio:ColorSpace", "Gamma1.8", [](double x) { return std::pow(x, 1.8); });
    for (const char* const id : {"data", "lin_rec709_scene"})
        check("a.exr", OIIO::TypeFloat, "colorInteropID", id, linear);
    const std::vector<std::string> said =
        warnings_of([&] { check("a.exr", OIIO::TypeFloat, "colorInteropID", "srgb_rec709_scene", linear); });
    ASSERT_EQ(said.size(), 1u);
    EXPECT_HAS(said[0], "its colorInteropID srgb_rec709_scene is not followed; colours are read as linear");
}

// A JPEG of OpenImageIO's with another segment behind its first two bytes.
fs::path jpeg_with(const fs::path& file, const std::string& marker, const std::string& segment) {
    Spec spec(16, 16, 3, OIIO::TypeUInt8);
    spec.attribute("CompressionQuality", 100);
    std::vector<float> values;
    for (int i = 0; i < 256; ++i) values.insert(values.end(), {0.6f, 0.4f, 0.2f});
    write_pixels(file, spec, values);
    const std::string bytes = read_file(file);
    const std::size_t size = segment.size() + 2;
    std::ofstream(file, std::ios::binary)
        << bytes.substr(0, 2) << marker << char(size >> 8) << char(size & 255U) << segment << bytes.substr(2);
    return file;
}

// DCF 2.0: without a profile, the option file R03 is Adobe RGB. Either byte order.
TEST(FileColors, CamerasSayAdobeRgbInExif) {
    const TempFolder folder;
    const std::string little("Exif\0\0II*\0\x08\0\0\0\x01\0\x01\0\x02\0\x04\0\0\0R03\0\0\0\0\0", 32),
        big("Exif\0\0MM\0*\0\0\0\x08\0\x01\0\x01\0\x02\0\0\0\x04R03\0\0\0\0\0", 32);
    for (const std::string& exif : {little, big}) {
        const Image light = load_linear_image(jpeg_with(folder / "a.jpg", "\xff\xe1", exif));
        const glm::dvec3 wanted = primaries_matrix(adobe, rec709_chromaticities) *
                                  glm::dvec3(gamma_22(0.6), gamma_22(0.4), gamma_22(0.2));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(light.at(8, 8)[c], wanted[c], 0.01) << c;
    }
}

// CIPA DC-007, as phones and stereo cameras write it.
TEST(SeveralPictures, OthersInAJpegAreSaid) {
    const TempFolder folder;
    const auto said_of = [&](char count) {
        const std::string index("MPF\0MM\0*\0\0\0\x08\0\x01\xb0\x01\0\x04\0\0\0\x01\0\0\0", 25);
        const fs::path file = jpeg_with(folder / "a.jpg", "\xff\xe2", index + count + std::string(4, '\0'));
        return warnings_of([&] { read_picture(file); });
    };
    EXPECT_TRUE(said_of('\1').empty());
    ASSERT_EQ(said_of('\3').size(), 1u);
    EXPECT_HAS(said_of('\3')[0], "a.jpg: it holds 3 pictures; 0 is taken, as the others are not followed");
}

}  // namespace
}  // namespace astrosplat
