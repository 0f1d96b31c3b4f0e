// FITS headers that cannot be, found before CFITSIO sees them; HDUs by name, credits, files without pictures.
#include "source/fits.h"

#include <fitsio.h>
#include <sys/stat.h>

#include "source/picture.h"
#include "support/fits_text.h"
#include "support/test.h"

namespace astrosplat {
namespace {

constexpr long width = 48, height = 20;

/// A tile-compressed picture of 16-bit numbers.
fs::path write_compressed(const fs::path& file, int compression) {
    fitsfile* out = nullptr;
    int status = 0;
    long axes[] = {width, height};
    std::vector<short> values;
    for (int i = 0; i < width * height; ++i) values.push_back(short(i * 7 % 101));
    fits_create_diskfile(&out, file.c_str(), &status);
    fits_set_compression_type(out, compression, &status);
    fits_create_img(out, SHORT_IMG, 2, axes, &status);
    fits_write_img(out, TSHORT, 1, width * height, values.data(), &status);
    fits_close_file(out, &status);
    EXPECT_EQ(status, 0);
    return file;
}

using test::bytes_of;

/// The file with another value in one card: written right-aligned to column 30, as numbers are.
std::string with_value(std::string bytes, const std::string& keyword, const std::string& value) {
    const std::size_t card = bytes.find(fmt::format("{:8}= ", keyword));
    EXPECT_NE(card, std::string::npos) << keyword;
    return bytes.replace(card + 10, 20, fmt::format("{:>20}", value));
}

TEST(FitsCompressed, AllKindsAreRead) {
    const TempFolder folder;
    for (const int compression : {RICE_1, GZIP_1, GZIP_2, HCOMPRESS_1, PLIO_1}) {
        const FitsPlane plane =
            read_fits(write_compressed(folder / fmt::format("{}.fits", compression), compression), "auto", 0);
        ASSERT_EQ(plane.values.size(), std::size_t(width * height));
        EXPECT_EQ(plane.values[(height - 1) * width + 9], 63.0) << compression;  // the bottom row comes last
    }
}

// Each of these ended the process inside CFITSIO 4.2, by SIGABRT, SIGFPE or SIGSEGV.
TEST(FitsCompressed, CardsThatCannotBeAreOneLine) {
    const TempFolder folder;
    const std::string whole = bytes_of(write_compressed(folder / "whole.fits", RICE_1));
    const std::pair<const char*, const char*> wrong[] = {{"ZVAL2", "("},
                                                         {"ZVAL2", "2("},
                                                         {"ZVAL2", "3"},
                                                         {"ZVAL1", "0"},
                                                         {"ZVAL1", "932"},
                                                         {"ZTILE1", "0"},
                                                         {"ZTILE2", "0"},
                                                         {"ZTILE1", "4x"},
                                                         {"ZTILE2", "."},
                                                         {"ZNAXIS", "9"},
                                                         {"ZNAXIS1", "-48"},
                                                         {"ZBITPIX", "-16"},
                                                         {"ZCMPTYPE", "'RAR'"},
                                                         {"ZNAXIS2", "1e9"},
                                                         {"ZTILE1", "99999999999"},
                                                         {"TFIELDS", "140000000000000"},
                                                         {"NAXIS2", "?"},
                                                         {"PCOUNT", "4x"}};
    for (const auto& [keyword, value] : wrong) {
        const fs::path file = folder.file("bad.fits", with_value(whole, keyword, value));
        const std::string message = ERROR_OF(read_fits(file, "auto", 0));
        EXPECT_EQ(message.rfind(fmt::format("{}:HDU 1: expected {} to be ", file.string(), keyword), 0), 0u)
            << message;
        EXPECT_EQ(message.find('\n'), std::string::npos);
        EXPECT_THROW(describe_fits(file), InputError);
        EXPECT_THROW(require_picture(file), InputError);
    }
    std::string flat = whole;
    flat.replace(flat.find("ZNAXIS2 ="), 1, "X");
    EXPECT_EQ(ERROR_OF(read_fits(folder.file("bad.fits", flat), "auto", 0)),
              (folder / "bad.fits").string() + ":HDU 1: expected ZNAXIS2 to be there, found none");
    std::string nameless = whole;
    nameless.replace(whole.find("ZVAL2   ="), 5, "XVAL2");
    EXPECT_EQ(ERROR_OF(read_fits(folder.file("bad.fits", nameless), "auto", 0)),
              (folder / "bad.fits").string() + ":HDU 1: expected ZVAL2 to be there with ZNAME2, found none");
}

TEST(FitsCompressed, AnyWrongByteOfTheDescriptionIsReadOrRefused) {
    const TempFolder folder;
    const std::string whole = bytes_of(write_compressed(folder / "whole.fits", RICE_1));
    const std::size_t header = whole.find("ZIMAGE"), end = whole.find("END     ", header);
    int refused = 0;
    for (std::size_t card = header; card < end; card += 80) {
        if (whole[card] != 'Z') continue;
        for (std::size_t byte = 0; byte < 32; byte += byte < 8 ? 3 : 1)
            for (const char value : {'(', '0', '9', ' ', '.'}) {
                std::string bytes = whole;
                bytes[card + byte] = value;
                try {
                    read_fits(folder.file("bad.fits", bytes), "auto", 0);
                } catch (const InputError&) {
                    ++refused;
                }
            }
    }
    EXPECT_GT(refused, 100);
}

// CFITSIO 4.2 took all memory for some of these.
TEST(FitsCompressed, DamagedGzipTilesAreRefused) {
    const TempFolder folder;
    for (const int compression : {GZIP_1, GZIP_2}) {
        const std::string whole =
            bytes_of(write_compressed(folder / fmt::format("{}.fits", compression), compression));
        const std::size_t tile = whole.find("\x1f\x8b");
        ASSERT_NE(tile, std::string::npos);
        int refused = 0;
        for (std::size_t byte = 0; byte < 60; ++byte) {
            std::string bytes = whole;
            bytes[tile + byte] = char(bytes[tile + byte] ^ 0x15);
            try {
                read_fits(folder.file("bad.fits", bytes), "auto", 0);
            } catch (const InputError& error) {
                ++refused;
                EXPECT_EQ(std::string(error.what()),
                          (folder / "bad.fits").string() +
                              ":tile 1: expected gzip data of at most 384 bytes, found something else");
            }
        }
        EXPECT_GT(refused, 40);  // a byte of the gzip header that is never read does no harm
        EXPECT_THROW(
            read_fits(folder.file("short.fits", std::string(whole).replace(tile, 30, 30, '\0')), "auto", 0),
            InputError);
    }
}

TEST(Fits, CreditIsTheAuthorElseTheOrigin) {
    const TempFolder folder;
    const auto write = [&](const char* name, const std::vector<std::pair<const char*, const char*>>& keys) {
        std::string cards;
        for (const auto& [key, value] : keys) cards += fits_card(fmt::format("{:8}= '{:8}'", key, value));
        return folder.file(name, fits_file(2, 1, cards, [](int x, int) { return 1 + x; }));
    };
    EXPECT_EQ(read_fits(write("a.fits", {{"ORIGIN", "KPNO-IRAF"}}), "auto", 0).credit, "KPNO-IRAF");
    EXPECT_EQ(read_fits(write("b.fits", {{"ORIGIN", "KPNO"}, {"AUTHOR", "A. Nobody"}}), "auto", 0).credit,
              "A. Nobody");
    EXPECT_EQ(read_fits(write("c.fits", {}), "auto", 0).credit, "");
    const fs::path named = write("d.fits", {{"EXTNAME", "Sci Image"}});
    for (const char* hdu : {"Sci Image", "sci image", "SCI IMAGE"})
        EXPECT_EQ(read_fits(named, hdu, 0).width, 2) << hdu;
    EXPECT_THROW(read_fits(named, "sci", 0), InputError);
}

TEST(Fits, AFileOfTablesIsNoPicture) {
    const TempFolder folder;
    const fs::path file = folder / "table.fits";
    fitsfile* out = nullptr;
    int status = 0;
    char name[] = "FLUX", form[] = "E";
    char *names[] = {name}, *forms[] = {form};
    fits_create_diskfile(&out, file.c_str(), &status);
    fits_create_tbl(out, BINARY_TBL, 3, 1, names, forms, nullptr, "EVENTS", &status);
    fits_close_file(out, &status);
    ASSERT_EQ(status, 0);
    EXPECT_EQ(ERROR_OF(require_picture(file)),
              file.string() + ": expected an HDU with a picture, found none in 2 HDUs");
    EXPECT_EQ(describe_fits(file).size(), 2u);
}

TEST(Fits, PipesAreRefusedAndReadingStopsWhenAsked) {
    const TempFolder folder;
    const fs::path pipe = folder / "pipe.fits";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(ERROR_OF(describe_fits(pipe)), pipe.string() + ": cannot be read: it is not a regular file");
    const fs::path file = write_compressed(folder / "a.fits", RICE_1);
    const std::atomic<bool> stop{true};
    EXPECT_THROW(read_fits(file, "auto", 0, Progress{{}, &stop}), Cancelled);
    EXPECT_THROW(describe_fits(file, Progress{{}, &stop}), Cancelled);
}

// A picture of 4x4 with these keys.
std::optional<FitsSky> sky_with(const std::vector<std::pair<const char*, double>>& keys,
                                const char* type = "RA---TAN") {
    const TempFolder folder;
    std::string cards = fits_card(fmt::format("CTYPE1  = '{}'", type)) + fits_card("CTYPE2  = 'DEC--TAN'");
    for (const auto& [key, value] : keys) cards += fits_card(fmt::format("{:8}= {:20.12f}", key, value));
    return read_fits(folder.file("sky.fits", fits_file(4, 4, cards, [](int, int) { return 1; })), "auto", 0)
        .sky;
}

TEST(FitsSky, IsReadFromAllThreeKindsOfKeywords) {
    using Keys = std::vector<std::pair<const char*, double>>;
    const auto with = [](Keys more) {
        more.insert(more.begin(), {{"CRPIX1", 2.5}, {"CRPIX2", 3.5}, {"CRVAL1", 83.8}, {"CRVAL2", -5.4}});
        return more;
    };
    const auto expect_cd = [](const std::optional<FitsSky>& sky, const std::array<double, 4>& cd) {
        ASSERT_TRUE(sky);
        EXPECT_EQ(sky->crpix[1], 3.5);
        EXPECT_EQ(sky->crval[0], 83.8);
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(sky->cd[i], cd[i], 1e-15) << i;
    };
    expect_cd(sky_with(with({{"CD1_1", -0.01}, {"CD1_2", 0.002}, {"CD2_1", 0.003}, {"CD2_2", 0.01}})),
              {-0.01, 0.002, 0.003, 0.01});
    expect_cd(sky_with(with({{"CDELT1", -0.02}, {"CDELT2", 0.01}})), {-0.02, 0.0, 0.0, 0.01});
    expect_cd(sky_with(with({{"CDELT1", -0.02}, {"CDELT2", 0.01}, {"PC1_2", 0.5}, {"PC2_1", -0.25}})),
              {-0.02, -0.01, -0.0025, 0.01});
    const double c = std::sqrt(0.75), s = 0.5;  // AIPS: CD1_2 = -CDELT2 sin, CD2_1 = CDELT1 sin
    expect_cd(sky_with(with({{"CDELT1", -0.02}, {"CDELT2", 0.01}, {"CROTA2", 30.0}})),
              {-0.02 * c, -0.01 * s, -0.02 * s, 0.01 * c});
}

TEST(FitsSky, IsUnknownWithoutItsKeywords) {
    EXPECT_FALSE(sky_with({}));
    const std::vector<std::pair<const char*, double>> place = {
        {"CRPIX1", 2.5}, {"CRPIX2", 3.5}, {"CRVAL1", 83.8}, {"CRVAL2", -5.4}};
    EXPECT_FALSE(sky_with(place));
    auto flat = place, whole = place;
    flat.insert(flat.end(), {{"CD1_1", 0.01}, {"CD1_2", 0.01}, {"CD2_1", 0.01}, {"CD2_2", 0.01}});
    EXPECT_FALSE(sky_with(flat));
    whole.insert(whole.end(), {{"CDELT1", -0.01}, {"CDELT2", 0.01}});
    EXPECT_TRUE(sky_with(whole));
    EXPECT_FALSE(sky_with(whole, "GLON-CAR"));
}

}  // namespace
}  // namespace astrosplat
