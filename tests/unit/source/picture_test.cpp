// Picture files, lookup in them, and pictures that are reduced while they are read.
#include "support/test.h"
// its fmt first: OpenImageIO's copy would turn exceptions off
#include <OpenImageIO/imageio.h>
#include <fitsio.h>
#include <sys/stat.h>

#include "image/resample.h"
#include "source/picture.h"
#include "source/stored_picture.h"
#include "source/texture.h"
#include "source/textured_mesh.h"
#include "source/write_image.h"
#include "support/cube_map.h"

namespace astrosplat {
namespace {

// Picture files as files: which are opened at all, damage, orientation, cube maps, and stopping half way.

using Bytes = std::vector<unsigned char>;

fs::path write_bytes(const fs::path& file, OIIO::ImageSpec spec, const Bytes& pixels) {
    const auto out = OIIO::ImageOutput::create(file.string());
    EXPECT_TRUE(out && out->open(file.string(), spec) && out->write_image(OIIO::TypeUInt8, pixels.data()) &&
                out->close())
        << file;
    return file;
}

Bytes noise(std::size_t count) {
    Bytes bytes;
    for (std::size_t i = 0; i < count; ++i)
        bytes.push_back(static_cast<unsigned char>(i * 37 % 251 + i / 97));
    return bytes;
}

fs::path write_noise(const fs::path& file, int width, int height) {
    return write_bytes(file, OIIO::ImageSpec(width, height, 3, OIIO::TypeUInt8),
                       noise(std::size_t(width * height) * 3));
}

class PictureFileTest : public testing::Test {
  protected:
    const TempFolder folder;
};

TEST_F(PictureFileTest, OnlyFormatsOfTheListAreOpened) {
    const auto error = [](const fs::path& file) {
        const std::string message = ERROR_OF(read_picture(file));
        return message.substr(std::min(message.size(), file.string().size()));
    };
    const std::string other = ": cannot be read as a picture: it is not OpenEXR, TIFF, PNG, JPEG, FITS, ";
    EXPECT_EQ(error(folder.file("x.null", "")).rfind(other, 0), 0u) << error(folder / "x.null");
    EXPECT_EQ(error(folder.file("x.avi", "ffconcat version 1.0\nfile y.png\n")).rfind(other, 0), 0u);
    EXPECT_EQ(error(folder.file("x.toml", "astrosplat = 1\n")).rfind(other, 0), 0u);
    EXPECT_EQ(error(folder / "none.png"), ": cannot be read: No such file or directory");
    ASSERT_EQ(mkfifo((folder / "pipe.png").c_str(), 0600), 0);
    EXPECT_EQ(error(folder / "pipe.png"), ": cannot be read: it is not a regular file");
    EXPECT_EQ(error("/dev/zero"), ": cannot be read: it is not a regular file");
    EXPECT_THROW(require_picture(folder / "x.null"), InputError);
}

TEST_F(PictureFileTest, EveryFormatOfTheListIsReadAlsoUnderAnotherName) {
    for (const char* ending :
         {"exr", "tif", "png", "jpg", "hdr", "dpx", "webp", "gif", "bmp", "tga", "ppm"}) {
        const fs::path file = write_noise(folder / (std::string("a.") + ending), 24, 16);
        const Picture picture = read_picture(file);
        EXPECT_EQ(picture.image.width, 24) << ending;
        EXPECT_EQ(picture.image.height, 16) << ending;
        if (picture.has_alpha()) {
            EXPECT_EQ(picture.image.at(23, 15)[3], 1.0f) << ending;
        }
        EXPECT_NO_THROW(require_picture(file)) << ending;
    }
    fs::copy_file(folder / "a.exr", folder / "b.png");
    EXPECT_EQ(read_picture(folder / "b.png").image.pixels.size(),
              read_picture(folder / "a.exr").image.pixels.size());
}

TEST_F(PictureFileTest, LibrariesPrintNothingOfTheirOwn) {
    for (const char* ending : {"png", "tif", "jpg", "exr", "webp", "gif"}) {
        const fs::path whole = write_noise(folder / (std::string("a.") + ending), 64, 64);
        const auto size = fs::file_size(whole);
        std::string bytes(size, '\0');
        std::ifstream(whole, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(size));
        for (std::size_t i = size / 2; i < size / 2 + 20 && i < size; ++i) bytes[i] = char(bytes[i] ^ 0x55);
        testing::internal::CaptureStderr();
        for (const fs::path& bad :
             {folder.file("bad." + std::string(ending), bytes),
              folder.file("cut." + std::string(ending), bytes.substr(0, size * 3 / 4))}) {
            const std::string message = ERROR_OF(read_picture(bad));
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        }
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << ending;
    }
    EXPECT_NE(ERROR_OF(read_picture(folder / "cut.png")), "no error");
    testing::internal::CaptureStderr();
    std::fputs("others still print\n", stderr);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "others still print\n");
}

TEST_F(PictureFileTest, ADamagedHeaderIsNotBlamedOnTheColours) {
    const fs::path file = folder.file("a.exr", "\x76\x2f\x31\x01 and then nothing of the kind");
    const std::string message = ERROR_OF(read_picture(file));
    EXPECT_EQ(message.rfind(file.string() + ": ", 0), 0u) << message;
    EXPECT_EQ(message.find("resolution"), message.npos) << message;
}

TEST_F(PictureFileTest, ReadingStopsWhenAsked) {
    for (const char* ending : {"png", "exr", "tif", "jpg"}) {
        const fs::path file = write_noise(folder / (std::string("a.") + ending), 256, 2048);
        std::atomic<bool> stop{false};
        const Progress progress{[&](double fraction) { stop = stop || fraction > 0.0; }, &stop};
        EXPECT_THROW(read_picture(file, progress), Cancelled) << ending;
    }
}

// TIFF 6.0: the tag says on which side the picture's first row and its first column are to be seen.
struct Sides {
    int tag;
    bool rows_are_columns, first_row_last, first_column_last;
};
constexpr Sides sides[] = {{1, false, false, false}, {2, false, false, true}, {3, false, true, true},
                           {4, false, true, false},  {5, true, false, false}, {6, true, true, false},
                           {7, true, true, true},    {8, true, false, true}};

TEST(Orientation, EachOfTheEightIsTurnedUpright) {
    const TempFolder folder;
    constexpr int width = 3, height = 2;
    const auto seen = [](int x, int y) { return static_cast<unsigned char>(10 * (y * width + x) + 5); };
    for (const Sides& s : sides) {
        const int rows = s.rows_are_columns ? width : height, columns = s.rows_are_columns ? height : width;
        Bytes stored;
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) {
                const int r = s.first_row_last ? rows - 1 - row : row;
                const int c = s.first_column_last ? columns - 1 - column : column;
                const unsigned char value = s.rows_are_columns ? seen(r, c) : seen(c, r);
                stored.insert(stored.end(), 3, value);
            }
        OIIO::ImageSpec spec(columns, rows, 3, OIIO::TypeUInt8);
        spec.attribute("Orientation", s.tag);
        const fs::path file = write_bytes(folder / fmt::format("{}.tif", s.tag), spec, stored);
        const Said said;
        const Image image = read_picture(file).image;
        ASSERT_EQ(image.width, width) << s.tag;
        ASSERT_EQ(image.height, height) << s.tag;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                EXPECT_FLOAT_EQ(image.at(x, y)[0], float(seen(x, y)) / 255.0f)
                    << s.tag << " " << x << " " << y;
        EXPECT_EQ(said.lines.size(), s.tag == 1 ? 0u : 1u) << s.tag;
    }
}

