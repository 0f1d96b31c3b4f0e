// Random stars fill their tube evenly, and are of the kinds they are drawn from.
#include "stars/star_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "catalogues.h"

namespace astrosplat {
namespace {

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
