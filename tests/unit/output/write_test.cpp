// Frame files written and read back: pixels, channels, windows, header, errors.
#include "output/write.h"
#include "output/metadata.h"

#include "support/test.h"
// its fmt first: OpenImageIO's copy has other settings
#include <OpenImageIO/imageio.h>

#include "core/color.h"
#include "output/format.h"
#include "source/write_image.h"

namespace astrosplat {
namespace {

using Alpha = OutputParams::Alpha;
using Compression = OutputParams::Compression;
using Depth = OutputParams::Depth;

/// The numbers as stored, without OpenImageIO's conversions, and the header.
struct RawFile {
    OIIO::ImageSpec spec;
    std::vector<float> values;  // interleaved; integers as 0..1

    float at(int x, int y, const std::string& channel) const {
        int c = spec.channelindex(channel);
        EXPECT_GE(c, 0) << channel;
        return values[std::size_t((y * spec.width + x) * spec.nchannels + c)];
    }
    int code(int x, int y, const std::string& channel, float largest) const {
        return int(std::lround(at(x, y, channel) * largest));
    }
};

RawFile read_raw(const fs::path& file) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    auto in = OIIO::ImageInput::open(file.string(), &config);
    EXPECT_TRUE(in) << OIIO::geterror();
    RawFile raw{in->spec(), {}};
    raw.values.resize(raw.spec.image_pixels() * std::size_t(raw.spec.nchannels));
    EXPECT_TRUE(in->read_image(0, 0, 0, raw.spec.nchannels, OIIO::TypeDesc::FLOAT, raw.values.data()));
    return raw;
}

/// Of the frame and of its pixels.
std::pair<std::string, std::string> hashes_of(const fs::path& file) {
    const FrameHeader header = read_frame_header(file);
    return {header.frame_hash, header.pixel_hash};
}

using test::bytes_of;

// Soft orange on nothing, brighter than 1 in the lower half.
RenderedFrame soft_frame(std::int64_t width, std::int64_t height) {
    RenderedFrame frame;
    frame.beauty = make_image(width, height, 4);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x) {
            float a = float(x) / float(width - 1), light = 2 * y < height ? 1.0f : 3.0f;
            float* p = frame.beauty.at(x, y);
            p[0] = 0.8f * a * light, p[1] = 0.4f * a * light, p[2] = 0.1f * a, p[3] = a;
        }
    frame.depth = make_image(width, height, 1, 123456.789f);
    frame.coverage = make_image(width, height, 1, 0.5f);
    frame.count = make_image(width, height, 1, 100001.0f);
    frame.layers = {frame.beauty, make_image(width, height, 4, 0.25f)};
    return frame;
}

// Pixels that no compression makes small.
RenderedFrame noisy_frame(std::int64_t size) {
    RenderedFrame frame;
    frame.beauty = make_image(size, size, 4, 1.0f);
    for (std::size_t i = 0; i < frame.beauty.pixels.size(); ++i)
        frame.beauty.pixels[i] = float((i * 2654435761u) % 1009) / 1009.0f;
    return frame;
}

OutputParams of_depth(Depth depth) {
    OutputParams output;
    output.depth = depth;
    return output;
}

class WriteTest : public testing::Test {
  protected:
    WriteTest() {
        metadata_.frame = 12;
        metadata_.fps = 23.976;
        metadata_.frame_hash = std::string(64, 'a');
        metadata_.pixel_hash = std::string(64, 'b');
        metadata_.seed = 4000000000u;
        metadata_.provenance = {"Orion\nfrom the side", "NASA/ESA", "Artwork"};
    }
    ~WriteTest() override { fs::permissions(folder_.path(), fs::perms::owner_all); }

    fs::path write(const std::string& name, const OutputParams& output, const RenderedFrame& frame) {
        fs::path file = folder_ / name;
        write_frame({file, output, frame.beauty.width, frame.beauty.height, {}, {"stars", "dust"}}, frame,
                    metadata_);
        return file;
    }

    TempFolder folder_;
    FrameMetadata metadata_;
};