TEST(Orientation, OfAJpegAndInWords) {
    const TempFolder folder;
    OIIO::ImageSpec spec(32, 16, 3, OIIO::TypeUInt8);
    spec.attribute("Orientation", 6);
    const fs::path file = write_bytes(folder / "a.jpg", spec, noise(32 * 16 * 3));
    const Said said;
    EXPECT_EQ(load_linear_image(file).height, 32);
    EXPECT_EQ(said.text(), file.string() + ": turned by 90 degrees clockwise, as its orientation 6 says\n");
    spec.attribute("Orientation", 9);
    const std::vector<std::string> warnings = warnings_of(
        [&] { EXPECT_EQ(read_picture(write_bytes(file, spec, noise(32 * 16 * 3))).image.width, 32); });
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_HAS(warnings[0], "its orientation 9 is none of 1 to 8 and is not followed");
}

TEST(CubeMap, AllSixFacesOfAnExrAreRead) {
    const TempFolder folder;
    const fs::path file = folder / "sky.exr";
    write_cube_map(file, 4, [](int x, int y) { return float(4 * y + x); });
    const std::vector<Image> faces = load_environment_pictures(file, 1);
    ASSERT_EQ(faces.size(), 6u);
    for (std::size_t face = 0; face < 6; ++face) {
        ASSERT_EQ(faces[face].width, 6);
        ASSERT_EQ(faces[face].height, 6);
        EXPECT_EQ(faces[face].at(1, 1)[0], float(16 * face));
        EXPECT_EQ(faces[face].at(4, 4)[2], float(16 * face + 15));
    }
    EXPECT_EQ(load_environment_pictures(write_noise(folder / "a.png", 4, 24), 0).size(), 1u);
}

