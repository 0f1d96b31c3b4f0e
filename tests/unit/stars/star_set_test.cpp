// Sets of stars, and the catalogues that they are made of.
#include "stars/star_set.h"

#include <gmock/gmock.h>
#include <zlib.h>

#include "catalogues.h"
#include "core/text.h"
#include "stars/catalogue.h"
#include "support/test.h"
#include "support/test_data.h"

namespace astrosplat {
namespace {

// Where stars stand and how bright they are, by hand.

CatalogueStar star_at(double ra_deg, double dec_deg, double distance_pc, double magnitude) {
    return {0, ra_deg, dec_deg, distance_pc, magnitude, {}};
}

SplatSet set_of(std::vector<CatalogueStar> stars, const StarScale& scale = {}, StarCounts* counts = nullptr) {
    StarCatalogue catalogue;
    catalogue.stars = std::move(stars);
    for (std::size_t i = 0; i < catalogue.stars.size(); ++i) catalogue.stars[i].row = std::int64_t(i);
    return star_set(catalogue, scale, counts);
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

// Colours of stars against tables of black bodies.

double luminance_of(const glm::dvec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

TEST(StarColor, TemperaturesAreBallesteros) {
    // 4600 (1 / (0.92 * 0.65 + 1.7) + 1 / (0.92 * 0.65 + 0.62)) by hand; Vega's B-V is 0.
    EXPECT_NEAR(star_temperature(0.65), 4600.0 * (1.0 / 2.298 + 1.0 / 1.218), 1e-6);
    EXPECT_NEAR(star_temperature(0.0), 4600.0 / 1.7 + 4600.0 / 0.62, 1e-6);
    EXPECT_NEAR(star_temperature(0.65), 5778.0, 10.0);  // the Sun
}

// CIE 1931 chromaticities of the Planckian locus, as in tables of it (G. Wyszecki and W. S. Stiles, "Color
// Science", 1982, table 1(3.11)); Wyman's fits are good for some thousandths.
TEST(StarColor, BlackBodiesLieOnThePlanckianLocus) {
    struct Known {
        double kelvin, x, y;
    };
    for (const Known& known :
         {Known{3000, 0.4369, 0.4041}, Known{4000, 0.3805, 0.3768}, Known{5000, 0.3451, 0.3516},
          Known{6500, 0.3135, 0.3237}, Known{10000, 0.2807, 0.2884}}) {
        const glm::dvec3 c = black_body_color(known.kelvin);
        const glm::dvec3 xyz(0.4124 * c.x + 0.3576 * c.y + 0.1805 * c.z,
                             0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z,
                             0.0193 * c.x + 0.1192 * c.y + 0.9505 * c.z);
        const double sum = xyz.x + xyz.y + xyz.z;
        EXPECT_NEAR(xyz.x / sum, known.x, 0.004) << known.kelvin;
        EXPECT_NEAR(xyz.y / sum, known.y, 0.004) << known.kelvin;
    }
}

TEST(StarColor, TheSunIsNearlyWhiteAndCoolStarsAreRed) {
    const glm::dvec3 sun = black_body_color(5772.0);
    EXPECT_GT(sun.x, sun.y);
    EXPECT_GT(sun.y, sun.z);
    EXPECT_LT(sun.x / sun.z, 1.5);
    const glm::dvec3 cool = black_body_color(3000.0), hot = black_body_color(20000.0);
    EXPECT_GT(cool.x / cool.z, 5.0);
    EXPECT_LT(hot.x / hot.z, 0.6);
}

TEST(StarColor, EveryColorHasLuminanceOneAndNoNegativeChannel) {
    const StarColors colors;
    for (double bv = -1.0; bv < 8.0; bv += 0.013) {
        const glm::dvec3 c = colors(bv);
        EXPECT_NEAR(luminance_of(c), 1.0, 1e-12) << bv;
        EXPECT_GE(std::min({c.x, c.y, c.z}), 0.0) << bv;
    }
    for (const double kelvin : {500.0, 1000.0, 1e5, 1e7})
        EXPECT_NEAR(luminance_of(black_body_color(kelvin)), 1.0, 1e-12) << kelvin;
}

TEST(StarColor, TheTableGivesTheFormulasColors) {
    const StarColors colors;
    for (const double bv : {-0.4, -0.123, 0.0, 0.655, 1.7183, 5.0}) {
        const glm::dvec3 c = colors(bv), exact = black_body_color(star_temperature(bv));
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(c[i], exact[i], 2e-4 * exact[i] + 1e-6) << bv;
    }
    EXPECT_EQ(colors(std::nullopt), colors(0.65));
    EXPECT_EQ(colors(-3.0), colors(-0.4));
    EXPECT_EQ(colors(30.0), colors(5.0));
}

// Random stars fill their tube evenly, and are of the kinds they are drawn from.

const std::vector<StarKind> suns = {{4.83, 0.65}};

double share_of(const SplatSet& set, const std::function<bool(const glm::dvec3&)>& inside) {
    const auto count =
        std::ranges::count_if(set.position, [&](const glm::vec3& p) { return inside(glm::dvec3(p)); });
    return double(count) / double(set.size());
}

TEST(RandomStars, ABallIsFilledEvenly) {
    const glm::dvec3 at(5, -3, 100);
    const SplatSet set = random_stars({{at}, 2.0}, suns, 100000, 7, {});
    EXPECT_EQ(share_of(set, [&](auto p) { return glm::length(p - at) < 2.0001; }), 1.0);
    EXPECT_NEAR(share_of(set, [&](auto p) { return glm::length(p - at) < 1.0; }), 0.125, 0.005);
    EXPECT_NEAR(share_of(set, [&](auto p) { return p.x > 5.0; }), 0.5, 0.008);
    EXPECT_NEAR(share_of(set, [&](auto p) { return p.y > -3.0; }), 0.5, 0.008);
    // A cap of height h: h^2 (3 - h) / 4 of the ball of radius 1.
    EXPECT_NEAR(share_of(set, [&](auto p) { return p.z > 101.0; }), 0.25 * 2.5 / 4.0, 0.006);
}

TEST(RandomStars, ATubeIsFilledEvenlyAlongItsPath) {
    const SplatSet set = random_stars({{{0, 0, 0}, {0, 0, 30}}, 1.0}, suns, 100000, 1, {});
    const double ball = 4.0 / 3.0, whole = ball + 30.0;  // in units of pi
    EXPECT_NEAR(share_of(set, [](auto p) { return p.z < 0.0; }), ball / 2.0 / whole, 0.003);
    EXPECT_NEAR(share_of(set, [](auto p) { return p.z > 10.0 && p.z < 20.0; }), 10.0 / whole, 0.008);
    EXPECT_NEAR(share_of(set, [](auto p) { return p.z > 0.0 && p.z < 30.0 && p.x * p.x + p.y * p.y < 0.25; }),
                7.5 / whole, 0.008);
}

TEST(RandomStars, WhereAPathComesBackStarsAreNoDenser) {
    const SplatSet once = random_stars({{{0, 0, 0}, {20, 0, 0}}, 1.0}, suns, 100000, 1, {});
    const SplatSet again =
        random_stars({{{0, 0, 0}, {20, 0, 0}, {10, 0, 0}, {20, 0, 0}}, 1.0}, suns, 100000, 1, {});
    for (const double x : {0.0, 5.0, 10.0, 15.0, 20.0})
        EXPECT_NEAR(share_of(again, [&](auto p) { return p.x < x; }),
                    share_of(once, [&](auto p) { return p.x < x; }), 0.01)
            << x;
}

TEST(RandomStars, AreTheSameForMoreOfThem) {
    const StarTube tube{{{0, 0, 0}, {20, 3, 0}, {9, 9, 9}}, 4.0};
    const SplatSet some = random_stars(tube, main_sequence(), 10000, 3, {});
    const SplatSet more = random_stars(tube, main_sequence(), 20000, 3, {});
    EXPECT_TRUE(std::equal(some.position.begin(), some.position.end(), more.position.begin()));
    EXPECT_TRUE(std::equal(some.color.begin(), some.color.end(), more.color.begin()));
    EXPECT_NE(random_stars(tube, main_sequence(), 10, 4, {}).position[0], some.position[0]);
    EXPECT_TRUE(some.stars);
    EXPECT_EQ(some.id[77], 77u);
    EXPECT_EQ(some.radius[0], 0.0f);
    check_consistent(some);
}

TEST(RandomStars, LightFallsWithTheSquareOfTheDistanceFromTheOrigin) {
    const StarScale scale{0.5, 0.0, 3.0};  // the limit is for catalogues
    const SplatSet set = random_stars({{{30, 0, 0}}, 20.0}, {{{1.0, 0.65}}}, 100, 9, scale);
    for (std::int64_t i = 0; i < set.size(); ++i) {
        const double parsecs = glm::length(glm::dvec3(set.position[i])) / 0.5;
        EXPECT_NEAR(test::flux_of(set.color[i]),
                    std::pow(10.0, 0.4 * (3.0 - 1.0)) * 100.0 / (parsecs * parsecs),
                    1e-5 * test::flux_of(set.color[i]));
    }
}

TEST(RandomStars, MagnitudesAndColorsGoTogether) {
    const std::vector<StarKind> kinds = {{-5.0, 1.8}, {3.0, -0.2}, {3.0, -0.2}};
    const SplatSet set = random_stars({{{1000, 0, 0}}, 1.0}, kinds, 30000, 5, {});
    std::int64_t red = 0;
    for (std::int64_t i = 0; i < set.size(); ++i) {
        const bool bright = test::flux_of(set.color[i]) > 0.1 * test::flux_of({set.color[0]}) &&
                            test::flux_of(set.color[i]) > 1e-1;
        EXPECT_EQ(bright, set.color[i].x > set.color[i].z);
        red += set.color[i].x > set.color[i].z;
    }
    EXPECT_NEAR(double(red) / 30000.0, 1.0 / 3.0, 0.01);
}

TEST(RandomStars, ACatalogueGivesTheKindsOfItsStarsWithADistance) {
    StarCatalogue catalogue;
    catalogue.stars = {{0, 0, 0, 100.0, 6.0, 0.5}, {1, 0, 0, 0.0, 1.0, 0.5}, {2, 0, 0, 10.0, 9.0, {}}};
    const std::vector<StarKind> kinds = kinds_of(catalogue, 8.0);
    ASSERT_EQ(kinds.size(), 1u);
    EXPECT_NEAR(kinds[0].absolute_magnitude, 1.0, 1e-12);
    EXPECT_EQ(kinds[0].color_index, 0.5);
    EXPECT_EQ(kinds_of(catalogue, 9.0).size(), 2u);
}

TEST(RandomStars, TheMainSequenceIsSalpeters) {
    const std::vector<StarKind> kinds = main_sequence();
    // Of stars between 0.1 and 30 solar masses, (1 - 30^-1.35) / (0.1^-1.35 - 30^-1.35) are above one.
    const auto brighter =
        std::ranges::count_if(kinds, [](const StarKind& k) { return k.absolute_magnitude < 4.83; });
    EXPECT_NEAR(double(brighter) / double(kinds.size()),
                (1.0 - std::pow(30.0, -1.35)) / (std::pow(0.1, -1.35) - std::pow(30.0, -1.35)), 2e-4);
    for (const StarKind& kind : kinds) {
        const double mass = std::pow(10.0, (4.83 - kind.absolute_magnitude) / 8.75);
        EXPECT_NEAR(star_temperature(*kind.color_index), 5772.0 * std::pow(mass, 0.475), 0.1);
    }
}

TEST(RandomStars, PathsAreSimplifiedWithinTheTolerance) {
    using Path = std::vector<glm::dvec3>;
    EXPECT_EQ(simplified_path(Path{{1, 2, 3}}, 0.1), (Path{{1, 2, 3}}));
    EXPECT_EQ(simplified_path(Path{{0, 0, 0}, {1, 0, 0}, {2, 0.05, 0}, {9, 0, 0}}, 0.1),
              (Path{{0, 0, 0}, {9, 0, 0}}));
    EXPECT_EQ(simplified_path(Path{{0, 0, 0}, {5, 1, 0}, {0, 0, 0}}, 0.1),
              (Path{{0, 0, 0}, {5, 1, 0}, {0, 0, 0}}));
    EXPECT_EQ(simplified_path(Path(50, {4, 4, 4}), 0.1), (Path{{4, 4, 4}}));
    Path circle;
    for (int i = 0; i <= 1000; ++i)
        circle.push_back({10 * std::cos(i * 0.00628), 10 * std::sin(i * 0.00628), 0});
    const Path left = simplified_path(circle, 0.1);
    EXPECT_GT(left.size(), 15u);
    EXPECT_LT(left.size(), 50u);
}

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

// Gaia's archive, VizieR, SIMBAD and Hipparcos-2 (I/311), a row of each.
TEST(NamedColumns, ArchivesAreRead) {
    const StarCatalogue gaia = parse(
        "solution_id,DESIGNATION,ra,ra_error,dec,dec_error,parallax,phot_g_mean_mag,bp_rp,l,b\n"
        "1,\"Gaia DR3 1\",94.25,0.1,51.5,0.1,20,5.898,0.82,7,8\n");
    // G - V = -0.02704 + 0.01424 C - 0.2156 C^2 + 0.01426 C^3, Riello et al. 2021.
    expect_star(gaia.stars.at(0), 94.25, 51.5, 50, 5.898 + 0.02704 - 0.0116768 + 0.14496944 - 0.00786250768);
    for (const char* const far : {"-0.51", "5.01", ""})
        EXPECT_EQ(parse(fmt::format("ra,dec,phot_g_mean_mag,bp_rp\n1,2,7,{}\n", far)).stars.at(0).magnitude,
                  7.0);
    // 5040 / (0.4929 + 0.5092 C - 0.0353 C^2), Mucciarelli et al. 2021.
    EXPECT_NEAR(star_temperature(gaia.stars[0].color_index.value()),
                5040.0 / (0.4929 + 0.417544 - 0.02373572), 1e-6);
    expect_star(parse("#Title: x\n#Column _RAJ2000\n\n_RAJ2000\tRAJ2000\t_DEJ2000\tVmag\tPlx\tB-V\n"
                      "deg\t\"h:m:s\"\tdeg\tmag\tmas\tmag\n-----\t---\t---\t----\t---\t---\n"
                      "94.25\t06 17 00\t-51.5\t5.5\t20\t0.5\n")
                    .stars.at(0),
                94.25, -51.5, 50, 5.5);
    const StarCatalogue clock =
        parse("MAIN_ID|RA|DEC|FLUX_B|FLUX_V|PLX_VALUE\n* alf CMa|06 45 08.4|-16:42:36|-1.46|-1.5|400\n");
    expect_star(clock.stars.at(0), 15.0 * (6.0 + 45.0 / 60.0 + 8.4 / 3600.0), -16.71, 2.5, -1.5);
    EXPECT_NEAR(clock.stars[0].color_index.value(), 0.04, 1e-12);
    EXPECT_EQ(clock.bad.count, 0);
    expect_star(parse("ra_d;dec_d;V;B\n10;20;3;4\n").stars.at(0), 10, 20, 0, 3);
    EXPECT_EQ(parse("ra,dec,mag,b\n10,20,3,80\n").stars.at(0).color_index, std::nullopt)
        << "a galactic latitude";
    const Said said;
    const double radian = 180.0 / 3.14159265358979324;
    expect_star(parse("HIP;RArad;DErad;Plx;Hpmag;B-V\n1;1.5;-0.5;4;9.25;0.4\n2;0;0;4;9;0.4\n").stars.at(0),
                1.5 * radian, -0.5 * radian, 250, 9.25);
    ASSERT_EQ(said.warnings.size(), 2u);
    EXPECT_EQ(said.warnings[0], "stars: hpmag is taken for V, of 2 stars");
    EXPECT_EQ(said.warnings[1], "stars: RArad and DErad are 2 pi and pi / 2 at most: taken for radians");
    expect_star(parse("RArad;DErad;Hpmag\n1.5;-0.5;9\n200;0;9\n").stars.at(0), 1.5, -0.5, 0, 9);
}

TEST(NamedColumns, HoursAreKnownByTheirRange) {
    std::string sky = "ra,dec,mag\n";
    for (int i = 0; i < 8; ++i) sky += fmt::format("{},{},3\n", 3 * i, 15 * i - 60);
    const Said said;
    expect_star(parse(sky).stars.at(7), 315, 45, 0, 3);
    EXPECT_EQ(said.one_warning(), "stars: its ra is 24 at most: taken for hours");
    expect_star(parse(sky + "25,0,3\n").stars.at(7), 21, 45, 0, 3);
    expect_star(parse("ra,dec,mag\n3,0,3\n6,80,3\n").stars.at(1), 6, 80, 0, 3);
    // HYG as a spreadsheet leaves it.
    const std::string hyg =
        "id,proper,ra,dec,dist,mag,ci\n0,Sirius,6.75,-16.75,2.5,-1.5,0\n1,,20,1,100000,9,1\n";
    expect_star(parse(hyg).stars.at(0), 101.25, -16.75, 2.5, -1.5);
    expect_star(parse(hyg).stars.at(1), 300, 1, 0, 9);
    EXPECT_EQ(said.warnings.size(), 1u) << "the same words once";
    expect_star(parse(hyg + "2,,200,0,1,1,1\n").stars.at(0), 6.75, -16.75, 2.5, -1.5);
}

TEST(NamedColumns, WhatIsNotKnownCostsNoStar) {
    for (const char* none : {"", "--", "---", "N/A", "n/a", "NA", "null", "NULL", "None", "\"\"", "~"}) {
        const StarCatalogue read =
            parse(fmt::format("ra,dec,mag,plx,bv,bp_rp\n1,2,3,{0},{0},{0}\n1,2,3,10,0.5,0.5\n", none));
        ASSERT_EQ(read.stars.size(), 2u) << none;
        expect_star(read.stars[0], 1, 2, 0, 3);
        EXPECT_FALSE(read.stars[0].color_index.has_value());
    }
}

TEST(NamedColumns, AHeaderMayBeAComment) {
    const StarCatalogue read = parse("# stars\n#ra,dec,mag\n10,20,3\n1,2,x\n");
    expect_star(read.stars.at(0), 10, 20, 0, 3);
    EXPECT_EQ(read.bad.lines, (std::vector<std::int64_t>{4}));
    expect_star(parse("#ra,dec,mag\nmag,dec,ra\n3,20,10\n").stars.at(0), 10, 20, 0, 3);
    EXPECT_THAT(error_of("# stars\n10,20,3\n"), HasSubstr("line 2: expected"));
    const TempFolder folder;
    EXPECT_EQ(kind_of_catalogue(folder.file("a.csv", "#ra,dec,mag\n10,20,3\n")), CatalogueKind::sky);
    EXPECT_EQ(kind_of_catalogue(folder.file("b.csv", "#ra,dec\n10,20,3\n")), CatalogueKind::none);
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
        "found no ra, dec, mag in 'hello'");
    EXPECT_THAT(error_of("id,ra,Dec,flux\n1,2,3,4\n"), HasSubstr("found no mag in 'id,ra,Dec,flux'"));
    EXPECT_THAT(error_of(std::string("\x01\x02\n\x03", 4)), HasSubstr("in '\\x01\\x02'"));
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
    gzwrite(out, text.data(), unsigned(text.size()));
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
    const fs::path cut = folder.file("cut.dat.gz", packed.substr(0, packed.size() / 2));
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
