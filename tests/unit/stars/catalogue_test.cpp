// Catalogues of stars, and the table of a picture's stars.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <iterator>

#include "catalogues.h"
#include "core/text.h"
#include "stars/catalogue.h"
#include "support/bits.h"
#include "support/errors.h"
#include "support/process_state.h"
#include "support/temp_folder.h"
#include "support/test_data.h"

namespace astrosplat {
namespace {

// Catalogues of every kind, whole and damaged.

using test::hipparcos_line;
using test::hyg_header;
using testing::HasSubstr;

StarCatalogue parse(const std::string& text) { return parse_catalogue(text, "stars"); }

std::string error_of(const std::string& text) { return ERROR_OF(parse(text)); }

void expect_star(const CatalogueStar& star, double ra_deg, double dec_deg, double distance_pc,
                 double magnitude) {
    EXPECT_NEAR(star.ra_deg, ra_deg, 1e-9);
    EXPECT_NEAR(star.dec_deg, dec_deg, 1e-9);
    EXPECT_NEAR(star.distance_pc, distance_pc, 1e-9 * distance_pc);
    EXPECT_NEAR(star.magnitude, magnitude, 1e-9);
}

TEST(Hipparcos, FieldsAreReadAtTheirPlaces) {
    const StarCatalogue read = parse(
        hipparcos_line({}) + hipparcos_line({"-1.44", "101.28854105", "-16.71314306", "379.21", "0.009"}));
    ASSERT_EQ(read.stars.size(), 2u);
    expect_star(read.stars[0], 0.05331696, 38.30408636, 1000.0 / 4.12, 6.53);
    expect_star(read.stars[1], 101.28854105, -16.71314306, 1000.0 / 379.21, -1.44);
    EXPECT_EQ(read.stars[0].color_index, 0.955);
    EXPECT_EQ(read.stars[1].row, 1);
    EXPECT_EQ(read.bad.count, 0);
}

TEST(Hipparcos, WithoutDegreesTheClockReadingCounts) {
    const StarCatalogue read =
        parse(hipparcos_line({"6.53", "", "", "4.12", "0.9", "06 45 08.92", "-16 42 58.0"}));
    ASSERT_EQ(read.stars.size(), 1u);
    EXPECT_NEAR(read.stars[0].ra_deg, 15.0 * (6.0 + 45.0 / 60.0 + 8.92 / 3600.0), 1e-9);
    EXPECT_NEAR(read.stars[0].dec_deg, -(16.0 + 42.0 / 60.0 + 58.0 / 3600.0), 1e-9);
    // The sign of -00 is not lost.
    EXPECT_LT(parse(hipparcos_line({"6.5", "", "", "4", "0.9", "06 45 08", "-00 42 58.0"})).stars[0].dec_deg,
              0.0);
}

TEST(Hipparcos, WhatIsMissingIsNotZero) {
    const StarCatalogue read = parse(hipparcos_line({"6.5", "1.0", "2.0", "-0.5", ""}) +
                                     hipparcos_line({"6.5", "1.0", "2.0", "", ""}) +
                                     hipparcos_line({"6.5", "1.0", "2.0", "0.00", "0.0"}));
    ASSERT_EQ(read.stars.size(), 3u);
    for (const CatalogueStar& star : read.stars) EXPECT_EQ(star.distance_pc, 0.0);
    EXPECT_FALSE(read.stars[0].color_index.has_value());
    EXPECT_EQ(read.stars[2].color_index, 0.0);
}

TEST(Hipparcos, BadRowsAreCountedAndNamed) {
    std::string text = hipparcos_line({});
    text += hipparcos_line({"bright"}) + "H|12|cut\n" + hipparcos_line({"6.5", "1.0", "91.0"});
    text += hipparcos_line({"", "1.0", "2.0"}) + hipparcos_line({});
    const StarCatalogue read = parse(text);
    EXPECT_EQ(read.stars.size(), 2u);
    EXPECT_EQ(read.stars[1].row, 5);
    EXPECT_EQ(read.rows, 6);
    EXPECT_EQ(read.bad.text(read.rows),
              "4 of 6 rows cannot be used, first at lines 2, 3 and 4 (line 2: expected a number for the "
              "magnitude, found 'bright')");
}

TEST(NamedColumns, StandInAnyOrderAndInCapitalsOrNot) {
    const StarCatalogue read =
        parse("BV,Mag,name,DEC,Ra,Distance\n0.5,3.25,\"a, b\",-10,200,50\n,4,c,10,20,\n");
    ASSERT_EQ(read.stars.size(), 2u);
    expect_star(read.stars[0], 200, -10, 50, 3.25);
    EXPECT_EQ(read.stars[0].color_index, 0.5);
    expect_star(read.stars[1], 20, 10, 0, 4);
    EXPECT_FALSE(read.stars[1].color_index.has_value());
}

TEST(NamedColumns, EveryNameIsKnown) {
    for (const char* name : {"dist", "distance"})
        EXPECT_EQ(parse(std::string("ra,dec,mag,") + name + "\n1,2,3,20\n").stars[0].distance_pc, 20.0)
            << name;
    for (const char* name : {"parallax", "plx"})
        EXPECT_EQ(parse(std::string("ra,dec,mag,") + name + "\n1,2,3,20\n").stars[0].distance_pc, 50.0)
            << name;
    for (const char* name : {"bv", "b_v", "B-V", "ci"})
        EXPECT_EQ(parse(std::string("ra,dec,mag,") + name + "\n1,2,3,1.5\n").stars[0].color_index, 1.5)
            << name;
    EXPECT_EQ(parse("ra,dec,Vmag\n1,2,3\n").stars[0].magnitude, 3.0);
}

TEST(NamedColumns, ParallaxServesWhereTheDistanceIsMissing) {
    const StarCatalogue read = parse("ra,dec,mag,dist,plx\n1,2,3,20,10\n1,2,3,,10\n1,2,3,0,-10\n1,2,3,-4,\n");
    ASSERT_EQ(read.stars.size(), 4u);
    EXPECT_EQ(read.stars[0].distance_pc, 20.0);
    EXPECT_EQ(read.stars[1].distance_pc, 100.0);
    EXPECT_EQ(read.stars[2].distance_pc, 0.0);
    EXPECT_EQ(read.stars[3].distance_pc, 0.0);
}

TEST(NamedColumns, OtherSeparatorsLineEndsAndMarks) {
    expect_star(parse("ra;dec;mag\n10;20;3\n").stars.at(0), 10, 20, 0, 3);
    expect_star(parse("ra\tdec\tmag\n10\t20\t3\n").stars.at(0), 10, 20, 0, 3);
    expect_star(parse("  ra dec   distance mag bv\n 10  20 5    3   0.5\r\n").stars.at(0), 10, 20, 5, 3);
    expect_star(parse("\xef\xbb\xbfra,dec,mag\r\n10,20,3\r\n").stars.at(0), 10, 20, 0, 3);
    expect_star(parse("# by hand\n\n\"ra\",\"dec\",\"mag\"\n# more\n\"10\",\"20\",\" 3 \"").stars.at(0), 10,
                20, 0, 3);
    EXPECT_FALSE(parse("ra,dec,mag,bv\r\n1,2,3,NaN\r\n").stars.at(0).color_index.has_value());
    EXPECT_FALSE(parse("ra,dec,mag,bv\n1,2,3,~\n").stars.at(0).color_index.has_value());
}

TEST(NamedColumns, BadRowsAreCountedAndNamed) {
    const StarCatalogue read = parse("ra,dec,mag,bv\n1,2,3,0\n1,2\n1,2,3,x\n400,2,3,0\n");
    EXPECT_EQ(read.stars.size(), 1u);
    EXPECT_EQ(
        read.bad.text(read.rows),
        "3 of 4 rows cannot be used, at lines 3, 4 and 5 (line 3: expected -60 to 60 for the magnitude, "
        "found none)");
    EXPECT_EQ(
        parse("ra,dec,mag\n1,2,3\n1,2,inf\n").bad.text(2),
        "1 of 2 rows cannot be used, at line 3 (line 3: expected a number for the magnitude, found 'inf')");
}

TEST(NamedColumns, HygCountsRightAscensionInHours) {
    const std::string row =
        "32263,32349,48915,2491,\"Gl 244A\",\"9Alp CMa\",Sirius,6.752481,-16.716116,2.6371,"
        "-546.01,-1223.08,-9.4,-1.44,1.454,A0m...,0.009,-0.494,2.4767,-0.7585\n";
    const std::string far = "1,1,224700,,,,,0.000060,1.089009,100000.0000,0,0,0,9.1,-10.9,F5,0.482,0,0,0\n";
    const std::string sun = "0,,,,,,Sol,0.000000,0.000000,0.0000,0.00,0.00,0.0,-26.7,4.85,G2V,0.656,0,0,0\n";
    const StarCatalogue read = parse(hyg_header + row + far + sun);
    ASSERT_EQ(read.stars.size(), 3u);
    expect_star(read.stars[0], 6.752481 * 15.0, -16.716116, 2.6371, -1.44);
    EXPECT_EQ(read.stars[1].distance_pc, 0.0);
    // Its magnitude holds at 1 au.
    EXPECT_NEAR(read.stars[2].distance_pc * 206264.806, 1.0, 1e-6);
    // Without those columns ra is in degrees, and 100000 pc are a distance.
    expect_star(parse("ra,dec,dist,mag\n6.75,1,100000,2\n").stars.at(0), 6.75, 1, 100000, 2);
}

TEST(Catalogue, WhatIsNoCatalogueIsSaidInOneLine) {
    EXPECT_EQ(error_of(""), "stars: expected a star catalogue, found an empty file");
    EXPECT_EQ(error_of("\n \n# nothing\n"), "stars: expected a star catalogue, found an empty file");
    EXPECT_EQ(
        error_of("hello\n"),
        "stars:line 1: expected a Hipparcos catalogue, or names of columns with ra, dec and mag among them, "
        "found 'hello'");
    EXPECT_THAT(error_of(std::string("\x01\x02\n\x03", 4)), HasSubstr("found '\\x01\\x02'"));
    EXPECT_EQ(error_of("ra,dec,mag\n"), "stars: expected at least one star, found none");
    EXPECT_EQ(error_of("ra,dec,mag\n1,x,2\n"),
              "stars: expected at least one star, found none: 1 of 1 row cannot be used, at line 2 (line 2: "
              "expected a number for declination, found 'x')");
    EXPECT_THAT(error_of("H|1\n"), HasSubstr("expected 38 fields, found 2"));
}

std::string gzipped(const std::string& text) {
    const TempFolder folder;
    const std::string file = folder / "packed";
    const gzFile out = gzopen(file.c_str(), "wb");
    gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
    gzclose(out);
    return test::bytes_of(file);
}

TEST(Catalogue, GzipIsReadWhateverTheName) {
    const TempFolder folder;
    std::string text = "ra,dec,mag\n";
    constexpr int rows = 400000;  // more than one block
    for (int i = 0; i < rows; ++i) text += "10.125,20.25,3.5\n";
    EXPECT_EQ(read_catalogue(folder.file("stars.csv.gz", gzipped(text))).stars.size(), std::size_t{rows});
    const std::string packed = gzipped(hipparcos_line({}));
    EXPECT_EQ(read_catalogue(folder.file("packed.dat", packed)).stars.size(), 1u);
    EXPECT_EQ(read_catalogue(folder.file("two.dat", packed + packed)).stars.size(), 2u);
    const std::filesystem::path cut = folder.file("cut.dat.gz", packed.substr(0, packed.size() / 2));
    EXPECT_EQ(ERROR_OF(read_catalogue(cut)),
              cut.string() + ": expected a whole gzip file, found damaged data");
    EXPECT_THAT(ERROR_OF(read_catalogue(folder / "absent.dat")), HasSubstr("cannot be read"));
}

TEST(Catalogue, NumbersDoNotHangOnTheLocale) {
    const CommaLocale locale;
    const StarCatalogue read = parse("ra,dec,mag\n10.5,-20.25,3.75\n");
    ASSERT_EQ(read.stars.size(), 1u);
    expect_star(read.stars[0], 10.5, -20.25, 0, 3.75);
}

TEST(Catalogue, TheRealHipparcosIsRead) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(file, "stars/hip_main.dat.gz");
    const StarCatalogue read = read_catalogue(file);
    EXPECT_EQ(read.rows, 9933);
    EXPECT_EQ(read.bad.lines, (std::vector<std::int64_t>{1993}));  // HIP 120412, of which nothing is known
    ASSERT_EQ(read.stars.size(), 9932u);
    expect_star(read.stars[0], 0.05331696, 38.30408636, 1000.0 / 4.12, 6.53);
    std::int64_t unknown = 0, colorless = 0, by_clock = 0;
    for (const CatalogueStar& star : read.stars) {
        unknown += star.distance_pc == 0.0;
        colorless += !star.color_index;
        by_clock += star.ra_deg == 0.0;
    }
    EXPECT_EQ(unknown, 72);
    EXPECT_EQ(colorless, 4);
    EXPECT_EQ(by_clock, 0);
}

TEST(TextTable, RowsThatAreTooShortHaveEmptyFields) {
    TextTable table("a,b,c\n1\n");
    ASSERT_TRUE(table.next());
    EXPECT_EQ(table.field(0), "1");
    EXPECT_EQ(table.field(2), "");
    EXPECT_EQ(table.field(TextTable::none), "");
    EXPECT_EQ(table.line(), 2);
    EXPECT_FALSE(table.next());
}

// The table of a picture's stars: what prepare writes, and tables that are not quite that.

TEST(PictureTable, HoldsWhatPrepareWrites) {
    const PictureTable table = parse_picture_table(
        "x,y,u,v,flux_r,flux_g,flux_b,sigma_px,saturated\n"
        "10.000,30.000,0.2500000,0.7000000,1.5,2.5,0,0.8000,0\n"
        "20.000,60.000,0.5000000,0.4000000,-0.1,1,1,1.2000,1\n"
        "30.000,60.000,0.7500000,0.4000000,1,1,1,2.0000,1\n",
        "stars.csv");
    ASSERT_EQ(table.stars.size(), 3u);
    EXPECT_EQ(table.bad.count, 0);
    EXPECT_EQ(table.stars[0].uv, glm::dvec2(0.25, 0.7));
    EXPECT_EQ(table.stars[0].light, glm::dvec3(1.5, 2.5, 0.0));
    EXPECT_EQ(table.stars[1].light, glm::dvec3(0.0, 1.0, 1.0)) << "no light is negative";
    EXPECT_EQ(table.stars[2].row, 2);
    EXPECT_EQ(median_sigma_px(table), 1.2);
    EXPECT_TRUE(parse_picture_table("u,v,flux_r,flux_g,flux_b\n", "empty.csv").stars.empty());
}

TEST(PictureTable, BadRowsAreCountedAndNamed) {
    const PictureTable table = parse_picture_table(
        "flux_b;flux_g;flux_r;v;u\n1;1;1;0.5;0.5\n0;0;0;0.5;0.5\n1;1;x;0.5;0.5\n1;1;1;0.5\n", "stars.csv");
    EXPECT_EQ(table.stars.size(), 1u);
    EXPECT_EQ(table.rows, 4);
    EXPECT_EQ(table.bad.text(table.rows),
              "3 of 4 rows cannot be used, at lines 3, 4 and 5 (line 3: expected light, found none)");
    EXPECT_EQ(median_sigma_px(table), 0.0);
}

TEST(PictureTable, OddFilesEndInOneLine) {
    EXPECT_EQ(ERROR_OF(parse_picture_table("ra,dec,mag\n1,2,3\n", "a.csv")),
              "a.csv:line 1: expected the stars of a picture: names of columns with u, v, flux_r, flux_g and "
              "flux_b among them, found 'ra,dec,mag'");
    EXPECT_NE(ERROR_OF(parse_picture_table("u,v,flux_r,flux_g,flux_b\n1,2,3,4,inf\n", "a.csv"))
                  .find("a.csv: expected stars, found 1 of 1 row"),
              std::string::npos);
}

}  // namespace
}  // namespace astrosplat