// A picture made in memory is the file that a reader takes.

TEST(PngBytes, AreAFileWithTheseValues) {
    const TempFolder folder;
    std::vector<unsigned char> rgb;
    for (int i = 0; i < 19 * 7 * 3; ++i) rgb.push_back(static_cast<unsigned char>(i * 37));
    const std::string png = png_bytes(19, 7, rgb);
    const Image read = load_raw_image(folder.file("memory.png", png));
    ASSERT_EQ(read.width, 19);
    ASSERT_EQ(read.height, 7);
    for (std::size_t i = 0; i < rgb.size(); ++i) ASSERT_NEAR(read.pixels[i] * 255.0f, rgb[i], 1e-3) << i;
    EXPECT_EQ(png_bytes(19, 7, rgb), png) << "no time, no chance";
}

// Lookup on pictures of a few texels whose filtered values can be worked out by hand.

using Filter = TextureSettings::Filter;
using Wrap = TextureSettings::Wrap;

// Opaque gray texels, row by row from the top.
Texture gray(std::int64_t width, std::int64_t height, const std::vector<float>& values) {
    Texture texture;
    texture.image = make_image(width, height, 4, 1.0f);
    for (std::size_t i = 0; i < values.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) texture.image.pixels[4 * i + c] = values[i];
    return texture;
}

TEST(Sample, TexelCentresAndOrientation) {
    Texture texture = gray(3, 2, {1, 2, 3, 4, 5, 6});  // 1 2 3 is the top row, v towards 1
    for (const Filter filter : {Filter::nearest, Filter::bilinear, Filter::area}) {
        texture.filter = filter;
        EXPECT_FLOAT_EQ(sample(texture, {0.5f / 3, 0.75f}).color.x, 1.0f);
        EXPECT_FLOAT_EQ(sample(texture, {2.5f / 3, 0.75f}).color.x, 3.0f);
        EXPECT_FLOAT_EQ(sample(texture, {0.5f / 3, 0.25f}).color.x, 4.0f);
        EXPECT_FLOAT_EQ(sample(texture, {2.5f / 3, 0.25f}).color.x, 6.0f);
    }
}

TEST(Sample, BilinearBetweenCentres) {
    const Texture texture = gray(2, 2, {0, 1, 2, 3});
    EXPECT_FLOAT_EQ(sample(texture, {0.5f, 0.5f}).color.x, 1.5f);
    EXPECT_FLOAT_EQ(sample(texture, {0.375f, 0.75f}).color.x, 0.25f);
    EXPECT_FLOAT_EQ(sample(texture, {0.25f, 0.625f}).color.x, 0.5f);
}