TEST_F(WriteTest, FloatExrHoldsTheExactLight) {
    OutputParams output = of_depth(Depth::float32);
    RenderedFrame frame = soft_frame(9, 6);
    for (Compression c : {Compression::zip, Compression::zips, Compression::piz, Compression::none}) {
        output.compression = c;
        RawFile raw = read_raw(write("a.exr", output, frame));
        ASSERT_EQ(raw.spec.nchannels, 4);
        for (int y = 0; y < 6; ++y)
            for (int x = 0; x < 9; ++x)
                for (int k = 0; k < 4; ++k)
                    ASSERT_EQ(raw.at(x, y, std::string(1, "RGBA"[k])), frame.beauty.at(x, y)[k]);
    }
}

TEST_F(WriteTest, ExrSaysItsPrimariesAndHoldsLightInThem) {
    // Rows of the published matrix from Rec. 709 to ACEScg.
    const float acescg[3][3] = {{0.613097f, 0.339523f, 0.047379f},
                                {0.070194f, 0.916354f, 0.013452f},
                                {0.020616f, 0.109570f, 0.869815f}};
    OutputParams output = of_depth(Depth::float32);
    output.aovs = {"depth", "coverage", "count", "layers"};
    const RenderedFrame frame = soft_frame(9, 6);
    const RawFile plain = read_raw(write("a.exr", output, frame));
    output.primaries = OutputParams::Primaries::acescg;
    const RawFile wide = read_raw(write("b.exr", output, frame));
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 9; ++x) {
            for (const std::string layer : {"", "stars.", "dust."})
                for (int k = 0; k < 3; ++k) {
                    float expected = 0.0f;
                    for (int c = 0; c < 3; ++c) expected += acescg[k][c] * plain.at(x, y, layer + "RGB"[c]);
                    ASSERT_NEAR(wide.at(x, y, layer + "RGB"[k]), expected, 5e-6f) << layer;
                }
            for (const char* same : {"A", "stars.A", "dust.A", "Z", "coverage", "count"})
                ASSERT_EQ(wide.at(x, y, same), plain.at(x, y, same)) << same;
        }
    const auto stored = [](const RawFile& raw) {
        const OIIO::ParamValue* value =
            raw.spec.find_attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8));
        std::vector<float> all;
        for (int i = 0; value && i < 8; ++i) all.push_back(value->get_float_indexed(i));
        return all;
    };
    EXPECT_EQ(stored(plain), (std::vector{0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f}));
    EXPECT_EQ(stored(wide),
              (std::vector{0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f}));
}

TEST_F(WriteTest, HalfExrRoundsAndStaysFinite) {
    RenderedFrame frame = soft_frame(4, 4);
    frame.beauty.at(0, 0)[0] = 1e9f;
    frame.beauty.at(1, 0)[0] = 0.5f;
    RawFile raw = read_raw(write("a.exr", {}, frame));
    EXPECT_EQ(raw.at(0, 0, "R"), 65504.0f);
    EXPECT_EQ(raw.at(1, 0, "R"), 0.5f);
    EXPECT_EQ(raw.spec.channelformat(0), OIIO::TypeDesc(OIIO::TypeDesc::HALF));
}

TEST_F(WriteTest, DwaaIsWrittenToo) {
    OutputParams output;
    output.compression = Compression::dwaa;
    RenderedFrame frame = soft_frame(64, 64);
    const fs::path file = write("a.exr", output, frame);
    RawFile raw = read_raw(file);
    EXPECT_EQ(raw.spec.get_string_attribute("compression"), "dwaa");
    EXPECT_HAS(bytes_of(file), "dwaCompressionLevel");
    EXPECT_NEAR(raw.at(40, 10, "R"), frame.beauty.at(40, 10)[0], 0.02f);
}

