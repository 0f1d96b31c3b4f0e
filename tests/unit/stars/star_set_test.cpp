// Sets of stars: places, brightness, colours, and random ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "catalogues.h"
#include "stars/star_set.h"
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
    return static_cast<double>(count) / static_cast<double>(set.size());
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
    EXPECT_NEAR(static_cast<double>(red) / 30000.0, 1.0 / 3.0, 0.01);
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
    EXPECT_NEAR(static_cast<double>(brighter) / static_cast<double>(kinds.size()),
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

}  // namespace
}  // namespace astrosplat