TEST(Sample, WrapModesAtAndBeyondTheEdge) {
    Texture texture = gray(2, 1, {1, 3});
    texture.wrap = Wrap::clamp;
    EXPECT_EQ(sample(texture, {0.0f, 0.5f}).color.x, 1.0f);
    EXPECT_EQ(sample(texture, {5.0f, -3.0f}).color.x, 3.0f);
    texture.wrap = Wrap::repeat;
    EXPECT_EQ(sample(texture, {0.0f, 0.5f}).color.x, 2.0f);
    EXPECT_EQ(sample(texture, {-0.75f, 7.5f}).color.x, 1.0f);
    EXPECT_EQ(sample(texture, {1.75f, 0.5f}).color.x, 3.0f);
    texture.wrap = Wrap::black;
    const TextureSample edge = sample(texture, {0.0f, 0.5f});
    EXPECT_EQ(edge.alpha, 0.5f);
    EXPECT_EQ(edge.color.x, 1.0f);  // straight: half a texel of colour over half its alpha
    EXPECT_EQ(sample(texture, {1.5f, 0.5f}).alpha, 0.0f);
}

TEST(Sample, FiltersPremultipliedAndDividesAfterwards) {
    Texture texture = gray(2, 1, {1, 0});
    texture.image.at(1, 0)[3] = 0.0f;  // an empty neighbour must not darken
    const TextureSample middle = sample(texture, {0.5f, 0.5f});
    EXPECT_EQ(middle.alpha, 0.5f);
    EXPECT_EQ(middle.color, glm::vec3(1.0f));
    const TextureSample empty = sample(texture, {0.75f, 0.5f});
    EXPECT_EQ(empty.alpha, 0.0f);
    EXPECT_EQ(empty.color, glm::vec3(0.0f));
}

TEST(Sample, AreaIsTheExactBoxMean) {
    Texture texture = gray(4, 1, {0, 4, 8, 100});
    texture.filter = Filter::area;
    EXPECT_FLOAT_EQ(sample(texture, {0.375f, 0.5f}, {2.0f, 1.0f}).color.x, 4.0f);  // 0.25 0 + 0.5 4 + 0.25 8
    EXPECT_FLOAT_EQ(sample(texture, {0.375f, 0.5f}, {0.0f, 0.0f}).color.x, 4.0f);  // at least one texel
    EXPECT_FLOAT_EQ(sample(texture, {0.5f, 0.5f}, {4.0f, 1.0f}).color.x, 28.0f);   // all
    EXPECT_FLOAT_EQ(sample(texture, {0.5f, 0.5f}, {1e9f, 1e9f}).color.x,
                    28.0f);  // never more than the picture
}

TEST(Sample, PlacesThatAreNoNumbersAreEmpty) {
    const Texture texture = gray(2, 1, {1, 3});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(sample(texture, {nan, 0.5f}).alpha, 0.0f);
    EXPECT_EQ(sample(texture, {0.5f, std::numeric_limits<float>::infinity()}).alpha, 0.0f);
    EXPECT_EQ(sample(texture, {3e38f, -3e38f}).alpha, 1.0f);
}

TEST(Relief, LiftsTheBrightSideAndKeepsThePlane) {
    std::vector<float> values(64 * 32, 0.0f);
    for (std::size_t y = 0; y < 32; ++y)
        for (std::size_t x = 48; x < 64; ++x) values[y * 64 + x] = 1.0f;
    const Mesh mesh = relief_mesh(gray(64, 32, values), 0.15);
    EXPECT_EQ(mesh.positions.size(), 257u * 129u);
    const Bounds box = bounds(mesh);
    EXPECT_EQ(box.extent().x, 10.0);
    EXPECT_EQ(box.extent().z, 5.0);
    EXPECT_NEAR(box.hi.y, 1.5, 1e-6);
    EXPECT_NEAR(box.lo.y, 0.0, 1e-6);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3 p = mesh.positions[i];
        ASSERT_NEAR(mesh.uvs[i].x, p.x / 10.0f + 0.5f, 1e-6f);
        ASSERT_NEAR(mesh.uvs[i].y, 0.5f - p.z / 5.0f, 1e-6f);
        ASSERT_TRUE(p.x < 4.0f || p.y > 1.4f) << i;
        ASSERT_TRUE(p.x > 1.0f || p.y < 0.1f) << i;
    }
}

