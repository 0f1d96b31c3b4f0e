// The table of a picture's stars: what prepare writes, and tables that are not quite that.
#include "stars/catalogue.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "support/errors.h"

namespace astrosplat {
namespace {

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
    EXPECT_EQ(message_of<InputError>([] { parse_picture_table("ra,dec,mag\n1,2,3\n", "a.csv"); }),
              "a.csv:line 1: expected the stars of a picture: names of columns with u, v, flux_r, flux_g and "
              "flux_b among them, found 'ra,dec,mag'");
    EXPECT_NE(message_of<InputError>([] {
                  parse_picture_table("u,v,flux_r,flux_g,flux_b\n1,2,3,4,inf\n", "a.csv");
              }).find("a.csv: expected stars, found 1 of 1 row"),
              std::string::npos);
}

}  // namespace
}  // namespace astrosplat
