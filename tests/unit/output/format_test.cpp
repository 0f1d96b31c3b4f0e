// Which settings go together, and each message where they do not.
#include "output/format.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace astrosplat {
namespace {

using Depth = OutputParams::Depth;
using Compression = OutputParams::Compression;
using Alpha = OutputParams::Alpha;
using View = OutputParams::View;

OutputParams to(const char* path) {
    OutputParams output;
    output.path = path;
    return output;
}

std::string error_of(const OutputParams& output) {
    try {
        check_output(output);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

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
    output = to("a.tif");
    output.depth = Depth::float32;
    EXPECT_EQ(error_of(output), "no error");
    output.primaries = OutputParams::Primaries::acescg;
    EXPECT_EQ(error_of(output), "output.primaries: expected rec709 in float tif files, found acescg");
}

TEST(Format, EveryGoodCombinationPasses) {
    for (Compression c :
         {Compression::zip, Compression::zips, Compression::piz, Compression::dwaa, Compression::none}) {
        OutputParams output = to("a.####.exr");
        output.compression = c;
        output.depth = Depth::float32;
        output.aovs = {"depth", "coverage", "count", "layers"};
        EXPECT_EQ(error_of(output), "no error");
    }
    for (Compression c : {Compression::deflate, Compression::lzw, Compression::none}) {
        OutputParams output = to("a.####.tif");
        output.compression = c;
        EXPECT_EQ(error_of(output), "no error");
    }
}

TEST(Format, EachMisfitHasItsMessage) {
    EXPECT_EQ(error_of(to("a.####.jpg")),
              "output.path: expected a file ending in .exr, .tif, .tiff or .png, found 'a.####.jpg'");
    EXPECT_EQ(error_of(to("frames")),
              "output.path: expected a file ending in .exr, .tif, .tiff or .png, found 'frames'");
    OutputParams png = to("a.png");
    png.depth = Depth::float32;
    EXPECT_EQ(error_of(png), "output.depth: expected 8 or 16 in png files, found float");
    OutputParams tif = to("a.tif");
    tif.depth = Depth::half_float;
    EXPECT_EQ(error_of(tif), "output.depth: expected 8, 16 or float in tif files, found half");
    OutputParams exr = to("a.exr");
    exr.depth = Depth::uint8;
    EXPECT_EQ(error_of(exr), "output.depth: expected half or float in exr files, found 8");
    exr.depth = Depth::automatic;
    exr.compression = Compression::lzw;
    EXPECT_EQ(error_of(exr),
              "output.compression: expected zip, zips, piz, dwaa or none in exr files, found lzw");
    tif.depth = Depth::automatic;
    tif.compression = Compression::piz;
    EXPECT_EQ(error_of(tif), "output.compression: expected deflate, lzw or none in tif files, found piz");
    png.depth = Depth::automatic;
    png.compression = Compression::zip;
    EXPECT_EQ(error_of(png), "output.compression: expected auto in png files, found zip");
    png.compression = Compression::automatic;
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

}  // namespace
}  // namespace astrosplat