TEST(Relief, IsAsHighForADarkPicture) {
    std::vector<float> bright(16 * 16), dark(16 * 16);
    for (std::size_t i = 0; i < bright.size(); ++i) {
        bright[i] = float(i % 16) / 16.0f;
        dark[i] = bright[i] / 1024.0f;
    }
    const Mesh a = relief_mesh(gray(16, 16, bright), 0.15), b = relief_mesh(gray(16, 16, dark), 0.15);
    EXPECT_NEAR(bounds(a).hi.y, 1.5, 1e-6);
    EXPECT_NEAR(bounds(b).hi.y, 1.5, 1e-6);
}

TEST(Relief, CoversThePlaneOnceFacingUp) {
    const Mesh mesh = relief_mesh(gray(8, 4, std::vector<float>(32, 0.5f)), 0.15);
    double area = 0.0;
    for (const Mesh::Triangle& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.position[0]]), b(mesh.positions[t.position[1]]),
            c(mesh.positions[t.position[2]]);
        const double up = glm::cross(b - a, c - a).y;
        ASSERT_GT(up, 0.0);
        area += up * 0.5;
    }
    EXPECT_NEAR(area, 10.0 * 5.0, 1e-4);
}

// Pictures that are reduced while they are read: the same bits as of those that are reduced afterwards.

constexpr int tall_width = 300, tall_height = 10000;  // more than one band of rows
constexpr std::int64_t few_texels = 200'000;

float value_at(int x, int y, int c) { return float((x * 37 + y * 101 + c * 7 + x * y) % 97) / 97.0f; }

struct WrittenRows {
    const char* name;
    int channels;
    OIIO::TypeDesc type;
    int tile = 0;   // px a side; 0: rows
    int up = 0;     // px that the data window begins above the display window
    int strip = 0;  // rows of TIFF's
};

fs::path write_rows(const fs::path& file, const WrittenRows& what) {
    OIIO::ImageSpec spec(tall_width, tall_height, what.channels, what.type);
    spec.tile_width = spec.tile_height = what.tile;
    spec.y = -what.up;
    spec.attribute("compression", what.type == OIIO::TypeHalf ? "zips" : "none");
    spec.attribute("png:compressionLevel", 1);
    if (what.strip > 0) spec.attribute("tiff:RowsPerStrip", what.strip);
    std::vector<float> pixels;
    for (int y = 0; y < tall_height; ++y)
        for (int x = 0; x < tall_width; ++x)
            for (int c = 0; c < what.channels; ++c) pixels.push_back(value_at(x, y, c));
    const auto out = OIIO::ImageOutput::create(file.string());
    EXPECT_TRUE(out && out->open(file.string(), spec) && out->write_image(OIIO::TypeFloat, pixels.data()) &&
                out->close())
        << file;
    return file;
}

// As OpenImageIO gives it at once.
std::vector<float> at_once(const fs::path& file) {
    OIIO::ImageSpec as_stored;
    as_stored.attribute("oiio:UnassociatedAlpha", 1);
    const auto in = OIIO::ImageInput::open(file.string(), &as_stored);
    std::vector<float> pixels(std::size_t(tall_width) * tall_height * in->spec().nchannels);
    EXPECT_TRUE(in->read_image(0, 0, 0, -1, OIIO::TypeFloat, pixels.data()));
    return pixels;
}

Image reduced_afterwards(const Image& image) {
    const ImageSize size = size_of_area(image.width, image.height, double(few_texels), 1.0);
    return reduced_by_area(image, size.width, size.height);
}

