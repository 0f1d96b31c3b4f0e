// FITS headers that cannot be, found before CFITSIO sees them; HDUs by name, credits, files without pictures.
#include "source/fits.h"

#include <bzlib.h>
#include <fitsio.h>
#include <sys/stat.h>

#include <map>

#include "source/picture.h"
#include "source/stored_picture.h"
#include "support/fits_text.h"
#include "support/quiet.h"
#include "support/test.h"

namespace astrosplat {
namespace {

constexpr long width = 48, height = 20;

/// A tile-compressed picture of 16-bit numbers; `cards` are added to its header.
fs::path write_compressed(const fs::path& file, int compression, const std::vector<std::string>& cards = {},
                          bool was_extension = false) {
    fitsfile* out = nullptr;
    int status = 0;
    long axes[] = {width, height};
    std::vector<short> values;
    for (int i = 0; i < width * height; ++i) values.push_back(short(i * 7 % 101));
    fits_create_diskfile(&out, file.c_str(), &status);
    fits_set_compression_type(out, compression, &status);
    fits_create_img(out, SHORT_IMG, 2, axes, &status);
    for (const std::string& card : cards) fits_write_record(out, card.c_str(), &status);
    if (was_extension) {
        fits_delete_key(out, "ZSIMPLE", &status);
        fits_write_record(out, "ZTENSION= 'IMAGE   '", &status);
    }
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

// CFITSIO opens it, and writes beyond its own room for them.
TEST(Fits, MoreAxesThanThereCanBeAreRefused) {
    const TempFolder folder;
    std::string text = fits_card("SIMPLE  =                    T") +
                       fits_card("BITPIX  =                    8") +
                       fits_card("NAXIS   =                  999");
    for (int i = 1; i <= 999; ++i) text += fits_card(fmt::format("NAXIS{:<3}=                    1", i));
    text += fits_card("END");
    text.resize((text.size() + 2879) / 2880 * 2880 + 2880, ' ');
    EXPECT_HAS(ERROR_OF(read_fits(folder.file("a.fits", text), "auto", {})),
               "a.fits:HDU 0: expected NAXIS to be at most 99, found 999");
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
    EXPECT_THROW(read_fits(file, "auto", {}, Progress{{}, &stop}), Cancelled);
    EXPECT_THROW(describe_fits(file, Progress{{}, &stop}), Cancelled);
}

// Of several pictures in one file the one that shows most is taken, or a line says which.

std::vector<double> values_of(const FitsPlane& plane) { return {plane.values.begin(), plane.values.end()}; }

TEST(FitsPictures, ThreePlanesAreColours) {
    const TempFolder folder;
    std::vector<float> planes, pixels;
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < 20; ++i) planes.push_back(float(100 * c + i));
    for (int i = 0; i < 20; ++i)
        for (int c = 0; c < 3; ++c) pixels.push_back(float(100 * c + i));
    const auto is_colour = [&](const std::vector<int>& axes, const std::vector<float>& values,
                               const std::string& cards) {
        const FitsPlane plane = read_fits(folder.file("a.fits", fits_hdu(axes, cards, values)), "auto", {});
        if (plane.channels != 3) return false;
        EXPECT_EQ(plane.width, 5);
        EXPECT_EQ(plane.height, 4);
        EXPECT_EQ(values_of(plane)[0], 15.0) << "the last row of the file is on top";
        EXPECT_EQ(values_of(plane)[1], 115.0);
        EXPECT_EQ(values_of(plane)[59], 204.0);
        return true;
    };
    EXPECT_TRUE(is_colour({5, 4, 3}, planes, ""));
    EXPECT_TRUE(is_colour({5, 4, 3, 1}, planes, fits_card("CTYPE3  = 'RGB     '")));
    EXPECT_TRUE(is_colour({3, 5, 4}, pixels, ""));
    for (const char* other : {"FREQ", "VELO-LSR", "STOKES", "WAVE-TAB"})
        EXPECT_FALSE(is_colour({5, 4, 3}, planes, fits_card(fmt::format("CTYPE3  = '{}'", other)))) << other;
    const fs::path file = folder.file("b.fits", fits_hdu({5, 4, 3}, "", planes));
    EXPECT_EQ(values_of(read_fits(file, "auto", 2))[0], 215.0);
    EXPECT_EQ(values_of(read_fits(folder.file("c.fits", fits_hdu({3, 5, 4}, "", pixels)), "auto", 1))[0],
              115.0);
    TextureSettings settings;  // one curve for all three
    settings.black = 0.0;
    settings.white = 300.0;
    settings.stretch = TextureSettings::Stretch::linear;
    settings.colorspace = TextureSettings::Colorspace::linear;
    const Image whole = read_stored(file, settings, {}).picture.image;
    EXPECT_FLOAT_EQ(whole.at(0, 0)[1], 115.0f / 300.0f);
    const StoredRows rows = open_stored(file, settings, {}, 8);  // not held
    EXPECT_EQ(read_whole(rows.rows).pixels, whole.pixels);
}

TEST(FitsPictures, WhatIsBlankOrNoPictureIsPassedBy) {
    const TempFolder folder;
    std::vector<float> planes(80, std::numeric_limits<float>::quiet_NaN());
    for (int i = 20; i < 80; ++i) planes[i] = i < 40 ? 7.0f : float(i);
    const fs::path cube = folder.file("cube.fits", fits_hdu({5, 4, 4}, "", planes));
    FitsPlane plane;
    std::vector<std::string> said = warnings_of([&] { plane = read_fits(cube, "auto", {}); });
    EXPECT_EQ(plane.values[15], 40.0);
    EXPECT_EQ(said, std::vector<std::string>{
                        cube.string() + ": it has 4 planes; plane 2 is taken, the first that is not blank "
                                        "(plane = N takes another)"});
    EXPECT_EQ(warnings_of([&] { plane = read_fits(cube, "auto", 3); }).size(), 0u);
    const auto named = [](const char* name) { return fits_card(fmt::format("EXTNAME = '{:8}'", name)); };
    const std::vector<float> some{1, 2, 3, 4}, blank(4, 5.0f);
    const auto taken = [&](const std::string& bytes) {
        said = warnings_of([&] { plane = read_fits(folder.file("x.fits", bytes), "auto", {}); });
        return plane.hdu;
    };
    EXPECT_EQ(taken(fits_hdu({2, 2}, named("DQ"), some) + fits_hdu({2, 2}, named("SCI"), blank, false)), 1);
    EXPECT_TRUE(said.empty());
    EXPECT_EQ(taken(fits_hdu({2, 2}, named("WHT"), some) + fits_hdu({2, 2}, named("B"), blank, false) +
                    fits_hdu({2, 2}, named("R"), some, false)),
              2);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_HAS(said[0], "3 HDUs hold pictures; HDU 2 R is taken");
    EXPECT_EQ(taken(fits_hdu({2, 2}, named("DQ"), some)), 0) << "better than none";
    EXPECT_EQ(taken(fits_hdu({2, 2}, named("SCI"), some) + fits_hdu({2, 2}, named("SCI"), some, false)), 0);
    ASSERT_EQ(said.size(), 1u) << "of cameras of two chips";
    EXPECT_HAS(said[0], "2 HDUs hold pictures; HDU 0 SCI is taken");
}

TEST(FitsPictures, RowsAndMosaicsOfCameras) {
    const TempFolder folder;
    const auto read = [&](const std::string& cards, const std::vector<float>& values, int width, int height) {
        return read_fits(folder.file("a.fits", fits_hdu({width, height}, cards, values)), "auto", {});
    };
    const std::string down = fits_card("ROWORDER= 'TOP-DOWN'"), up = fits_card("ROWORDER= 'BOTTOM-UP'");
    EXPECT_EQ(values_of(read(down, {1, 2, 3, 4}, 2, 2)), (std::vector<double>{1, 2, 3, 4}));
    EXPECT_EQ(values_of(read(up, {1, 2, 3, 4}, 2, 2)), (std::vector<double>{3, 4, 1, 2}));
    // A plane of each colour, seen through the mosaic: what is bilinear comes back as it was.
    const auto light = [](int c, int x, int y) { return 10.0f * float(c + 1) + float(x) + 2.0f * float(y); };
    const auto mosaic = [&](const char* letters, bool from_top) {
        std::vector<float> values;
        for (int row = 0; row < 8; ++row)
            for (int x = 0; x < 6; ++x) {
                const int y = from_top ? row : 7 - row;  // from the top
                const char letter = letters[2 * (y % 2) + x % 2];
                values.push_back(light(letter == 'R' ? 0 : letter == 'G' ? 1 : 2, x, y));
            }
        return values;
    };
    for (const char* letters : {"RGGB", "BGGR", "GRBG", "GBRG"})
        for (const bool from_top : {true, false}) {
            const char* const key = from_top ? "BAYERPAT" : "COLORTYP";
            const std::string pattern = fits_card(fmt::format("{}= '{}    '", key, letters));
            const FitsPlane plane = read(pattern + (from_top ? down : up), mosaic(letters, from_top), 6, 8);
            ASSERT_EQ(plane.channels, 3);
            for (int y = 1; y < 7; ++y)
                for (int x = 1; x < 5; ++x)
                    for (int c = 0; c < 3; ++c)
                        EXPECT_EQ(plane.values[3 * (6 * y + x) + c], light(c, x, y)) << letters << from_top;
        }
    const std::string shifted = fits_card("BAYERPAT= 'BGGR    '") +
                                fits_card("XBAYROFF=                    1") +
                                fits_card("YBAYROFF=                    1") + down;
    EXPECT_EQ(read(shifted, mosaic("RGGB", true), 6, 8).values[3 * 7], light(0, 1, 1));
    EXPECT_EQ(read(fits_card("COLORTYP= 'MONO    '"), {1, 2, 3, 4}, 2, 2).channels, 1);
    const std::vector<std::string> said = warnings_of([&] {
        EXPECT_EQ(read(fits_card("BAYERPAT= 'TRUE    '"), {1, 2, 3, 4}, 2, 2).channels, 1);
    });
    ASSERT_EQ(said.size(), 1u);
    EXPECT_HAS(said[0], "BAYERPAT = 'TRUE' is not followed");
}

// How the sky lies on a picture; where nothing else is said, of these cards.
using SkyCards = std::vector<std::pair<const char*, std::string>>;
const SkyCards tangent_plane = {{"CTYPE1", "'RA---TAN'"}, {"CTYPE2", "'DEC--TAN'"}, {"CRVAL1", "83.8"},
                                {"CRVAL2", "-5.4"},       {"CRPIX1", "120.5"},      {"CRPIX2", "100.5"}};
const SkyCards square_px = {{"CD1_1", "-0.001388888888888889"}, {"CD2_2", "0.001388888888888889"}};
const SkyCards scales = {{"CDELT1", "-0.001388888888888889"}, {"CDELT2", "0.001388888888888889"}};

FitsSky sky_with(const SkyCards& own, const SkyCards& pixels = square_px, bool top_down = false) {
    std::map<std::string, std::string> cards;
    for (const SkyCards* some : {&tangent_plane, &pixels, &own})
        for (const auto& [key, value] : *some) cards[key] = value;
    std::string text;
    for (const auto& [key, value] : cards) text += fits_card(fmt::format("{:8}= {:>20}", key, value));
    if (top_down) text += fits_card("ROWORDER= 'TOP-DOWN'");
    const TempFolder folder;
    return read_fits(folder.file("sky.fits", fits_file(4, 200, text, [](int, int) { return 1; })), "auto", {})
        .sky;
}

// Right ascension and declination (ICRS) of the pixel (41, 31), by astropy 5.2.
TEST(FitsSky, IsWhatAstropyReads) {
    struct Case {
        const char* what;
        SkyCards cards, pixels;
        glm::dvec2 sky;
    };
    const SkyCards cases_pc = {{"CDELT1", "-0.001388888888888889"}, {"CDELT2", "0.001388888888888889"},
                               {"PC01_01", "0.877582562"},          {"PC01_02", "-0.479425539"},
                               {"PC02_01", "0.479425539"},          {"PC02_02", "0.877582562"}};
    const auto types = [](const std::string& name) {
        return SkyCards{{"CTYPE1", "'RA---" + name + "'"}, {"CTYPE2", "'DEC--" + name + "'"}};
    };
    const Case cases[] = {
        {"SIP",
         {{"CTYPE1", "'RA---TAN-SIP'"},
          {"CTYPE2", "'DEC--TAN-SIP'"},
          {"A_ORDER", "2"},
          {"B_ORDER", "2"},
          {"A_2_0", "8E-4"},
          {"A_0_2", "-5E-4"},
          {"A_1_1", "3E-4"},
          {"B_2_0", "-4E-4"},
          {"B_0_2", "6E-4"},
          {"B_1_1", "2E-4"}},
         square_px,
         {83.90492816, -5.49446978}},
        {"SCAMP",
         {{"PV1_0", "0.0"},
          {"PV1_1", "1.0"},
          {"PV1_4", "0.3"},
          {"PV1_5", "-0.2"},
          {"PV2_0", "0.0"},
          {"PV2_1", "1.0"},
          {"PV2_4", "-0.25"},
          {"PV2_7", "0.15"}},
         square_px,
         {83.91674280, -5.49898065}},
        {"LONPOLE", {{"LONPOLE", "150.0"}}, square_px, {83.94453541, -5.42837000}},
        {"SIN", types("SIN"), square_px, {83.91092677, -5.49651776}},
        {"ZEA", types("ZEA"), square_px, {83.91092668, -5.49651769}},
        {"CAR", types("CAR"), square_px, {83.91092655, -5.49651772}},
        {"AIT", types("AIT"), square_px, {83.91092667, -5.49651772}},
        {"small letters",
         {{"CTYPE1", "'ra---tan'"}, {"CTYPE2", "'dec--tan'"}},
         square_px,
         {83.91092641, -5.49651745}},
        {"galactic",
         {{"CTYPE1", "'GLON-TAN'"},
          {"CTYPE2", "'GLAT-TAN'"},
          {"CRVAL1", "209.011607779684"},
          {"CRVAL2", "-19.405229985210"}},
         square_px,
         {83.76368265, -5.54213514}},
        {"ecliptic",
         {{"CTYPE1", "'ELON-TAN'"},
          {"CTYPE2", "'ELAT-TAN'"},
          {"CRVAL1", "82.959833242331"},
          {"CRVAL2", "-28.687888542961"}},
         square_px,
         {83.91554113, -5.49099359}},
        {"FK4",
         {{"RADESYS", "'FK4'"},
          {"EQUINOX", "1950.0"},
          {"CRVAL1", "83.185652334882"},
          {"CRVAL2", "-5.431567002280"}},
         square_px,
         {83.91045488, -5.49705182}},
        {"1950",
         {{"EQUINOX", "1950.0"}, {"CRVAL1", "83.185652334882"}, {"CRVAL2", "-5.431567002280"}},
         square_px,
         {83.91045488, -5.49705182}},
        {"FK5 of 2015",
         {{"RADESYS", "'FK5'"},
          {"EQUINOX", "2015.5"},
          {"CRVAL1", "83.990491004167"},
          {"CRVAL2", "-5.390829817084"}},
         square_px,
         {83.91107212, -5.49635122}},
        {"axes swapped",
         {{"CTYPE1", "'DEC--TAN'"}, {"CTYPE2", "'RA---TAN'"}, {"CRVAL1", "-5.4"}, {"CRVAL2", "83.8"}},
         {{"CD1_1", "0.001388888888888889"}, {"CD2_2", "-0.001388888888888889"}},
         {83.89697565, -5.51040869}},
        {"arc seconds",
         {{"CUNIT1", "'arcsec'"}, {"CUNIT2", "'arcsec'"}, {"CRVAL1", "301680.0"}, {"CRVAL2", "-19440.0"}},
         {{"CD1_1", "-5.0"}, {"CD2_2", "5.0"}},
         {83.91092641, -5.49651745}},
        {"CROTA2", {{"CROTA2", "30.0"}}, scales, {83.94453541, -5.42837000}},
        {"PC01_01", {}, cases_pc, {83.85085906, -5.53764523}},
    };
    for (const Case& c : cases) {
        const FitsSky sky = sky_with(c.cards, c.pixels);
        ASSERT_TRUE(sky.grid) << c.what << ": " << sky.unfollowed;
        std::array places{glm::dvec2(41.0, 31.0)};
        sky.grid->to_sky(places);
        constexpr double tolerance = 0.03 * 5.0 / 3600.0;  // of a pixel; 0.1 is asked for
        EXPECT_NEAR(places[0].x, c.sky.x, tolerance) << c.what;
        EXPECT_NEAR(places[0].y, c.sky.y, tolerance) << c.what;
        sky.grid->to_pixels(places);
        EXPECT_NEAR(places[0].x, 41.0, 1e-3) << c.what;
        EXPECT_NEAR(places[0].y, 31.0, 1e-3) << c.what;
        EXPECT_EQ(places[0].x * 4096.0, std::floor(places[0].x * 4096.0)) << "snapped";
        EXPECT_TRUE(*sky.grid == *sky_with(c.cards, c.pixels).grid) << c.what;
        EXPECT_FALSE(*sky.grid == *sky_with({{"CRVAL1", "83.9"}}).grid) << c.what;
    }
}

// Of one that was an extension, as archives store them, CFITSIO 4.2 cannot say what the header was.
TEST(FitsSky, OfCompressedPictures) {
    const TempFolder folder;
    std::vector<std::string> cards;
    for (const SkyCards* some : {&tangent_plane, &square_px})
        for (const auto& [key, value] : *some) cards.push_back(fmt::format("{:8}= {:>20}", key, value));
    for (const bool was_extension : {false, true}) {
        const fs::path file = write_compressed(folder / "a.fits", RICE_1, cards, was_extension);
        const FitsSky sky = read_fits(file, "auto", {}).sky;
        ASSERT_TRUE(sky.grid) << was_extension;
        EXPECT_TRUE(*sky.grid == *sky_with({}).grid) << was_extension;
        fs::remove(file);
    }
}

TEST(FitsSky, OfRowsFromTheTop) {
    std::array up{glm::dvec2(3.0, 31.0)}, down{glm::dvec2(3.0, 170.0)};  // of 200 rows
    const FitsSky turned = sky_with({}, square_px, true);
    sky_with({}).grid->to_sky(up);
    turned.grid->to_sky(down);
    EXPECT_EQ(up[0], down[0]);
    turned.grid->to_pixels(down);
    EXPECT_EQ(down[0].y, 170.0);
    EXPECT_LT(turned.grid->degrees_per_px()[3], 0.0) << "south is up";
    std::array behind{glm::dvec2(263.8, 5.4)};
    sky_with({}).grid->to_pixels(behind);
    EXPECT_TRUE(std::isnan(behind[0].x));
}

TEST(FitsSky, IsNoneOrSaysWhatIsNotFollowed) {
    const auto answer = [](const SkyCards& cards, const SkyCards& pixels = square_px) {
        const FitsSky sky = sky_with(cards, pixels);
        return sky.grid ? "followed" : sky.unfollowed.empty() ? "none" : sky.unfollowed;
    };
    EXPECT_EQ(answer({}), "followed");
    EXPECT_EQ(answer({}, {}), "none") << "a pixel has no size";
    EXPECT_EQ(answer({}, {{"CD1_1", "0.0"}, {"CD2_2", "0.0"}}), "none") << "nor has this";
    EXPECT_EQ(answer({{"CTYPE1", "'RA---TAB'"}, {"CTYPE2", "'DEC--TAB'"}}), "the projection RA---TAB");
    EXPECT_EQ(answer({{"CRVAL1", "1E300"}}), "a reference at 1e+300 degrees");
    EXPECT_EQ(answer({{"CTYPE1", "'X'"}, {"CTYPE2", "'Y'"}}), "none");
    EXPECT_EQ(answer({{"CTYPE1", "'HPLN-TAN'"}, {"CTYPE2", "'HPLT-TAN'"}}), "the frame HPLN-TAN");
    EXPECT_EQ(answer({{"RADESYS", "'GAPPT'"}}), "the frame GAPPT");
    EXPECT_EQ(answer({{"RADESYS", "'FK4'"}, {"EQUINOX", "1900.0"}}), "the frame FK4 of 1900");
    EXPECT_NE(answer({}, {{"CD1_1", "0.01"}, {"CD1_2", "0.01"}, {"CD2_1", "0.01"}, {"CD2_2", "0.01"}}),
              "followed");
    EXPECT_HAS(answer({{"CTYPE1", "'RA---XYZ'"}, {"CTYPE2", "'DEC--XYZ'"}}), "the projection RA---XYZ (");
    EXPECT_HAS(answer({{"CTYPE1", "'RA---ZPX'"}, {"CTYPE2", "'DEC--ZPX'"}}), "the projection RA---ZPX (");
    const std::vector<std::string> said = warnings_of([&] {
        EXPECT_EQ(answer({{"CPDIS1", "'LOOKUP'"}, {"DP1", "'EXTVER: 1'"}, {"CPERR1", "0.02"}}), "followed");
    });
    ASSERT_EQ(said.size(), 1u);
    EXPECT_HAS(said[0], "its table of distortions (CPDIS, D2IM) is not followed");
    EXPECT_EQ(warnings_of([&] { EXPECT_EQ(answer({{"D2IMDIS1", "'Lookup'"}}), "followed"); }).size(), 1u);
}

// By name, as gzip's; 5 x 4 numbers that count.
TEST(FitsPacked, Bzip2IsReadAndItsHeadersAreLookedAt) {
    const TempFolder folder;
    const std::string plain = fits_file(5, 4, "", [](int x, int y) { return 5 * y + x; });
    const auto packed = [](std::string bytes) {
        unsigned size = unsigned(bytes.size()) + 1000;
        std::string out(size, '\0');
        BZ2_bzBuffToBuffCompress(out.data(), &size, bytes.data(), unsigned(bytes.size()), 9, 0, 0);
        return out.substr(0, size);
    };
    for (const char* const name : {"a.fits.bz2", "b.FIT.BZ2", "c.fts.bz2"}) {
        const fs::path file = folder.file(name, packed(plain));
        require_picture(file);
        const FitsPlane plane = read_fits(file, "auto", {});
        ASSERT_EQ(plane.values.size(), 20u);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 5; ++x) EXPECT_EQ(plane.values[std::size_t(5 * (3 - y) + x)], 5 * y + x);
        EXPECT_EQ(describe_fits(file).at(0).range.max, 19.0);
    }
    const std::string compressed = bytes_of(write_compressed(folder / "whole.fits", RICE_1));
    const fs::path bad = folder.file("bad.fits.bz2", packed(with_value(compressed, "ZVAL1", "0")));
    EXPECT_EQ(ERROR_OF(read_fits(bad, "auto", {})),
              bad.string() + ":HDU 1: expected ZVAL1 to be 16 or 32 pixels, found 0");
    const fs::path cut = folder.file("cut.fits.bz2", packed(plain).substr(0, 60));
    EXPECT_EQ(ERROR_OF(require_picture(cut)),
              cut.string() + ": expected a whole bzip2 file, found damaged data");
}

}  // namespace
}  // namespace astrosplat
