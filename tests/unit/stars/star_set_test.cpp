// Where stars stand and how bright they are, by hand.
#include "stars/star_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "catalogues.h"
#include "support/test_data.h"

namespace astrosplat {
namespace {

CatalogueStar star_at(double ra_deg, double dec_deg, double distance_pc, double magnitude) {
    return {0, ra_deg, dec_deg, distance_pc, magnitude, {}};
}

SplatSet set_of(std::vector<CatalogueStar> stars, const StarScale& scale = {}, StarCounts* counts = nullptr) {
    StarCatalogue catalogue;
    catalogue.stars = std::move(stars);
    for (std::size_t i = 0; i < catalogue.stars.size(); ++i)
        catalogue.stars[i].row = static_cast<std::int64_t>(i);
    return star_set(catalogue, scale, counts);
}

void expect_near(const glm::dvec3& found, const glm::dvec3& expected, double tolerance) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], tolerance) << "axis " << i;
}

TEST(StarSet, TheAxesAreThoseOfTheSky) {
    expect_near(star_direction(0, 0), {1, 0, 0}, 1e-15);
    expect_near(star_direction(90, 0), {0, 0, -1}, 1e-15);
    expect_near(star_direction(180, 0), {-1, 0, 0}, 1e-15);
    expect_near(star_direction(123, 90), {0, 1, 0}, 1e-15);
    expect_near(star_direction(0, -45), {std::sqrt(0.5), -std::sqrt(0.5), 0}, 1e-15);
}

TEST(StarSet, EastIsToTheLeftSeenFromInsideWithNorthUp) {
    const glm::dvec3 forward = star_direction(84, 0), east = star_direction(94, 0), up(0, 1, 0);
    EXPECT_LT(glm::dot(glm::cross(forward, up), east), 0.0);  // forward x up points to the right
}

// J2000 places and parallaxes of the Hipparcos catalogue; the directions worked out apart from this program.
TEST(StarSet, KnownStarsStandAtTheirPlaces) {
    const SplatSet set = set_of({star_at(101.28854105, -16.71314306, 1000.0 / 379.21, -1.44),
                                 star_at(279.23410832, 38.78299311, 1000.0 / 128.93, 0.03)});
    const double sirius = 2.637061, vega = 7.756147;
    expect_near(set.position[0], {sirius * -0.187481, sirius * -0.287580, sirius * -0.939228}, 2e-5);
    expect_near(set.position[1], {vega * 0.125089, vega * 0.626372, vega * 0.769422}, 2e-5);
}

TEST(StarSet, UnitScalesDistances) {
    const SplatSet set = set_of({star_at(0, 0, 12.5, 1)}, {0.01, 12.0, 4.0});
    expect_near(set.position[0], {0.125, 0, 0}, 1e-7);
}

TEST(StarSet, FiveMagnitudesAreAFactorOfHundred) {
    const SplatSet set = set_of({star_at(0, 0, 10, 4), star_at(0, 0, 10, 9), star_at(0, 0, 99, -1)});
    EXPECT_NEAR(test::flux_of(set.color[0]), 1.0, 1e-6);
    EXPECT_NEAR(test::flux_of(set.color[1]), 0.01, 1e-8);
    EXPECT_NEAR(test::flux_of(set.color[2]), 100.0, 1e-4);  // as seen from the origin, however far
    EXPECT_NEAR(test::flux_of(set_of({star_at(0, 0, 10, 4)}, {1.0, 12.0, 6.5}).color[0]), 10.0, 1e-5);
}

TEST(StarSet, ColorFollowsBMinusV) {
    CatalogueStar red = star_at(0, 0, 10, 4), blue = red;
    red.color_index = 1.8;
    blue.color_index = -0.2;
    const SplatSet set = set_of({red, blue});
    EXPECT_GT(set.color[0].x, 2.0f * set.color[0].z);
    EXPECT_GT(set.color[1].z, 1.5f * set.color[1].x);
}

TEST(StarSet, FainterThanTheLimitIsLeftOut) {
    StarCounts counts;
    const SplatSet set = set_of({star_at(0, 0, 1, 6.5), star_at(0, 0, 1, 6.51), star_at(0, 0, 1, -2)},
                                {1.0, 6.5, 4.0}, &counts);
    EXPECT_EQ(set.id, (Buffer<std::uint64_t>{0, 2}));  // ids stay those of the rows
    EXPECT_EQ(counts.too_faint, 1);
    EXPECT_EQ(counts.kept, 2);
}

TEST(StarSet, WithoutADistanceStarsAreInfinitelyFarAndCounted) {
    StarCounts counts;
    const SplatSet set = set_of({star_at(90, 0, 0, 1), star_at(0, 0, 10, 1), star_at(0, 90, 1e9, 1)},
                                {1e6, 12.0, 4.0}, &counts);
    EXPECT_EQ(counts.infinite, 2);  // the last is beyond all that has a place
    EXPECT_NEAR(set.position[0].z, -1e18, 1e12);
    EXPECT_NEAR(set.position[2].y, 1e18, 1e12);
    EXPECT_TRUE(is_direction(set.position[0]));
    EXPECT_FALSE(is_direction(set.position[1]));
    EXPECT_EQ(bounds(set).hi, glm::dvec3(1e7, 0.0, 0.0));  // of what has a place
    EXPECT_EQ(bounds(set).lo, bounds(set).hi);
}

TEST(StarSet, TheOtherColumnsAreConstant) {
    const SplatSet set = set_of({star_at(0, 0, 1, 1), star_at(0, 0, 2, 2)});
    EXPECT_EQ(set.alpha, (Buffer<float>{1.0f, 1.0f}));
    EXPECT_EQ(set.distance, (Buffer<float>{0.0f, 0.0f}));
    EXPECT_EQ(set.radius, (Buffer<float>{0.0f, 0.0f}));
    check_consistent(set);
}

TEST(StarSet, AbsurdMagnitudesStayFinite) {
    const SplatSet set = set_of({star_at(0, 0, 1, -60)}, {1.0, 12.0, 100.0});
    EXPECT_NEAR(test::flux_of(set.color[0]), 1e18, 1e12);
}

TEST(StarSet, TheFirstRowOfHipparcosStandsWhereItShould) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(file, "stars/hip_main.dat.gz");
    StarCounts counts;
    const SplatSet set = star_set(read_catalogue(file), {}, &counts);
    // HIP 19: ra 0.05331696, dec 38.30408636 degrees, 4.12 mas = 242.7184 pc.
    expect_near(set.position[0], {190.46889, 150.44539, -0.17724211}, 2e-5);
    EXPECT_EQ(counts.infinite, 72);
    EXPECT_EQ(counts.kept, 9932);
}

}  // namespace
}  // namespace astrosplat