TEST_F(WriteTest, ExtraChannelsHaveTheirNamesAndPrecision) {
    OutputParams output;
    output.aovs = {"layers", "count", "depth", "coverage"};
    RawFile raw = read_raw(write("a.exr", output, soft_frame(5, 3)));
    std::map<std::string, OIIO::TypeDesc> types;
    for (int c = 0; c < raw.spec.nchannels; ++c)
        types[raw.spec.channelnames[std::size_t(c)]] = raw.spec.channelformat(c);
    const OIIO::TypeDesc half(OIIO::TypeDesc::HALF), full(OIIO::TypeDesc::FLOAT);
    const std::map<std::string, OIIO::TypeDesc> expected = {
        {"R", half},        {"G", half},      {"B", half},       {"A", half},       {"Z", full},
        {"coverage", half}, {"count", full},  {"stars.R", half}, {"stars.G", half}, {"stars.B", half},
        {"stars.A", half},  {"dust.R", half}, {"dust.G", half},  {"dust.B", half},  {"dust.A", half}};
    EXPECT_EQ(types, expected);
    EXPECT_EQ(raw.at(2, 1, "Z"), 123456.789f);
    EXPECT_EQ(raw.at(2, 1, "count"), 100001.0f);
    EXPECT_EQ(raw.at(2, 1, "coverage"), 0.5f);
    EXPECT_EQ(raw.at(2, 1, "stars.A"), 0.5f);
    EXPECT_EQ(raw.at(2, 1, "dust.B"), 0.25f);
}

TEST_F(WriteTest, TallFramesAreWrittenInBands) {
    OutputParams output = of_depth(Depth::float32);
    constexpr std::int64_t height = 2100;  // more than an EXR's band, and than a TIFF's group of strips
    RenderedFrame frame = soft_frame(3, height);
    for (std::int64_t y = 0; y < height; ++y) frame.beauty.at(1, y)[0] = float(y);
    for (const char* name : {"a.exr", "a.tif"}) {
        RawFile raw = read_raw(write(name, output, frame));
        for (int y = 0; y < height; ++y) ASSERT_EQ(raw.at(1, y, "R"), float(y)) << name;
    }
}

TEST_F(WriteTest, RegionIsTheDataWindowOfExrAndACropElsewhere) {
    RenderedFrame frame = soft_frame(8, 4);
    for (const char* name : {"a.exr", "a.png"})
        write_frame({folder_ / name, {}, 100, 50, {30, 20, 8, 4}}, frame, metadata_);
    OIIO::ImageSpec exr = read_raw(folder_ / "a.exr").spec, png = read_raw(folder_ / "a.png").spec;
    EXPECT_EQ(exr.x, 30);
    EXPECT_EQ(exr.y, 20);
    EXPECT_EQ(exr.width, 8);
    EXPECT_EQ(exr.full_x, 0);
    EXPECT_EQ(exr.full_width, 100);
    EXPECT_EQ(exr.full_height, 50);
    EXPECT_EQ(png.width, 8);
    EXPECT_EQ(png.full_width, 8);
    EXPECT_TRUE(frame_is_whole(folder_ / "a.exr"));
}

TEST_F(WriteTest, RegionOfADitheredFileEqualsTheCropOfTheWhole) {
    RenderedFrame whole = soft_frame(40, 20), part;
    part.beauty = make_image(10, 5, 4);
    for (std::int64_t y = 0; y < 5; ++y) std::copy_n(whole.beauty.at(17, y + 6), 40, part.beauty.at(0, y));
    RawFile all = read_raw(write("whole.png", {}, whole));
    write_frame({folder_ / "part.png", {}, 40, 20, {17, 6, 10, 5}}, part, metadata_);
    RawFile some = read_raw(folder_ / "part.png");
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 10; ++x) EXPECT_EQ(some.at(x, y, "G"), all.at(x + 17, y + 6, "G"));
}

TEST_F(WriteTest, PngWithoutAlphaIsOpaqueOverBlack) {
    RenderedFrame frame = soft_frame(5, 2);
    OutputParams output = of_depth(Depth::uint16);
    RawFile raw = read_raw(write("a.png", output, frame));
    EXPECT_EQ(raw.spec.nchannels, 3);
    EXPECT_EQ(raw.code(2, 0, "R", 65535), std::lround(65535 * real::linear_to_srgb(0.4)));
    EXPECT_EQ(raw.code(0, 0, "R", 65535), 0);
}

