// Settings of a format that go together, and the text that a frame carries.
#include <gtest/gtest.h>

#include "core/text.h"
#include "output/format.h"
#include "output/metadata.h"
#include "support/errors.h"

namespace astrosplat {
namespace {

// Which settings go together, and each message where they do not.

using Depth = OutputParams::Depth;
using Compression = OutputParams::Compression;
using Alpha = OutputParams::Alpha;
using View = OutputParams::View;

OutputParams to(const char* path) {
    OutputParams output;
    output.path = path;
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
