// Stars of a picture: those that are found, those too wide for one splat, and their places in depth.
#include "bodies/stars.h"
#include "bodies/bodies.h"
#include "bodies/picture_light.h"
#include "bodies/picture_splats.h"
#include "bodies/star_places.h"
#include "detect/peaks.h"
#include "image/channels.h"
#include "splats/splat_set.h"
#include "support/painted_picture.h"
#include "support/test.h"
#include "unit/bodies/bodies_support.h"

namespace astrosplat {
namespace {

// A sky that is brighter on one side, with a little texture.
Image sky(std::int64_t width = 256, std::int64_t height = 128) {
    Image image = make_image(width, height, 3);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                image.at(x, y)[c] = 0.02f + 0.1f * float(x) / float(width) +
                                    0.004f * painted::fbm(double(x), double(y), 0.11, 7u);
    return image;
}

// Stars as a camera records them: flat where they are brighter than white.
Image saturated(Image image) {
    for (float& value : image.pixels) value = std::min(value, 1.0f);
    return image;
}

struct Planted {
    double x, y, sigma, light;
};
const std::vector<Planted> planted{{40.3, 30.8, 0.9, 0.3},
                                   {90.0, 80.5, 1.2, 0.8},
                                   {150.6, 40.1, 1.5, 0.5},
                                   {200.2, 90.9, 0.8, 0.25},
                                   {60.7, 100.2, 1.0, 0.6}};

Image with_planted(Image light) {
    for (const Planted& p : planted)
        painted::add_point(light, p.x, p.y, p.sigma, p.light, 0.8 * p.light, 0.6 * p.light);
    return light;
}

TEST(Stars, AreFoundWhereTheyAreAndTakenOut) {
    const Image before = sky();
    Image light = with_planted(before);
    const std::vector<Star> stars = take_stars(light);
    ASSERT_EQ(stars.size(), planted.size());
    for (const Planted& p : planted) {
        const Star* nearest = &stars.front();
        for (const Star& s : stars)
            if (std::hypot(s.x - p.x, s.y - p.y) < std::hypot(nearest->x - p.x, nearest->y - p.y))
                nearest = &s;
        EXPECT_NEAR(nearest->x, p.x, 0.2);
        EXPECT_NEAR(nearest->y, p.y, 0.2);
        EXPECT_NEAR(nearest->sigma, p.sigma, 0.25 * p.sigma);
        EXPECT_NEAR(nearest->peak.x, p.light, 0.25 * p.light);
        EXPECT_GT(nearest->peak.x, nearest->peak.z);
    }
    for (std::size_t i = 0; i < light.pixels.size(); ++i)  // what wings are cut to
        ASSERT_NEAR(light.pixels[i], before.pixels[i], 0.016f + 0.15f * before.pixels[i])
            << "pixel " << i / 3;
}

TEST(Stars, KnotsAndEdgesAreNone) {
    Image light = sky();
    painted::add_point(light, 80.0, 60.0, 4.0, 0.5, 0.5, 0.5);  // wider than a star
    for (int i = 0; i < 40; ++i) painted::add_point(light, 150.0 + i, 50.0, 0.9, 0.2, 0.2, 0.2);  // a thread
    const Image before = light;
    EXPECT_TRUE(take_stars(light).empty());
    for (std::size_t i = 0; i < light.pixels.size(); ++i) ASSERT_EQ(light.pixels[i], before.pixels[i]);
}

// A flat top is narrower than the Gaussian of its peak and light: the ring around would be a hole,
// and so dust.
TEST(Stars, FlatOnesLeaveNoHole) {
    Image light = make_image(128, 96, 3, 0.05f);
    painted::add_point(light, 60.4, 50.3, 0.9, 1.6, 1.6, 1.6);
    for (float& value : light.pixels) value = std::min(value, 1.0f);
    ASSERT_EQ(take_stars(light).size(), 1u);
    for (std::size_t i = 0; i < light.pixels.size(); ++i)
        ASSERT_GE(light.pixels[i], 0.044f) << "pixel " << i / 3;
}

// Left in, each of them would be a row of faint splats in depth.
TEST(Stars, FaintOnesInADarkSkyAreTaken) {
    Image light = make_image(256, 128, 3, 0.006f);
    for (std::uint32_t i = 0; i < 20; ++i)
        painted::add_point(light, 20.0 + 11.3 * i, 30.0 + 61.0 * painted::random(i, 1), 0.9, 0.025, 0.02,
                           0.02);
    EXPECT_EQ(take_stars(light).size(), 20u);
}

// The narrowest Gaussian of a single pixel has most of its light beside it, where the picture has none.
TEST(Stars, OfEnlargedPicturesAreOnlyWhatHasTheLightOfOne) {
    Image light = with_planted(sky());
    for (int c = 0; c < 3; ++c) light.at(120, 30)[c] += 0.5f;
    const StructureParams params = of_kind(StructureKind::sheet);
    Image whole = light, enlarged = light;
    EXPECT_EQ(take_picture_stars(whole, params).all.size(), planted.size() + 1);
    EXPECT_EQ(take_picture_stars(enlarged, params, true).all.size(), planted.size());
    EXPECT_EQ(enlarged.at(120, 30)[0], light.at(120, 30)[0]);
}

// Between the texels of an enlarged picture light is flat: what it differs by from a Gaussian is not the
// star's.
TEST(Stars, OfEnlargedPicturesAreGaussiansAloneWhereTheseAreNear) {
    Image light = sky();
    for (int i = 0; i < 5; ++i) painted::add_point(light, 30.4 + 40.0 * i, 60.3, 1.4, 0.5, 0.4, 0.3);
    painted::add_point(light, 230.4, 60.3, 1.1, 2.5, 2.5, 2.5);
    light = saturated(std::move(light));
    Image enlarged = light;
    const StructureParams params = of_kind(StructureKind::sheet);
    const auto beside = [](const PictureStars& stars, bool flat) {
        return std::ranges::count_if(stars.rest, [&](const SpikeLight& rest) {
            return (stars.all[std::size_t(rest.star)].x > 220.0f) == flat;
        });
    };
    const PictureStars whole = take_picture_stars(light, params),
                       of_enlarged = take_picture_stars(enlarged, params, true);
    ASSERT_EQ(whole.count, 6);
    ASSERT_EQ(of_enlarged.count, 6);
    EXPECT_GT(beside(whole, false), 20);
    EXPECT_EQ(beside(of_enlarged, false), 0);
    EXPECT_GT(beside(of_enlarged, true), 10);
}

TEST(Knots, OwnThePixelsAroundThem) {
    Image light = sky();
    painted::add_point(light, 80.0, 60.0, 3.0, 0.5, 0.5, 0.5);
    const Image brightest = brightest_channel(light);
    const Knots knots = find_knots(brightest);
    ASSERT_EQ(knots.knots.size(), 1u);
    EXPECT_NEAR(knots.knots[0].x, 80.0, 1.0);
    EXPECT_NEAR(knots.knots[0].y, 60.0, 1.0);
    EXPECT_GT(knots.knots[0].sigma, 2.0f);
    EXPECT_LT(knots.knots[0].sigma, 5.0f);
    const auto at = [&](std::int64_t x, std::int64_t y) { return std::size_t(y * 256 + x); };
    EXPECT_EQ(knots.owner[at(80, 60)], 0);
    EXPECT_EQ(knots.weight[at(80, 60)], 1.0f);
    const auto rim = std::int64_t(80.0f + 2.6f * knots.knots[0].sigma);
    EXPECT_GT(knots.weight[at(rim, 60)], 0.0f);
    EXPECT_LT(knots.weight[at(rim, 60)], 0.6f);
    EXPECT_EQ(knots.owner[at(200, 100)], -1);
}

TEST(Knots, ThoseOfAFilamentAreNotRound) {
    Image light = make_image(320, 200, 3, 0.05f);
    painted::add_point(light, 60.0, 100.0, 3.0, 0.5, 0.5, 0.5);
    for (int i = 0; i < 60; ++i)  // slanted, with bright places
        painted::add_point(light, 130.0 + 2.0 * i, 40.0 + 1.5 * i, 2.5, 0.10 + 0.006 * (i % 10 == 5), 0.1,
                           0.1);
    const Knots found = find_knots(brightest_channel(light));
    int along = 0;
    for (const Knot& knot : found.knots) {
        if (knot.x < 100.0f) {
            EXPECT_GT(knot.roundness, 0.95f);
        } else if (knot.x > 145.0f && knot.x < 235.0f) {
            EXPECT_LT(knot.roundness, 0.3f) << knot.x << ", " << knot.y;
            ++along;
        }
    }
    EXPECT_GE(along, 3);
}

// A star of one pixel is narrower than its Gaussian. Where there is dust, the hole around it
// would become some.
TEST(Stars, LeaveNoHolesInDisksAndNoLightInClouds) {
    for (const StructureKind kind : {StructureKind::disk, StructureKind::sheet, StructureKind::walls}) {
        Image light = make_image(64, 48, 3, 0.05f);
        for (int c = 0; c < 3; ++c) light.at(30, 20)[c] = 0.6f;
        ASSERT_EQ(take_picture_stars(light, of_kind(kind)).count, 1);
        if (kind == StructureKind::disk)
            EXPECT_NEAR(light.at(31, 20)[0], least_left_in_dust * 0.05f, 1e-6f);
        else
            EXPECT_LT(light.at(31, 20)[0], 0.5f * 0.05f);
    }
}

// Flat tops, wings and close neighbours are no Gaussians: what these leave is drawn beside them, so that the
// bands need not make up for it.
TEST(Stars, AreWithWhatIsBesideTheirGaussiansAllThatWasTaken) {
    Image light = sky();
    for (std::uint32_t i = 0; i < 24; ++i) {
        const double x = 20.3 + 9.1 * i, y = 30.0 + 61.0 * painted::random(i, 1), sigma = 0.8 + 0.03 * i;
        painted::add_point(light, x, y, sigma, 2.0, 1.6, 1.2);
        painted::add_point(light, x, y, 3.0 * sigma, 0.05, 0.05, 0.05);
        painted::add_point(light, x + 5.5, y + 1.2, 0.8 * sigma, 0.4, 0.3, 0.3);
    }
    light = saturated(std::move(light));
    const Image before = light;
    const PictureStars stars = take_picture_stars(light, of_kind(StructureKind::sheet));
    ASSERT_GE(stars.count, 24);
    Image sum = light;
    for (const Star& star : stars.all)
        painted::add_point(sum, star.x, star.y, star.sigma, star.peak.x, star.peak.y, star.peak.z);
    for (const SpikeLight& rest : stars.rest) {
        const Star& star = stars.all[std::size_t(rest.star)];
        EXPECT_LT(std::hypot(star.x - float(rest.column), star.y - float(rest.row)), 12.0f);
        for (int c = 0; c < 3; ++c) sum.at(rest.column, rest.row)[c] += rest.light[c];
    }
    double taken = 0.0, off = 0.0;
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
        taken += double(before.pixels[i] - light.pixels[i]);
        off += std::fabs(double(sum.pixels[i] - before.pixels[i]));
    }
    EXPECT_LT(off, 0.05 * taken);
}

// The fit takes the splats of a range for as wide as each other.
TEST(Stars, ThoseOfARangeAreAboutOfOneSize) {
    Image image = sky(512, 256);
    for (int i = 0; i < 28; ++i)
        painted::add_point(image, 40.3 + 32.0 * (i % 14), 60.7 + 100.0 * (i / 14), 0.7 + 0.05 * i, 0.5, 0.5,
                           0.5);
    const StructureParams params = of_kind(StructureKind::sheet);
    const PictureStars stars = take_picture_stars(image, params);
    ASSERT_GT(stars.count, 20);
    PictureSplats set;
    add_picture_stars(stars, placement_without_fields(512, 256, params, 100.0), {}, set);
    ASSERT_EQ(set.splats.size(), stars.count);
    EXPECT_GE(set.ranges.size(), 3u);
    for (const SplatRange& range : set.ranges)
        for (std::int64_t i = range.begin; i < range.end; ++i)
            EXPECT_NEAR(set.splats.radius[std::size_t(i)] / radius_sigmas, range.sigma, 0.25f * range.sigma);
}

TEST(Knots, ThereAreNoneInAnEvenSky) { EXPECT_TRUE(find_knots(brightest_channel(sky())).knots.empty()); }

// Stars that are too wide and too bright for one Gaussian: taken whole, and in one place in depth.

constexpr float sky_light = 0.03f;

Image with_star(double x, double y, double sigma) {
    Image image = make_image(320, 200, 3, sky_light);
    painted::add_point(image, x, y, sigma, 4.0, 3.0, 2.5);
    return saturated(std::move(image));
}

TEST(BrightStars, AreTakenWholeWithoutAHole) {
    struct Case {
        double x, y, sigma, half_width;
    };
    // 4 e^(-r^2 / 2 sigma^2) is .5 at sigma sqrt(2 ln 8)
    for (const Case& c : {Case{150.3, 90.7, 1.6, 3.3}, {120.6, 110.2, 3.0, 6.1}, {160.0, 100.4, 5.0, 10.2}}) {
        Image light = with_star(c.x, c.y, c.sigma);
        const Image before = light;
        const std::vector<Star> stars = take_bright_stars(light);
        ASSERT_GE(stars.size(), 1u) << c.sigma;
        double flux = 0.0, taken = 0.0;
        for (const Star& star : stars) {
            EXPECT_EQ(star.body, 0u);
            EXPECT_NEAR(star.x, c.x, 0.3);
            EXPECT_NEAR(star.y, c.y, 0.3);
            EXPECT_LT(star.sigma, 2.5 * c.half_width);
            flux += 6.2831853 * double(star.sigma * star.sigma * star.peak.x);
        }
        for (std::size_t i = 0; i < light.pixels.size(); i += 3) {
            taken += double(before.pixels[i] - light.pixels[i]);
            ASSERT_GE(light.pixels[i], 0.89f * sky_light) << "pixel " << i / 3;
            ASSERT_LE(light.pixels[i], before.pixels[i]);
        }
        EXPECT_NEAR(taken / flux, 1.0, 0.08) << c.sigma;
        double all = 0.0;
        for (std::size_t i = 0; i < light.pixels.size(); i += 3) all += double(before.pixels[i] - sky_light);
        EXPECT_GT(taken, 0.4 * all) << c.sigma;  // no sum of Gaussians has an edge so steep
    }
}

// Light of the red channel of the star there, px^2; 0 where none is.
double light_at(const std::vector<Star>& stars, float x, float y) {
    double sum = 0.0;
    for (const Star& star : stars)
        if (std::hypot(star.x - x, star.y - y) < 0.5f)
            sum += 6.2831853 * double(star.sigma * star.sigma * star.peak.x);
    return sum;
}

TEST(BrightStars, TheirSpikesAndNeighboursDoNotHideThem) {
    Image light = with_star(150.5, 90.5, 3.0), alone = light;
    for (std::int64_t i = -40; i <= 40; ++i)
        for (int c = 0; c < 3; ++c) {
            light.at(150 + i, 90)[c] = std::max(light.at(150 + i, 90)[c], 0.4f);
            light.at(150, 90 + i)[c] = std::max(light.at(150, 90 + i)[c], 0.4f);
        }
    for (const double angle : {0.6, 2.0, 3.9, 5.2})
        painted::add_point(light, 150.5 + 18.0 * std::cos(angle), 90.5 + 18.0 * std::sin(angle), 1.8, 2.0,
                           2.0, 2.0);
    light = saturated(std::move(light));
    const double expected = light_at(take_bright_stars(alone), 150.5f, 90.5f);
    ASSERT_GT(expected, 0.0);
    EXPECT_NEAR(light_at(take_bright_stars(light), 150.5f, 90.5f), expected, 0.1 * expected);
}

// Of knots of nebulae and star clusters, threads, faint stars, and those that take_stars() finds.
TEST(BrightStars, NothingElseIsTaken) {
    Image light = make_image(480, 200, 3, sky_light);
    for (std::uint32_t i = 0; i < 60; ++i)  // a cluster
        painted::add_point(light, 90.0 + 14.0 * (painted::random(i, 1) - 0.5),
                           100.0 + 14.0 * (painted::random(i, 2) - 0.5), 0.9, 0.5, 0.5, 0.6);
    for (int i = 0; i < 40; ++i) painted::add_point(light, 170.0 + i, 60.0, 2.5, 0.3, 0.2, 0.2);
    painted::add_point(light, 250.0, 130.0, 3.0, 0.2, 0.2, 0.2);
    painted::add_point(light, 300.0, 60.0, 1.0, 0.9, 0.9, 0.9);
    painted::add_point(light, 390.0, 100.0, 25.0, 0.9, 0.8, 0.6);  // a bulge
    const Image before = light;
    EXPECT_TRUE(take_bright_stars(light).empty());
    for (std::size_t i = 0; i < light.pixels.size(); ++i) ASSERT_EQ(light.pixels[i], before.pixels[i]);
}

// Light of a star that no Gaussian fits would be beads one above the other, seen from the side.
TEST(BrightStars, WhatTheyLeaveIsAtTheirDepth) {
    const std::int64_t width = 480, height = 300;
    Image image = painted::galaxy(width, height);
    const double x = 330.5, y = 205.5;  // where the disk is faint
    painted::add_point(image, x, y, 2.5, 4.0, 3.0, 2.5);
    image = saturated(std::move(image));
    const SplatSet set = make_bodies({on_plane(image)}, of_kind(StructureKind::disk), 5u, "disk");
    const double texel = 10.0 / double(width);
    double depth = 0.0, star = 0.0, near_light = 0.0, far_light = 0.0;
    const auto light_of = [&](std::size_t i) {
        const double r = double(set.radius[i]) / texel;
        return double(std::max(0.0f, set.color[i].x) * set.alpha[i]) * r * r;
    };
    const auto away = [&](std::size_t i) {
        return std::hypot(double(set.position[i].x) / texel + 0.5 * width - x,
                          double(set.position[i].z) / texel + 0.5 * height - y);
    };
    for (std::size_t i = 0; i < set.id.size(); ++i) {
        if (!is_star(set.id[i]) || away(i) > 1.0) continue;
        star += light_of(i);
        depth += light_of(i) * double(set.position[i].y);
    }
    ASSERT_GT(star, 0.0);
    depth /= star;
    for (std::size_t i = 0; i < set.id.size(); ++i) {
        if (is_star(set.id[i]) || away(i) > 3.0 || set.radius[i] > 3.0 * texel) continue;
        const bool near = std::fabs(double(set.position[i].y) - depth) < 6.0 * texel;
        (near ? near_light : far_light) += light_of(i);
    }
    EXPECT_GT(near_light, 0.0);
    EXPECT_LT(far_light, 0.05 * near_light);
}

// Stars of a picture in depth: each on its ray to the picture's camera, and before what would hide it.

// 10 units wide and 5 high, in xz, its front up.
TexturedMesh plane_with_picture() { return on_plane(make_image(200, 100, 3, 1.0f)); }

TEST(StarPlaces, ASlabHoldsTheNearestInFrontAndTheFarthestBehind) {
    const TexturedMesh mesh = plane_with_picture();
    StarDepths depths;
    depths.slab = 2.0;
    const std::array stars{SeenStar{{0.5f, 0.5f}, 0.0f}, SeenStar{{0.25f, 0.75f}, 1.0f},
                           SeenStar{{1.5f, 0.5f}, 0.5f}};
    const PlacedStars placed = place_stars(mesh, stars, depths);
    ASSERT_EQ(placed.star, (std::vector<std::size_t>{0, 1})) << "what the mesh does not show is left out";
    const std::array expected{glm::vec3(0.0f, 1.0f, 0.0f), glm::vec3(-2.5f, -1.0f, -1.25f)};
    for (std::size_t i = 0; i < expected.size(); ++i)
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(placed.position[i][k], expected[i][k], 1e-5f) << i << " " << k;
    EXPECT_NEAR(placed.distance[1], 1.0f, 1e-5f);
    EXPECT_NEAR(placed.texel_side, 0.05, 1e-9);
    EXPECT_EQ(placed.height_texels, 100.0);
    EXPECT_EQ(shown_picture(mesh), &mesh.textures[0]);
    EXPECT_EQ(shown_picture(TexturedMesh{}), nullptr);
}

TEST(StarPlaces, WhatHidesAStarLetsItThroughInFront) {
    const PlacedStars placed =
        place_stars(plane_with_picture(),
                    std::array{SeenStar{{0.5f, 0.5f}, 1.0f}, SeenStar{{0.1f, 0.1f}, 1.0f}}, {2.0, {}, 1});
    ASSERT_EQ(placed.position.size(), 2u);
    std::vector<glm::vec3> position = placed.position;
    SplatSet splats;  // opaque, half a unit wide, before the first star and far from the second
    splats.position = {glm::vec3(0.0f)};
    splats.color = {glm::vec3(1.0f)};
    splats.alpha = {1.0f};
    splats.radius = {0.5f};
    FrontView view;
    view.camera = placed.camera;
    view.height_px = 100.0;
    const std::vector<glm::dvec3> light = passing_light(view, splats, position);
    EXPECT_EQ(light, std::vector<glm::dvec3>(2, glm::dvec3(1.0)));
    EXPECT_GE(position[0].y, 0.0f) << "moved before the splat";
    EXPECT_LT(position[0].y, 0.1f) << "and no farther";
    EXPECT_NEAR(position[0].x, 0.0f, 1e-4f);
    EXPECT_EQ(position[1], placed.position[1]);
}

}  // namespace
}  // namespace astrosplat