TEST_F(WriteTest, StraightPngKeepsTheColourOfSoftEdges) {
    RenderedFrame frame = soft_frame(101, 2);
    OutputParams output = of_depth(Depth::uint16);
    output.alpha = Alpha::straight;
    RawFile raw = read_raw(write("a.png", output, frame));
    for (int x = 1; x < 101; ++x) {
        EXPECT_NEAR(raw.code(x, 0, "R", 65535), 65535 * real::linear_to_srgb(0.8), 1.0) << x;
        EXPECT_NEAR(raw.code(x, 0, "B", 65535), 65535 * real::linear_to_srgb(0.1), 1.0) << x;
        EXPECT_EQ(raw.code(x, 0, "A", 65535), std::lround(655.35 * x));
    }
    EXPECT_EQ(raw.at(0, 0, "A"), 0.0f);
}

TEST_F(WriteTest, PremultipliedPixelsSurviveEveryIntegerFormat) {
    RenderedFrame frame = soft_frame(51, 2);
    OutputParams output = of_depth(Depth::uint16);
    output.alpha = Alpha::premultiplied;
    for (const char* name : {"a.png", "a.tif"}) {
        RawFile raw = read_raw(write(name, output, frame));
        for (int x = 0; x < 51; ++x)
            EXPECT_NEAR(raw.code(x, 0, "G", 65535), 65535 * real::linear_to_srgb(0.4) * x / 50.0, 1.0)
                << name << x;
    }
}

TEST_F(WriteTest, TiffSaysWhatItsAlphaIs) {
    OutputParams output = of_depth(Depth::uint8);
    RenderedFrame frame = soft_frame(5, 2);
    EXPECT_EQ(read_raw(write("p.tif", output, frame)).spec.get_int_attribute("tiff:UnassociatedAlpha", 0), 0);
    output.alpha = Alpha::straight;
    EXPECT_EQ(read_raw(write("s.tif", output, frame)).spec.get_int_attribute("tiff:UnassociatedAlpha", 0), 1);
    output.alpha = Alpha::none;
    EXPECT_EQ(read_raw(write("n.tif", output, frame)).spec.nchannels, 3);
}

TEST_F(WriteTest, TiffHoldsItsCodesInEveryCompression) {
    RenderedFrame frame = soft_frame(33, 8);
    for (Depth depth : {Depth::uint8, Depth::uint16, Depth::float32})
        for (Compression c : {Compression::deflate, Compression::lzw, Compression::none}) {
            OutputParams output = of_depth(depth);
            output.compression = c;
            RawFile raw = read_raw(write("a.tiff", output, frame));
            const char* name = c == Compression::deflate ? "zip" : (c == Compression::lzw ? "lzw" : "none");
            EXPECT_EQ(raw.spec.get_string_attribute("compression"), name);
            if (depth == Depth::float32) {
                EXPECT_EQ(raw.at(20, 6, "R"), frame.beauty.at(20, 6)[0]);  // 1.5: light, no view
                continue;
            }
            double value = real::linear_to_srgb(0.8) * 20.0 / 32.0,
                   codes = depth == Depth::uint8 ? 255 : 65535;
            EXPECT_NEAR(raw.at(20, 0, "R") * codes, value * codes, 1.0);
        }
}