PictureReaders reducing() {
    PictureReaders readers;
    readers.most_texels = few_texels;
    return readers;
}

void expect_same_bits(const std::vector<fs::path>& files, const TextureSettings& settings = {}) {
    const Image whole = load_texture(files, settings, Wrap::clamp).image;
    const Texture few = load_texture(files, settings, Wrap::clamp, {}, reducing());
    EXPECT_EQ(few.file_width, tall_width);
    EXPECT_EQ(few.file_height, tall_height);
    EXPECT_LT(few.image.width * few.image.height, few_texels * 101 / 100);
    EXPECT_EQ(few.image.pixels, reduced_afterwards(whole).pixels) << files[0];
}

TEST(PictureRows, OfEveryKindOfFileAreReducedToTheSameBits) {
    const TempFolder folder;
    for (const WrittenRows& what :
         {WrittenRows{"a.jpg", 3, OIIO::TypeUInt8}, WrittenRows{"a.png", 4, OIIO::TypeUInt16},
          WrittenRows{"rows.tif", 3, OIIO::TypeUInt8, 0, 0, 7},
          WrittenRows{"one.tif", 3, OIIO::TypeUInt8, 0, 0, tall_height},
          WrittenRows{"tiles.tif", 3, OIIO::TypeUInt16, 64}, WrittenRows{"rows.exr", 4, OIIO::TypeHalf},
          WrittenRows{"tiles.exr", 3, OIIO::TypeHalf, 64},
          WrittenRows{"window.exr", 3, OIIO::TypeHalf, 0, 30}}) {
        const fs::path file = write_rows(folder / what.name, what);
        expect_same_bits({file});
        if (what.up == 0) {
            const Picture picture = read_picture(file);
            EXPECT_TRUE(std::ranges::equal(picture.image.pixels, at_once(file))) << file;
        }
    }
    expect_same_bits({folder / "a.jpg", folder / "a.png", folder / "tiles.exr"});
}

// An EXR file of one pixel that is said to be a part of a picture so large.
fs::path one_pixel_of(const fs::path& file, int width, int height) {
    OIIO::ImageSpec spec(1, 1, 3, OIIO::TypeHalf);
    spec.full_width = width;
    spec.full_height = height;
    const float pixel[] = {0.5f, 0.5f, 0.5f};
    const auto out = OIIO::ImageOutput::create(file.string());
    EXPECT_TRUE(out->open(file.string(), spec) && out->write_image(OIIO::TypeFloat, pixel) && out->close());
    return file;
}

// The size is judged by the header alone, before anything is read or taken.
TEST(PictureRows, OfAWindowThatHoldsNextToNothingAreRefused) {
    const TempFolder folder;
    const fs::path file = one_pixel_of(folder / "a.exr", 60000, 60000);
    const std::string message =
        file.string() +
        ":display window: expected at most 268435456 px for the 1x1 px that it has, found 60000x60000 px";
    EXPECT_EQ(ERROR_OF(open_picture_rows(file)), message);
    EXPECT_EQ(ERROR_OF(require_picture(file)), message);
    EXPECT_EQ(open_picture_rows(one_pixel_of(folder / "b.exr", 16384, 16384)).rows.height, 16384)
        << "as a crop of a large frame";
}

TEST(PictureRows, OfSmallPicturesAreNotReduced) {
    const TempFolder folder;
    const fs::path file = folder.file("a.ppm", "P6\n40 30\n255\n" + std::string(40 * 30 * 3, 'x'));
    PictureReaders readers;
    readers.most_texels = 10;
    const Texture texture = load_texture({file}, {}, Wrap::clamp, {}, readers);
    EXPECT_EQ(texture.image.width, 40);
    EXPECT_EQ(texture.file_width, 0);
}

