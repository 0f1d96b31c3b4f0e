// Picture files as files: which are opened at all, damage, orientation, cube maps, and stopping half way.
#include "source/picture.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
// fmt first: OpenImageIO's copy of it would turn exceptions off.
#include <OpenImageIO/imageio.h>
#include <sys/stat.h>

#include <atomic>
#include <cstring>
#include <fstream>
#include <iterator>

#include "core/error.h"
#include "core/log.h"
#include "source/texture.h"
#include "support/cube_map.h"
#include "support/errors.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;
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
                       noise(static_cast<std::size_t>(width * height) * 3));
}

TEST(PictureFile, OnlyFormatsOfTheListAreOpened) {
    const TempFolder folder;
    const auto error = [](const fs::path& file) {
        const std::string message = message_of<InputError>([&] { read_picture(file); });
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

TEST(PictureFile, EveryFormatOfTheListIsReadAlsoUnderAnotherName) {
    const TempFolder folder;
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

TEST(PictureFile, LibrariesPrintNothingOfTheirOwn) {
    const TempFolder folder;
    for (const char* ending : {"png", "tif", "jpg", "exr", "webp", "gif"}) {
        const fs::path whole = write_noise(folder / (std::string("a.") + ending), 64, 64);
        const auto size = fs::file_size(whole);
        std::string bytes(size, '\0');
        std::ifstream(whole, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(size));
        for (std::size_t i = size / 2; i < size / 2 + 20 && i < size; ++i)
            bytes[i] = static_cast<char>(bytes[i] ^ 0x55);
        testing::internal::CaptureStderr();
        for (const fs::path& bad :
             {folder.file("bad." + std::string(ending), bytes),
              folder.file("cut." + std::string(ending), bytes.substr(0, size * 3 / 4))}) {
            const std::string message = message_of<InputError>([&] { read_picture(bad); });
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        }
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << ending;
    }
    EXPECT_NE(message_of<InputError>([&] { read_picture(folder / "cut.png"); }), "no error");
    testing::internal::CaptureStderr();
    std::fputs("others still print\n", stderr);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "others still print\n");
}

TEST(PictureFile, ADamagedHeaderIsNotBlamedOnTheColours) {
    const TempFolder folder;
    const fs::path file = folder.file("a.exr", "\x76\x2f\x31\x01 and then nothing of the kind");
    const std::string message = message_of<InputError>([&] { read_picture(file); });
    EXPECT_EQ(message.rfind(file.string() + ": ", 0), 0u) << message;
    EXPECT_EQ(message.find("resolution"), message.npos) << message;
}

TEST(PictureFile, ReadingStopsWhenAsked) {
    const TempFolder folder;
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
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                const int r = s.first_row_last ? rows - 1 - row : row;
                const int c = s.first_column_last ? columns - 1 - column : column;
                const unsigned char value = s.rows_are_columns ? seen(r, c) : seen(c, r);
                stored.insert(stored.end(), 3, value);
            }
        }
        OIIO::ImageSpec spec(columns, rows, 3, OIIO::TypeUInt8);
        spec.attribute("Orientation", s.tag);
        const fs::path file = write_bytes(folder / fmt::format("{}.tif", s.tag), spec, stored);
        std::vector<std::string> lines;
        set_log_sink([&](LogLevel, const std::string& line) { lines.push_back(line); });
        const Image image = read_picture(file).image;
        set_log_sink(nullptr);
        ASSERT_EQ(image.width, width) << s.tag;
        ASSERT_EQ(image.height, height) << s.tag;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                EXPECT_FLOAT_EQ(image.at(x, y)[0], static_cast<float>(seen(x, y)) / 255.0f)
                    << s.tag << " " << x << " " << y;
        EXPECT_EQ(lines.size(), s.tag == 1 ? 0u : 1u) << s.tag;
    }
}

TEST(Orientation, OfAJpegAndInWords) {
    const TempFolder folder;
    OIIO::ImageSpec spec(32, 16, 3, OIIO::TypeUInt8);
    spec.attribute("Orientation", 6);
    const fs::path file = write_bytes(folder / "a.jpg", spec, noise(32 * 16 * 3));
    std::string said;
    set_log_sink([&](LogLevel, const std::string& line) { said = line; });
    EXPECT_EQ(load_linear_image(file).height, 32);
    set_log_sink(nullptr);
    EXPECT_EQ(said, file.string() + ": turned by 90 degrees clockwise, as its orientation 6 says");
}

TEST(CubeMap, AllSixFacesOfAnExrAreRead) {
    const TempFolder folder;
    const fs::path file = folder / "sky.exr";
    write_cube_map(file, 4, [](int x, int y) { return static_cast<float>(4 * y + x); });
    const std::vector<Image> faces = load_environment_pictures(file, 1);
    ASSERT_EQ(faces.size(), 6u);
    for (std::size_t face = 0; face < 6; ++face) {
        ASSERT_EQ(faces[face].width, 6);
        ASSERT_EQ(faces[face].height, 6);
        EXPECT_EQ(faces[face].at(1, 1)[0], static_cast<float>(16 * face));
        EXPECT_EQ(faces[face].at(4, 4)[2], static_cast<float>(16 * face + 15));
    }
    EXPECT_EQ(load_environment_pictures(write_noise(folder / "a.png", 4, 24), 0).size(), 1u);
}

}  // namespace
}  // namespace astrosplat