TEST_F(WriteTest, ExrHeaderHoldsProvenanceAndGeometryButNoClock) {
    CameraParams camera;
    camera.position = glm::dvec3(1, 2, 3);
    metadata_.matrices = exr_matrices(make_camera(camera, 5, 3, {}), 5, 3);
    metadata_.origin = "gas: measured: light";
    const fs::path file = write("a.exr", {}, soft_frame(5, 3));
    OIIO::ImageSpec spec = read_raw(file).spec;
    EXPECT_EQ(spec.get_string_attribute("astrosplat/version").substr(0, 2), "0.");
    EXPECT_EQ(spec.get_string_attribute("astrosplat/frameHash"), metadata_.frame_hash);
    EXPECT_EQ(spec.get_string_attribute("astrosplat/pixelHash"), metadata_.pixel_hash);
    EXPECT_EQ(spec.get_string_attribute("astrosplat/seed"), "4000000000");
    EXPECT_EQ(spec.get_string_attribute("astrosplat/frame"), "12");
    EXPECT_EQ(spec.get_string_attribute("astrosplat/title"), "Orion from the side");
    EXPECT_EQ(spec.get_string_attribute("astrosplat/credit"), "NASA/ESA");
    EXPECT_EQ(spec.get_string_attribute("astrosplat/type"), "Artwork");
    EXPECT_EQ(spec.get_string_attribute("astrosplat/origin"), "gas: measured: light");
    const OIIO::ParamValue* fps = spec.find_attribute("framesPerSecond", OIIO::TypeRational);
    ASSERT_TRUE(fps);
    EXPECT_EQ(fps->get<int>(0), 24000);
    EXPECT_EQ(fps->get<int>(1), 1001);
    for (const char* matrix : {"worldToCamera", "worldToNDC"}) {
        const OIIO::ParamValue* value = spec.find_attribute(matrix, OIIO::TypeMatrix44);
        ASSERT_TRUE(value) << matrix;
        const bool ndc = matrix == std::string("worldToNDC");
        const float* expected = ndc ? metadata_.matrices->world_to_ndc : metadata_.matrices->world_to_camera;
        for (int i = 0; i < 16; ++i) EXPECT_EQ(static_cast<const float*>(value->data())[i], expected[i]);
    }
    const OIIO::ParamValue* primaries = spec.find_attribute("chromaticities");
    ASSERT_TRUE(primaries);
    EXPECT_EQ(static_cast<const float*>(primaries->data())[6], 0.3127f);
    EXPECT_EQ(spec.get_string_attribute("DateTime"), "");
    EXPECT_EQ(spec.get_string_attribute("Software"), "");
    EXPECT_EQ(spec.get_string_attribute("HostComputer"), "");
    // The attribute's name as OpenEXR spells it, not OpenImageIO's.
    const std::string bytes = bytes_of(file);
    for (const char* name : {"framesPerSecond", "worldToCamera", "worldToNDC", "chromaticities"})
        EXPECT_HAS(bytes, std::string(name) + '\0');
}

TEST_F(WriteTest, FfmpegReadsExrWithLongTexts) {
    if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not installed";
    const std::string ffmpeg =
        "ffmpeg -nostdin -v error -xerror -i '" + (folder_ / "a.exr").string() + "' -f null - 2>&1";
    for (std::size_t length : {255, 256, 320, 384, 448, 512, 576, 640, 704, 768, 832, 896, 960, 1024, 4856}) {
        metadata_.provenance.credit = std::string(length, 'c');
        const fs::path file = write("a.exr", {}, soft_frame(5, 3));
        EXPECT_EQ(std::system(ffmpeg.c_str()), 0) << "a text of " << length << " bytes";
        const std::string credit = read_raw(file).spec.get_string_attribute("astrosplat/credit");
        EXPECT_EQ(credit.substr(0, length), metadata_.provenance.credit);
        EXPECT_EQ(credit.find_first_not_of(' ', length), std::string::npos);
        EXPECT_EQ(hashes_of(file), std::make_pair(metadata_.frame_hash, metadata_.pixel_hash));
    }
}

TEST_F(WriteTest, EveryFormatTellsItsHashes) {
    RenderedFrame frame = soft_frame(5, 3);
    for (const char* name : {"a.exr", "a.tif", "a.png"}) {
        const fs::path file = write(name, {}, frame);
        EXPECT_EQ(hashes_of(file), std::make_pair(metadata_.frame_hash, metadata_.pixel_hash)) << name;
        EXPECT_TRUE(frame_is_whole(file)) << name;
        EXPECT_EQ(read_raw(file).spec.get_string_attribute("DateTime"), "") << name;
    }
    std::ofstream(folder_ / "text.exr") << "no picture";
    for (const char* name : {"text.exr", "missing.png"}) {
        EXPECT_EQ(hashes_of(folder_ / name), std::make_pair(std::string(), std::string()));
        EXPECT_FALSE(frame_is_whole(folder_ / name));
    }
}

