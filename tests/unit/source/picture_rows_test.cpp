// Pictures that are reduced while they are read: the same bits as of those that are reduced afterwards.
#include <fmt/format.h>
#include <gtest/gtest.h>
// fmt first: OpenImageIO's copy of it would turn exceptions off.
#include <OpenImageIO/imageio.h>
#include <fitsio.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "image/resample.h"
#include "source/picture.h"
#include "source/stored_picture.h"
#include "source/texture.h"
#include "support/errors.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;
using Wrap = TextureSettings::Wrap;

constexpr int tall_width = 300, tall_height = 10000;  // more than one band of rows
constexpr std::int64_t few_texels = 200'000;

float value_at(int x, int y, int c) {
    return static_cast<float>((x * 37 + y * 101 + c * 7 + x * y) % 97) / 97.0f;
}

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
    std::vector<float> pixels(static_cast<std::size_t>(tall_width) * tall_height * in->spec().nchannels);
    EXPECT_TRUE(in->read_image(0, 0, 0, -1, OIIO::TypeFloat, pixels.data()));
    return pixels;
}

Image reduced_afterwards(const Image& image) {
    const ImageSize size = size_of_area(image.width, image.height, static_cast<double>(few_texels), 1.0);
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
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            image.pixels[i] = std::sin(static_cast<float>(i));
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
    for (int i = 0; i < 60 * 45; ++i) values.push_back(std::sin(static_cast<float>(i * i)) - 0.3f);
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
        const double at = fraction * static_cast<double>(finite.size() - 1);
        const auto below = static_cast<std::size_t>(at);
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