TEST(PictureRows, OfOneColumnBecomeFewer) {
    for (const std::int64_t rows : {1, 2, 7, 1000}) {
        Image image = make_image(3, 1000, 2);
        for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = std::sin(float(i));
        std::int64_t next = 0;
        ImageRows from = rows_of(image);
        from.read = [&, read = from.read](std::int64_t begin, std::int64_t end, float* out) {
            EXPECT_EQ(begin, next);  // each once
            next = end;
            read(begin, end, out);
        };
        EXPECT_EQ(reduced_by_area(from, 1, rows).pixels, reduced_by_area(image, 1, rows).pixels) << rows;
        EXPECT_EQ(next, 1000);
    }
}

fs::path write_float_fits(const fs::path& file, int compression) {
    fitsfile* out = nullptr;
    int status = 0;
    long axes[] = {60, 45};
    std::vector<float> values;
    for (int i = 0; i < 60 * 45; ++i) values.push_back(std::sin(float(i * i)) - 0.3f);
    values[700] = std::numeric_limits<float>::quiet_NaN();
    fits_create_diskfile(&out, file.c_str(), &status);
    fits_set_compression_type(out, compression, &status);
    fits_set_quantize_level(out, 0.0f, &status);
    fits_create_img(out, FLOAT_IMG, 2, axes, &status);
    fits_write_img(out, TFLOAT, 1, std::ssize(values), values.data(), &status);
    fits_close_file(out, &status);
    EXPECT_EQ(status, 0);
    return file;
}

TEST(PictureRows, OfFitsThatIsNotHeldAreTheSame) {
    const TempFolder folder;
    for (const int compression : {0, GZIP_1}) {
        const fs::path file = write_float_fits(folder / fmt::format("{}.fits", compression), compression);
        for (const bool set : {false, true}) {
            TextureSettings settings;
            if (set) settings.black = -0.5;
            if (set) settings.white = 0.4;
            const Stored whole = read_stored(file, settings, {});
            const StoredRows rows = open_stored(file, settings, {}, 0);
            EXPECT_EQ(rows.stored.picture.summary, whole.picture.summary);
            EXPECT_EQ(rows.stored.display_values, whole.display_values);
            Image read = unfilled_image(60, 45, 3);
            for (std::int64_t y = 0; y < 45; y += 7)
                rows.rows.read(y, std::min<std::int64_t>(45, y + 7), read.at(0, y));
            for (std::size_t i = 0; i < read.pixels.size(); ++i)
                ASSERT_TRUE(read.pixels[i] == whole.picture.image.pixels[i] ||
                            (std::isnan(read.pixels[i]) && std::isnan(whole.picture.image.pixels[i])))
                    << i;
        }
    }
}

TEST(PictureRows, PercentilesOfPartsAreThoseOfSortedValues) {
    std::vector<double> values, finite;
    for (int i = 0; i < 20011; ++i)
        values.push_back((i % 5 == 0 ? -1e-300 : 1.0) * std::exp(30.0 * std::sin(i)) -
                         (i % 3 == 0 ? 1.5 : 0.0));
    values.insert(values.end(), 100, values[3]);
    values.push_back(std::numeric_limits<double>::infinity());
    values.push_back(-0.0);
    values.push_back(std::numeric_limits<double>::quiet_NaN());
    std::ranges::copy_if(values, std::back_inserter(finite), [](double v) { return std::isfinite(v); });
    std::ranges::sort(finite);
    const auto rank = [&](double fraction) {
        const double at = fraction * double(finite.size() - 1);
        const auto below = std::size_t(at);
        return finite[below] + (finite[below + 1] - finite[below]) * (at - std::floor(at));
    };
    const ValueRange range = value_range([&](const ValueTaker& take) {
        const std::span<const double> all(values);
        take(all.first(777));
        take({});
        take(all.subspan(777));
    });
    EXPECT_EQ(range.min, finite.front());
    EXPECT_EQ(range.max, finite.back());
    EXPECT_EQ(range.black, rank(0.0025));
    EXPECT_EQ(range.white, rank(0.9975));
    EXPECT_EQ(value_range(values).white, range.white);
}

}  // namespace
}  // namespace astrosplat