TEST_F(WriteTest, TextsBeyondAsciiAreKept) {
    metadata_.provenance.credit = "Überschau, Sternwarte Zürich";
    for (const char* name : {"a.exr", "a.tif", "a.png"}) {
        const OIIO::ImageSpec spec = read_raw(write(name, {}, soft_frame(5, 3))).spec;
        EXPECT_EQ(spec.get_string_attribute("Copyright"), metadata_.provenance.credit) << name;
    }
    const std::string png = bytes_of(folder_ / "a.png");
    EXPECT_HAS(png, "iTXtCopyright") << "tEXt would be Latin 1";
    EXPECT_HAS(png, "tEXtastrosplat/frame");
}

TEST_F(WriteTest, EveryFormatHoldsAPacket) {
    metadata_.sources.names = {"M 51"};
    metadata_.sources.degrees_per_px = 1e-5;
    metadata_.sources.north_angle = 12.0;
    metadata_.sources.sky_position = {1.0, 2.0};
    for (const char* name : {"a.exr", "a.tif", "a.png"}) {
        const fs::path file = write(name, {}, soft_frame(5, 3));
        const ObjectMetadata said = read_xmp_metadata(file);
        EXPECT_EQ(said.names, metadata_.sources.names) << name;
        EXPECT_EQ(said.title, "Orion from the side");
        EXPECT_EQ(said.credit, "NASA/ESA");
        EXPECT_EQ(said.type, "Artwork");
        EXPECT_FALSE(said.degrees_per_px || said.north_angle || said.sky_position);
    }
    EXPECT_HAS(bytes_of(folder_ / "a.png"), std::string("iTXtXML:com.adobe.xmp\0\0\0\0\0<?xpacket", 35));
}

TEST_F(WriteTest, TruncatedFilesAreNotWhole) {
    const RenderedFrame frame = noisy_frame(64);
    for (const char* name : {"a.exr", "a.tif", "a.png"}) {
        const fs::path file = write(name, {}, frame);
        const std::uintmax_t size = fs::file_size(file);
        for (std::uintmax_t kept : {size - 200, size / 2, std::uintmax_t{20}, std::uintmax_t{0}}) {
            fs::resize_file(file, kept);
            EXPECT_FALSE(frame_is_whole(file)) << name << " " << kept;
            write(name, {}, frame);
        }
    }
}

TEST_F(WriteTest, FoldersAreMadeAndNothingElseIsLeft) {
    const fs::path file = write("deep/er/a.exr", {}, soft_frame(5, 3));
    EXPECT_TRUE(frame_is_whole(file));
    int files = 0;
    for (const auto& entry : fs::directory_iterator(file.parent_path()))
        files += entry.path() == file ? 1 : 10;
    EXPECT_EQ(files, 1);
}

TEST_F(WriteTest, UnwritablePlacesAreOneLine) {
    folder_.file("plain", "a file, not a folder");
    const std::string line = message_of<OutputError>([&] { write("plain/a.exr", {}, soft_frame(2, 2)); });
    EXPECT_HAS(line, "plain/a.exr: its folder cannot be made: ");
    EXPECT_EQ(line.find('\n'), std::string::npos);
    fs::create_directories(folder_ / "folder.exr");
    EXPECT_THROW(write("folder.exr", {}, soft_frame(2, 2)), OutputError);
}

TEST_F(WriteTest, AFullDiskIsAnErrorInEveryFormatAndKeepsTheOldFrame) {
    const RenderedFrame frame = noisy_frame(128);
    for (const char* name : {"a.png", "a.tif", "a.exr"}) {
        const fs::path file = write(name, {}, frame);
        const std::string before = bytes_of(file);
        // Where the disk fills up: within the header, the pixels, and the very last bytes.
        for (const std::size_t room :
             {std::size_t{0}, std::size_t{100}, before.size() / 2, before.size() - 1}) {
            const FileLimit full(room);
            testing::internal::CaptureStderr();
            const std::string message = message_of<OutputError>([&] { write(name, {}, frame); });
            EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "a library's own line";
            EXPECT_EQ(message, file.string() + ": cannot be written: File too large") << room;
        }
        EXPECT_TRUE(bytes_of(file) == before) << name;
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 3) << "temporary files stayed";
}

