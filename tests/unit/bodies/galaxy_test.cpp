// Galaxies: how one lies in its picture, and the body that it becomes.
#include "bodies/galaxy_body.h"

#include "bodies/dust.h"
#include "bodies/galaxies.h"
#include "bodies/galaxy_fit.h"
#include "bodies/picture_splats.h"
#include "bodies/placement.h"
#include "image/channels.h"
#include "support/painted_picture.h"
#include "support/test.h"

namespace astrosplat {
namespace {

constexpr double degree = 3.14159265358979 / 180.0;

GalaxyPlane plane_of(double inclination_deg, double angle_deg = 30.0, int near_side = 1) {
    return {0.5, 0.4, angle_deg * degree, inclination_deg, near_side};
}

GalaxyBody body_of(double inclination_deg, double angle_deg = 30.0, int near_side = 1) {
    GalaxyLight light;
    light.disk = {{0.05, 1.0}, {0.15, 2.0}};
    light.spheroid = {{0.03, 1.0}};
    light.disk_ratio = std::cos(inclination_deg * degree);
    light.spheroid_ratio = 0.8;
    light.bulge = 0.25;
    return make_galaxy_body(light, plane_of(inclination_deg, angle_deg, near_side), {}, 1000.0);
}

TEST(GalaxyBody, PlacesGoToItsDiskAndBack) {
    for (const int near_side : {1, -1}) {
        const GalaxyBody body = body_of(62.0, 130.0, near_side);
        const glm::vec3 p(610.0f, 333.0f, -41.0f), back = body.in_picture(body.in_disk(p.x, p.y, p.z));
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(back[k], p[k], 1e-3f);
        EXPECT_NEAR(glm::dot(body.major, body.near), 0.0f, 1e-6f);
        // A place on the near side of the plane is nearer to the viewer.
        const glm::vec3 near = body.in_picture({0.0f, 100.0f, 0.0f});
        EXPECT_NEAR(near.z, 100.0 * std::sin(62.0 * degree), 1e-3);
        EXPECT_GT(glm::dot(glm::vec2(near) - body.center, body.near), 0.0f);
    }
    // From right, 30 degrees counter-clockwise; rows count down.
    EXPECT_NEAR(body_of(40.0).major.y, -0.5f, 1e-6f);
    EXPECT_NEAR(body_of(40.0).near.x, -0.5f, 1e-6f);
}

// A Gaussian in space along a line of sight is a Gaussian: against sums over its depth.
TEST(GalaxyBody, DepthsAreThoseOfGaussiansInSpace) {
    const double c = std::cos(70.0 * degree), s = std::sin(70.0 * degree);
    const GalaxyBody body = body_of(70.0);
    for (const GalaxyPart part : {GalaxyPart::disk, GalaxyPart::spheroid}) {
        for (const LineGaussian& g : body.parts[std::size_t(part)]) {
            const double S2 = 0.5 / double(g.u2), V = 0.5 / double(g.v2);
            const double t2 = (V - S2 * c * c) / (s * s), v = 37.0;
            double all = 0.0, mean = 0.0, square = 0.0;
            for (double z = -900.0; z <= 900.0; z += 0.5) {
                const double y = v * c + z * s, h = z * c - v * s;
                const double density = std::exp(-0.5 * (y * y / S2 + h * h / t2));
                all += density, mean += density * z, square += density * z * z;
            }
            mean /= all;
            EXPECT_NEAR(v * double(g.slope), mean, 1e-3 * std::fabs(mean) + 1e-3);
            EXPECT_NEAR(g.deviation, std::sqrt(square / all - mean * mean), 2e-3 * g.deviation);
        }
    }
}

// Cut nearer than its light ends, a spheroid has straight sides.
TEST(GalaxyBody, ASpheroidEndsAsAGaussianDoes) {
    const GalaxyBody body = body_of(70.0);
    const LineGaussian g = body.parts[std::size_t(GalaxyPart::spheroid)].at(0);
    const auto off = [&](float share) {
        return depth_of(body, GalaxyPart::spheroid, body.center.x, body.center.y, share) / g.deviation;
    };
    constexpr std::pair<float, float> quantiles[] = {
        {0.5f, 0.0f}, {0.8413447f, 1.0f}, {0.9772499f, 2.0f}, {0.9986501f, 3.0f}};
    for (const auto& [share, deviations] : quantiles) {
        EXPECT_NEAR(off(share), deviations, 0.03f);
        EXPECT_NEAR(off(1.0f - share), -deviations, 0.03f);
    }
}

TEST(GalaxyBody, ABulgeSeenFromAboveIsAsHighAsOthers) {
    const LineGaussian g = body_of(0.0).parts[std::size_t(GalaxyPart::spheroid)].at(0);
    EXPECT_NEAR(g.deviation, 0.7 * 30.0, 0.01);
}

TEST(GalaxyBody, WhatIsSmallLiesInItsPlane) {
    for (const double inclination : {0.0, 45.0, 75.0}) {
        const GalaxyBody body = body_of(inclination);
        double square = 0.0;
        constexpr int count = 2000;
        for (int i = 0; i < count; ++i) {
            const auto random = [&](std::uint32_t k) {
                return shared::as_uniform(shared::as_hash(7u, std::uint32_t(i), k, 1u));
            };
            const float x = 500.0f + 60.0f * (random(0) - 0.5f), y = 400.0f + 20.0f * (random(1) - 0.5f);
            const float z = depth_of(body, GalaxyPart::fine, x, y, random(2));
            square += std::pow(body.in_disk(x, y, z).z, 2) / count;
        }
        EXPECT_NEAR(std::sqrt(square), body.thickness, 0.15 * body.thickness) << inclination;
    }
}

TEST(GalaxyBody, StarsFollowTheirShares) {
    const GalaxyBody body = body_of(60.0);
    float before = -1e9f;
    for (const float u : {0.01f, 0.25f, 0.5f, 0.75f, 0.99f}) {
        const float z = star_depth(body, 520.0f, 380.0f, u, 0.6f);
        EXPECT_GT(z, before);
        before = z;
    }
    const auto within = [&](float in_disk) {  // of half of the stars
        return star_depth(body, 500.0f, 400.0f, 0.75f, in_disk) -
               star_depth(body, 500.0f, 400.0f, 0.25f, in_disk);
    };
    EXPECT_LT(within(1.0f), 0.5f * within(0.0f));
}

StructureParams galaxy_params(double inclination) {
    StructureParams params;
    params.kind = StructureKind::disk;
    params.galaxy = {inclination, 20.0, glm::dvec2(0.5, 0.5), 110.0, {}};
    return params;
}

// What a sight keeps is that of its picture, not of where the hand was before.
TEST(GalaxySight, FindsTheSameAfterOtherModels) {
    const Image light = painted::tilted_galaxy(320, 200, {60.0, 20.0, true, 6.0, 0.0});
    std::vector<StructureParams> dragged(10, galaxy_params(60.0));
    dragged[1].galaxy.inclination = 40.0;
    dragged[2].galaxy.near_side = 290.0;
    dragged[3].galaxy.center = glm::dvec2(0.55, 0.5);
    dragged[4].galaxy.bulge = 1.0;
    dragged[5].galaxies = {dragged[0].galaxy, dragged[3].galaxy};
    for (const std::size_t k : {7u, 8u, 9u}) dragged[k].galaxy.inclination = k == 9 ? 80.0 : 74.0;
    dragged[8].spiral = 0.4;
    GalaxySight sight{true, {}, {}, {}};
    for (const StructureParams& now : dragged) {
        GalaxySight fresh{true, {}, {}, {}};
        const auto bodies_in = [&](GalaxySight& in) { return galaxies_of(light, now, 1.0, 320, 0, 1, &in); };
        const std::vector<GalaxyBody> seen = bodies_in(sight), wanted = bodies_in(fresh);
        ASSERT_EQ(seen.size(), wanted.size());
        for (std::size_t k = 0; k < seen.size(); ++k) {
            for (const auto field : {&GalaxyBody::share, &GalaxyBody::spheroid, &GalaxyBody::excess,
                                     &GalaxyBody::lit, &GalaxyBody::roughness, &GalaxyBody::plane})
                EXPECT_EQ((seen[k].*field).pixels, (wanted[k].*field).pixels) << k;
            EXPECT_EQ(seen[k].thickness, wanted[k].thickness);
            EXPECT_EQ(seen[k].near, wanted[k].near);
            EXPECT_EQ(light_at(seen[k], 170.0f, 90.0f).disk, light_at(wanted[k], 170.0f, 90.0f).disk);
        }
    }
}

TEST(PlacementSight, FindsTheSameAfterOtherModels) {
    const Image light = painted::tilted_galaxy(320, 200, {60.0, 20.0, true, 6.0, 0.0});
    const std::vector<Star> stars = {{100.0f, 80.0f, 2.0f}};
    std::vector<StructureParams> dragged(5, galaxy_params(60.0));
    for (const std::size_t k : {0u, 2u, 4u}) dragged[k].kind = StructureKind::walls;
    dragged[1].kind = StructureKind::sheet;
    dragged[2].depth = 0.7, dragged[2].height = 0.4;
    PlacementSight sight;
    for (const StructureParams& now : dragged) {
        const auto placed_in = [&](PlacementSight* in) {
            return make_placement(light, now, 32.0, true, 1u, stars, {}, {640, 400}, in);
        };
        const Placement seen = placed_in(&sight), wanted = placed_in(nullptr);
        for (const auto field : {&Placement::thickness, &Placement::structure, &Placement::relief})
            EXPECT_EQ((seen.*field).pixels, (wanted.*field).pixels);
        EXPECT_EQ(seen.filled.core_share.pixels, wanted.filled.core_share.pixels);
        EXPECT_EQ(seen.filled.core_reach.pixels, wanted.filled.core_reach.pixels);
        EXPECT_EQ(seen.knot_z, wanted.knot_z);
        EXPECT_EQ(seen.star_knots, wanted.star_knots);
    }
}

// A cloud that something may be taken to has its depth, and most have none to be found.
TEST(GalaxyClouds, OfWhatIsReachedAllAreFound) {
    for (const double margin : {0.0, 0.2}) {
        StructureParams params = galaxy_params(80.0);
        params.margin = margin;
        const auto width = std::int64_t(320.0 * (1.0 + 2.0 * margin)),
                   height = std::int64_t(200 + 2 * 320 * margin);
        const Image light = painted::tilted_galaxy(int(width), int(height), {80.0, 20.0, true, 6.0, 0.0});
        GalaxyBody body = make_placement(light, params, 32.0, true, 1u).galaxies.at(0);
        constexpr std::int64_t finer = 4;  // than of pictures, or its pixels alone reach as far
        body.to_field *= float(finer);
        Image& excess = body.excess =
            unfilled_image(finer * body.excess.width, finer * body.excess.height, 1);
        for (std::size_t i = 0; i < excess.pixels.size(); ++i)
            excess.pixels[i] = i % 997 == 0 || i + 1 == excess.pixels.size() ? 1.0f : 0.0f;
        const std::vector<std::size_t> reached = reached_clouds(body, float(width), float(height));
        const std::size_t clouds = body.clouds.z.size();
        EXPECT_LT(reached.size(), clouds / 2);
        body.clouds.z.assign(clouds, -1e6f);
        for (const std::size_t i : reached) body.clouds.z[i] = 1e6f;
        std::int64_t gathered = 0;
        for (std::uint32_t n = 0; n < 4000; ++n) {
            DepthBlock block;
            for (block.count = 0; block.count < DepthBlock::size; ++block.count) {
                const auto random = [&](std::uint32_t k) {
                    return shared::as_hash(n, std::uint32_t(block.count), k, 1u);
                };
                block.x[block.count] = shared::as_uniform(random(0)) * float(width);
                block.y[block.count] = shared::as_uniform(random(1)) * float(height);
                block.random[block.count] = random(2);
                block.z[block.count] = 0.0f;
            }
            gather_in_clouds(body, block);
            for (int i = 0; i < block.count; ++i) {
                ASSERT_GT(block.z[i], -1e5f) << block.x[i] << ", " << block.y[i];
                gathered += block.z[i] > 1e5f;
            }
        }
        EXPECT_GT(gathered, 500);
    }
}

// Splats of one band of a painted galaxy with a bulge, by family.
struct Families {
    Image light = painted::tilted_galaxy(320, 200, {60.0, 20.0, true, 6.0, 0.0});
    Placement placement = make_placement(light, galaxy_params(60.0), 32.0, true, 1u);
    PictureSplats of(GalaxyFamily family, int band_index) const {
        const Image brightest = brightest_channel(light);
        PictureSplats set;
        const std::vector<Band> bands = make_bands(light.width);
        split_bands(light, bands, false, [&](const Band& band, const Image& image) {
            for (const BandSplats& splats : band_splats(band, false, placement))
                if (band.index == band_index && splats.family == family)
                    add_band(whole_band(image), splats, brightest, {}, placement, {}, set);
        });
        return set;
    }
};

// About the normal a disk's light is flat, and a spheroid's nearly as high as wide.
TEST(GalaxyFamilies, ASpheroidIsRoundAndADiskFlat) {
    const Families families;
    const GalaxyBody& body = families.placement.galaxies.at(0);
    const auto flatness = [&](GalaxyFamily family) {
        const PictureSplats set = families.of(family, 4);
        double along = 0.0, up = 0.0, all = 0.0;
        for (std::size_t i = 0; i < set.splats.position.size(); ++i) {
            const glm::vec3 p = set.splats.position[i];
            const double light = double(set.splats.color[i].y * set.splats.alpha[i] * set.splats.radius[i] *
                                        set.splats.radius[i]);
            const glm::vec3 q = body.in_disk(p.x + 160.0f, 100.0f - p.y, p.z);
            along += light * double(q.x * q.x), up += light * double(q.z * q.z), all += light;
        }
        return std::sqrt(up / along);
    };
    EXPECT_LT(flatness(GalaxyFamily::disk), 0.3);
    EXPECT_GT(flatness(GalaxyFamily::spheroid), 0.4);
    EXPECT_LT(flatness(GalaxyFamily::spheroid), 1.1);
}

// A globular cluster is a spheroid, and its stars are points.
TEST(GalaxyFamilies, WhatIsSharpIsAsSharpInASpheroid) {
    const Families families;
    for (const int band : {0, 1, 2})
        EXPECT_FLOAT_EQ(families.of(GalaxyFamily::spheroid, band).splats.radius[0],
                        families.of(GalaxyFamily::disk, band).splats.radius[0]);
    EXPECT_GT(families.of(GalaxyFamily::spheroid, 3).splats.radius[0],
              families.of(GalaxyFamily::disk, 3).splats.radius[0]);
}

// Sharp light of a cluster that is too wide for a star of the list is at one depth with what it belongs to:
// spread along its line of sight it is a streak from aside.
TEST(GalaxyFamilies, WhatMayBeAStarOfAClusterIsAtOneDepth) {
    Families cluster;
    cluster.light = make_image(320, 200, 3, 0.002f);
    painted::add_point(cluster.light, 160.0, 100.0, 35.0, 0.05, 0.05, 0.05);
    const auto x_of = [](int i) { return 66.0 + 21.0 * (i % 10); };
    const auto y_of = [](int i) { return 48.0 + 21.0 * (i / 10); };
    for (int i = 0; i < 60; ++i) painted::add_point(cluster.light, x_of(i), y_of(i), 1.5, 0.3, 0.3, 0.3);
    StructureParams params = galaxy_params(90.0);
    params.galaxy.bulge = 1.0;
    cluster.placement = make_placement(cluster.light, params, 32.0, true, 1u);
    const PictureSplats set = cluster.of(GalaxyFamily::spheroid, 1);
    int together = 0, all = 0;
    for (int i = 0; i < 60; ++i) {
        std::vector<double> z;
        for (const glm::vec3& p : set.splats.position)
            if (std::hypot(double(p.x) + 160.0 - x_of(i), 100.0 - double(p.y) - y_of(i)) < 2.0)
                z.push_back(double(p.z));
        if (z.empty()) continue;
        std::ranges::sort(z);
        const double middle = z[z.size() / 2];
        together += int(std::ranges::count_if(z, [=](double v) { return std::fabs(v - middle) < 4.0; }));
        all += int(z.size());
    }
    ASSERT_GT(all, 200);
    EXPECT_GT(together, all * 3 / 5) << together << " of " << all;
}

// Both families together are the band's light, and a spheroid hides .35 of what a disk does.
TEST(GalaxyFamilies, ShareTheLight) {
    const Families families;
    const auto sums = [&](GalaxyFamily family) {
        const PictureSplats set = families.of(family, 3);
        std::pair<double, double> sum;  // light and opacity
        for (std::size_t i = 0; i < set.splats.position.size(); ++i) {
            const auto covers = double(set.splats.radius[i] * set.splats.radius[i] * set.splats.alpha[i]);
            sum.first += covers * double(set.splats.color[i].y);
            sum.second += covers;
        }
        return sum;
    };
    const auto disk = sums(GalaxyFamily::disk), spheroid = sums(GalaxyFamily::spheroid);
    EXPECT_GT(disk.first, 0.0);
    EXPECT_GT(spheroid.first, 0.05 * disk.first);
    EXPECT_LT(spheroid.second / spheroid.first, 0.6 * disk.second / disk.first);
}

TEST(Galaxies, WhatTheSceneSaysIsFollowedAndTheRestIsFound) {
    const Image light = painted::tilted_galaxy(240, 150, {70.0, 25.0, false, 4.0, 2.0});
    StructureParams params = galaxy_params(64.0);
    params.galaxy = {std::nullopt, std::nullopt, std::nullopt, std::nullopt, std::nullopt};
    const GalaxyPlane found = galaxy_planes(light, params).at(0);
    EXPECT_NEAR(found.inclination_deg, 70.0, 8.0);
    EXPECT_NEAR(found.angle / degree, 25.0, 8.0);
    EXPECT_EQ(found.near_side, -1);
    params.galaxy.inclination = 50.0;
    params.galaxy.near_side = 115.0;
    const GalaxyPlane told = galaxy_planes(light, params).at(0);
    EXPECT_EQ(told.inclination_deg, 50.0);
    EXPECT_EQ(told.near_side, 1);
    EXPECT_EQ(told.angle, found.angle);
    // In a list, too: what is not said is found.
    params.galaxies = {GalaxyParams{std::nullopt, std::nullopt, std::nullopt, std::nullopt, std::nullopt}};
    EXPECT_EQ(galaxy_planes(light, params).at(0), found);
    params.galaxies = {{20.0, 10.0, glm::dvec2(0.25, 0.75), 100.0, {}},
                       {70.0, 190.0, glm::dvec2(0.75, 0.5), 280.0, 0.4}};
    const std::vector<GalaxyPlane> two = galaxy_planes(light, params);
    ASSERT_EQ(two.size(), 2u);
    EXPECT_NEAR(two[0].y, 0.25 * 150.0 / 240.0, 1e-12);
    EXPECT_NEAR(two[1].angle, 10.0 * degree, 1e-9);
    EXPECT_EQ(two[1].near_side, -1);
}

TEST(Galaxies, ABulgeOfOneLeavesNoDisk) {
    const Image light = painted::tilted_galaxy(280, 175, {0.0, 0.0, true, 3.0, 0.0});
    StructureParams params = galaxy_params(90.0);
    params.galaxy.bulge = 1.0;
    const GalaxyBody body = galaxies_of(light, params, 1.0, 280, 0, 1u).at(0);
    EXPECT_GT(body.value_at(body.spheroid, 140.0f, 87.0f), 0.999f);
    EXPECT_GT(body.value_at(body.spheroid, 100.0f, 87.0f), 0.999f);
}

double degrees_between(double a_deg, double b_deg) {
    const double turns = (a_deg - b_deg) / 180.0;
    return 180.0 * std::fabs(turns - std::round(turns));
}

GalaxyFit fit_of(const painted::Tilted& t) {
    return fit_galaxies(painted::tilted_galaxy(240, 150, t), Galaxies::one).front();
}

TEST(GalaxyFit, FindsTheTiltOfPaintedGalaxies) {
    std::vector<double> errors;
    for (const double inclination : {0.0, 40.0, 58.0, 72.0, 84.0, 88.0}) {
        const double angle = 20.0 + 1.7 * inclination;
        const GalaxyFit fit = fit_of({inclination, angle});
        const double error = std::fabs(fit.plane.inclination_deg - inclination);
        EXPECT_TRUE(error <= 12.0 || fit.inclination_differs_deg > 10.0)
            << inclination << " found as " << fit.plane.inclination_deg;
        errors.push_back(error);
        if (inclination < 45.0) continue;
        EXPECT_LT(degrees_between(fit.plane.angle * 180.0 / 3.14159265358979, angle), 8.0) << inclination;
        EXPECT_LT(fit.misfit, 0.12) << inclination;
    }
    std::ranges::sort(errors);
    EXPECT_LE(errors[errors.size() / 2], 4.0);
}

TEST(GalaxyFit, FindsTheCentre) {
    const GalaxyFit fit = fit_of({60.0, 30.0});
    EXPECT_NEAR(fit.plane.x, 0.5, 0.01);
    EXPECT_NEAR(fit.plane.y, 0.3125, 0.01);
}

// Dust before the bulge dims the near side.
TEST(GalaxyFit, FindsTheNearSide) {
    for (const double angle : {20.0, 160.0}) {
        for (const bool above : {true, false}) {
            const GalaxyFit fit = fit_of({77.0, angle, above, 4.0, 2.0});
            const bool turned = std::cos(fit.plane.angle - angle * 3.14159265358979 / 180.0) < 0.0;
            EXPECT_EQ((fit.plane.near_side > 0) != turned, above) << angle;
            EXPECT_GT(fit.near_sure, 0.15) << angle;
        }
    }
}

TEST(GalaxyFit, PartsTheBulgeFromTheDisk) {
    EXPECT_LT(fit_of({80.0, 20.0, true, 0.0, 0.0}).bulge, 0.08);
    EXPECT_GT(fit_of({80.0, 20.0, true, 8.0, 0.0}).bulge, 0.15);
}

TEST(GalaxyFit, OfNoLightIsNothing) {
    const GalaxyFit fit = fit_galaxies(make_image(64, 40, 3), Galaxies::one).front();
    EXPECT_TRUE(std::isfinite(fit.plane.inclination_deg) && std::isfinite(fit.misfit));
}

}  // namespace
}  // namespace astrosplat
