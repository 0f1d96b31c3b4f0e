// Painted bodies of revolution: their axis, their tilt, and what they look like from where no
// picture was taken.
#include "bodies/axis_fit.h"

#include "bodies/axis_depths.h"
#include "bodies_support.h"
#include "image/blur.h"
#include "support/painted_bodies.h"
#include "support/test.h"

namespace astrosplat {
namespace {

using painted::Body, painted::body_height, painted::body_width, painted::body_x, painted::body_y,
    painted::lobes;
using painted::ring, painted::seen, painted::shell, painted::times;

float brightest(const Image& image) { return *std::ranges::max_element(image.pixels); }

struct Found {
    Image picture, truth[2];  // from 60 degrees aside
    AxisFit fit;
};
constexpr double aside_deg[2] = {60.0, -60.0};

Found found(const Body& nebula, const GivenAxis& given = {}) {
    Found found;
    const Image clean = seen(nebula, 0.0);
    const float exposure = 0.9f / brightest(clean);
    found.picture = painted::with_knots_and_noise(times(clean, exposure));
    for (int i = 0; i < 2; ++i) found.truth[i] = times(seen(nebula, aside_deg[i]), exposure);
    found.fit = fit_axis(found.picture, given);
    return found;
}

/// The picture's light at its depths, as if nothing hid anything.
Image from_aside(const Image& picture, const AxisDepths& depths, double degrees) {
    constexpr int splats = 32;  // of a pixel
    const double c = std::cos(real::radians(degrees)), s = std::sin(real::radians(degrees));
    Image image = make_image(picture.width, picture.height, 3);
    for (std::int64_t y = 0; y < picture.height; ++y)
        for (std::int64_t x = 0; x < picture.width; ++x)
            for (int k = 0; k < splats; ++k) {
                const float px = float(x) + 0.5f, py = float(y) + 0.5f;
                const double jitter = painted::random(std::uint32_t(y * body_width + x), 20u);
                const float z = depths.depth(px, py, float((k + jitter) / splats));
                const glm::vec3 tint = depths.tint(px, py, z);
                const double at = (px - body_x * body_width) * c - double(z) * s + body_x * body_width - 0.5;
                const auto left = std::int64_t(std::floor(at));
                const auto part = float(at - std::floor(at));
                for (int i = 0; i < 3; ++i) {
                    const float light = picture.at(x, y)[i] * tint[i] / splats;
                    if (left >= 0 && left < body_width) image.at(left, y)[i] += light * (1.0f - part);
                    if (left + 1 >= 0 && left + 1 < body_width) image.at(left + 1, y)[i] += light * part;
                }
            }
    return image;
}

double srgb(float light) {
    const double v = std::clamp(double(light), 0.0, 1.0);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
}

double psnr_db(const Image& a, const Image& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        sum += std::pow(srgb(a.pixels[i]) - srgb(b.pixels[i]), 2.0);
    return -10.0 * std::log10(sum / double(a.pixels.size()));
}

double turn_between(double a_deg, double b_deg) { return std::fabs(std::remainder(a_deg - b_deg, 180.0)); }

struct AxisCase {
    const char* name;
    Body nebula;
    bool tilt_shows;
};

void PrintTo(const AxisCase& one, std::ostream* out) { *out << one.name; }

class PaintedNebula : public testing::TestWithParam<AxisCase> {};

TEST_P(PaintedNebula, HasItsAxisItsTiltAndItsOtherSides) {
    const auto& [name, nebula, tilt_shows] = GetParam();
    const Found f = found(nebula);
    EXPECT_LE(turn_between(real::degrees(f.fit.angle), nebula.angle_deg), 2.0) << real::degrees(f.fit.angle);
    EXPECT_NEAR(f.fit.x, body_x, 0.01);
    EXPECT_NEAR(f.fit.y, body_y, 0.01);
    EXPECT_GT(f.fit.explained, 0.9);
    EXPECT_GT(f.fit.alike, 0.85);
    EXPECT_TRUE(is_about_axis(f.fit));
    EXPECT_LE(f.fit.tilt_from_deg, f.fit.tilt_deg);
    EXPECT_GE(f.fit.tilt_to_deg, f.fit.tilt_deg);
    if (!tilt_shows) {
        EXPECT_FALSE(f.fit.tilt_is_sure());
        EXPECT_LE(f.fit.tilt_deg, 30.0);
        return;
    }
    EXPECT_NEAR(f.fit.tilt_deg, nebula.tilt_deg, 10.0);
    const AxisDepths depths = make_axis_depths(f.fit, f.picture);
    for (int i = 0; i < 2; ++i)
        EXPECT_GE(psnr_db(from_aside(f.picture, depths, aside_deg[i]), f.truth[i]), 28.0) << aside_deg[i];
}

INSTANTIATE_TEST_SUITE_P(AxisFit, PaintedNebula,
                         testing::Values(AxisCase{"ring", {ring(0.2), 71.0, 30.0}, true},
                                         AxisCase{"lobes", {lobes(0.26), 112.0, 40.0}, true},
                                         AxisCase{"upright_lobes", {lobes(0.26), 90.0, 5.0}, true},
                                         AxisCase{"shell", {shell(0.22, 0.15), 37.0, 20.0}, false}),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(AxisFit, WhatIsGivenIsTaken) {
    const Image picture = seen({shell(0.2, 0.15), 30.0, 0.0}, 0.0);
    const AxisFit fit = fit_axis(picture, {real::radians(30.0), -25.0});
    EXPECT_DOUBLE_EQ(fit.angle, real::radians(30.0));
    EXPECT_EQ(fit.tilt_deg, -25.0);
    EXPECT_TRUE(fit.tilt_is_sure());
    EXPECT_GT(fit.explained, 0.9);
}

// Of few clouds rings are too little. Many that fill the frame they nearly are, as of anything smooth; but
// their sides are not alike.
void expect_no_body(std::uint32_t seed) {
    const AxisFit few = fit_axis(painted::clouds(12, 4.0, 5.0, seed)),
                  many = fit_axis(painted::clouds(300, 3.0, 30.0, seed));
    EXPECT_FALSE(is_about_axis(few)) << few.explained << ' ' << few.alike;
    EXPECT_FALSE(is_about_axis(many)) << many.explained << ' ' << many.alike;
    EXPECT_GT(many.explained, 0.75);
    EXPECT_LT(many.alike, 0.4);
    // Of a bubble most light is smooth, too, and smooth light is made of rings, but not its clouds.
    const AxisFit bubble = fit_axis(painted::shell_among_clouds(seed));
    EXPECT_FALSE(is_about_axis(bubble)) << bubble.explained << ' ' << bubble.alike;
    EXPECT_GT(bubble.explained, 0.75);
}

TEST(AxisFit, TakesNoCloudsForABody) { expect_no_body(10); }

TEST(AxisFit, TakesNoOtherCloudsForABodyNightly) {
    for (const std::uint32_t seed : {20u, 30u, 40u}) expect_no_body(seed);
}

// The rings in a hole of one colour are dimmed in every round, to nothing in the end if nothing held them;
// and what they would be seen to be next to, nothing over nothing.
TEST(AxisFit, NoRingGoesOut) {
    Image picture = seen({shell(0.2, 0.15), 90.0, 0.0}, 0.0);
    const double x = body_x * body_width, y = body_y * body_width;
    for_each_pixel(picture, [&](std::int64_t i, std::int64_t j) {
        if (std::hypot(double(i) + 0.5 - x, double(j) + 0.5 - y) < 9.0) picture.at(i, j)[2] *= 0.02f;
    });
    const AxisFit fit = fit_axis(picture, {0.5 * real::pi, 0.0});
    const std::int64_t middle = fit.rings.width / 2;
    EXPECT_GT(fit.rings.at(middle, 0)[2], 1e-7f * brightest(fit.rings));
    EXPECT_LT(fit.rings.at(middle, 0)[2], 1e-3f * brightest(fit.rings));
}

TEST(AxisFit, OfNoLightIsStillAFit) {
    const AxisFit fit = fit_axis(make_image(40, 30, 3));
    EXPECT_TRUE(std::isfinite(fit.angle) && std::isfinite(fit.tilt_deg) && std::isfinite(fit.explained));
}

TEST(AxisDepths, GrowAndKeepTheColourOfTheirLine) {
    // Blue inside, red outside.
    Image picture = times(seen({shell(0.2, 0.16), 60.0, 0.0}, 0.0), 1.0f);
    const Image inner = seen({shell(0.1, 0.08), 60.0, 0.0}, 0.0);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = i % 3 == 2 ? inner.pixels[i] : picture.pixels[i];
    const AxisDepths depths = make_axis_depths(fit_axis(picture), picture);
    const auto x = float(body_x * body_width), y = float(body_y * body_width);
    constexpr int shares = 200;
    glm::vec3 mean(0.0f);
    float before = -1e9f;
    for (int k = 0; k < shares; ++k) {
        const float z = depths.depth(x, y, (float(k) + 0.5f) / shares);
        EXPECT_GE(z, before);
        before = z;
        mean += depths.tint(x, y, z) / float(shares);
    }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], 1.0f, 0.12f) << c;
    const glm::vec3 wall = depths.tint(x, y, 0.16f * body_width),
                    core = depths.tint(x, y, 0.08f * body_width);
    EXPECT_GT(wall.x / wall.z, 3.0f * core.x / core.z);
    EXPECT_NEAR(depths.depth(x, y, 0.5f), 0.0f, 0.02f * body_width);
    EXPECT_LT(depths.residue_at(x, y), 0.1f);
}

/// Two lobes, 960 px wide, whose walls in front and behind are not as bright; and a bright star on them.
constexpr float star_x = 620.0f, star_y = 250.0f;
Image lobes_and_star() {
    Image light = seen({lobes(0.26), 112.0, 40.0}, 0.0);
    light = times(std::move(light), 0.5f / brightest(light));
    for (int i = 2; i <= 4; i *= 2) light = doubled(light, i * body_width, i * body_height);
    painted::add_point(light, double(star_x), double(star_y), 3.0, 0.9, 0.9, 0.9);
    return light;
}

Placement placed_about_axis(Image light) {
    const StructureParams params = of_kind(StructureKind::axis);
    const PictureStars stars = take_picture_stars(light, params);
    AxisDepths depths = make_axis_depths(fit_axis(light), light);
    return make_placement(light, params, 96.0, true, 1, stars.all, std::move(depths));
}

const Placement& lobes_in_place() {
    static const Placement placement = placed_about_axis(lobes_and_star());
    return placement;
}

BandSplats of_band(int index, float feature) {
    BandSplats splats;
    splats.index = index;
    splats.feature = feature;
    splats.sigma = 0.25f * feature;
    return splats;
}

// Its light is in bands as all light is; each by itself along the line it would be a streak.
TEST(PlacedAboutAxis, BrightStarsAreAtOneDepth) {
    const Placement& placement = lobes_in_place();
    for (int index = 0; index < 4; ++index) {
        PlacedBlock block = splats_about({star_x, star_y}, {6.0f, 6.0f}, std::uint32_t(index));
        place(placement, of_band(index, float(2 << index)), block);
        const auto [least, most] = std::minmax_element(block.z, block.z + block.count);
        EXPECT_LT(*most - *least, 40.0f) << index;
    }
}

float line_light(const Placement& placement, float x, float y) {
    const Image& seen = placement.axis->seen;
    const float share = float(seen.width) / float(placement.picture_width);
    return bilinear(seen, 0, x * share, y * share);
}

// The most light of an 8 px cell, seen from the right.
double most_aside(const Placement& placement, const BandSplats* details) {
    constexpr int cells = 256;
    std::vector<double> seen(cells * cells, 0.0);
    for (std::uint32_t number = 0; number < 1500; ++number) {
        PlacedBlock block = splats_about({480.0f, 300.0f}, {800.0f, 560.0f}, number);
        if (details) place_freely(placement, *details, block);
        for (int i = 0; i < block.count; ++i) {
            const float z =
                details ? block.z[i] : placement.axis->depth(block.x[i], block.y[i], block.even[i]);
            const auto row = std::int64_t(block.y[i] / 8.0f), column = std::int64_t(z / 8.0f) + cells / 2;
            if (column >= 0 && column < cells)
                seen[std::size_t(row * cells + column)] +=
                    double(line_light(placement, block.x[i], block.y[i]));
        }
    }
    return *std::ranges::max_element(seen);
}

// A thin sheet of details is seen wherever one looks along it, most of all where it leaps from wall to wall.
TEST(PlacedAboutAxis, DetailsAreNoCracks) {
    const Placement& placement = lobes_in_place();
    const BandSplats details = of_band(1, 4.0f);
    EXPECT_LT(most_aside(placement, &details), 2.0 * most_aside(placement, nullptr));
}

}  // namespace
}  // namespace astrosplat