TEST_F(WriteTest, AFullDiskIsAnErrorForScreenshotsToo) {
    std::vector<unsigned char> rgba(128 * 128 * 4);
    for (std::size_t i = 0; i < rgba.size(); ++i)
        rgba[i] = static_cast<unsigned char>((i * 2654435761u) >> 13);
    const fs::path file = folder_ / "shot.png";
    write_image(file, 128, 128, rgba);
    const std::string before = bytes_of(file);
    {
        const FileLimit full(before.size() / 2);
        EXPECT_THROW(write_image(file, 128, 128, rgba), OutputError);
    }
    EXPECT_TRUE(bytes_of(file) == before);
}

TEST_F(WriteTest, FramesThatAppearedMeanwhileAreKept) {
    const RenderedFrame frame = soft_frame(4, 4);
    for (const char* name : {"a.png", "a.exr"}) {
        std::ofstream(folder_ / name) << "another program's";
        EXPECT_THROW(write_frame({folder_ / name, {}, 4, 4, {}, {}, Existing::keep}, frame, metadata_),
                     AlreadyExists);
        EXPECT_EQ(bytes_of(folder_ / name), "another program's");
    }
}

TEST_F(WriteTest, ReadOnlyFoldersAreOneLine) {
    if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere: a read-only folder cannot be tested";
    fs::permissions(folder_.path(), fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_THROW(write("a.exr", {}, soft_frame(2, 2)), OutputError);
}

TEST_F(WriteTest, ValuesThatAreNotFiniteAreNeverWritten) {
    RenderedFrame frame = soft_frame(4, 4);
    frame.beauty.at(2, 1)[1] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(write("a.exr", {}, frame), std::logic_error);
    EXPECT_FALSE(fs::exists(folder_ / "a.exr"));
    frame = soft_frame(4, 4);
    frame.depth.pixels[3] = std::numeric_limits<float>::infinity();
    OutputParams output;
    EXPECT_NO_THROW(write("a.exr", output, frame));  // not asked for
    output.aovs = {"depth"};
    EXPECT_THROW(write("b.exr", output, frame), std::logic_error);
    frame = soft_frame(4, 4);
    frame.coverage.pixels[3] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NO_THROW(write("c.exr", output, frame));
    output.aovs = {"coverage"};
    EXPECT_THROW(write("d.exr", output, frame), std::logic_error);
}

TEST(PixelHash, IsTheHashOfTheFloatsBytes) {
    Image image = make_image(1, 1, 4, 0.0f);
    // sha256 of sixteen zero bytes
    EXPECT_EQ(pixel_hash(image), "374708fff7719dd5979ec875d56cd2286f6d3cf7ec317a3b25632aab28ec37bb");
    image.pixels[0] = -0.0f;
    EXPECT_NE(pixel_hash(image), "374708fff7719dd5979ec875d56cd2286f6d3cf7ec317a3b25632aab28ec37bb");
}

TEST(Metadata, FramesPerSecondBecomeFractions) {
    struct {
        double fps;
        int n, d;
    } cases[] = {{24, 24, 1},   {23.976, 24000, 1001}, {29.97, 30000, 1001}, {59.94, 60000, 1001},
                 {12.5, 25, 2}, {25, 25, 1},           {60, 60, 1},          {23.976023976, 24000, 1001}};
    for (const auto& c : cases) {
        EXPECT_EQ(rational_fps(c.fps).numerator, c.n) << c.fps;
        EXPECT_EQ(rational_fps(c.fps).denominator, c.d) << c.fps;
    }
}

TEST(Metadata, LinesAreFoundByTheirWholeKey) {
    const std::string lines = metadata_lines({{"a", "1"}, {"ab", "2=3"}, {"c", ""}});
    EXPECT_EQ(lines, "a=1\nab=2=3\nc=\n");
    const std::map<std::string, std::string> entries{{"a", "1"}, {"ab", "2=3"}, {"c", ""}};
    EXPECT_EQ(parse_metadata_lines(lines), entries);
    EXPECT_TRUE(parse_metadata_lines("").empty());
    EXPECT_TRUE(parse_metadata_lines("another program's words\n").empty());
}

}  // namespace
}  // namespace astrosplat
