// match = "picture": what is drawn has the picture's light and not more, wherever splats overlap, however few
// of the positions become splats, and whatever shares their u and v.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/real.h"
#include "support/bits.h"
#include "unit/look/sets.h"

namespace astrosplat {
namespace {

constexpr double slab_half = 1.6, slab_spacing = 0.08, slab_distance = 0.4;
constexpr float slab_alpha = 0.7f;
const glm::vec3 slab_color{0.9f, 0.4f, 0.1f};

SplatSet colored_slab(double spacing = slab_spacing) {
    SplatSet set = test::slab(spacing, slab_half, slab_distance, slab_alpha);
    for (glm::vec3& c : set.color) c = slab_color;
    for (const glm::vec3& p : set.position)
        set.uv.emplace_back(0.5 + double(p.x) / (2.0 * slab_half), 0.5 + double(p.z) / (2.0 * slab_half));
    return set;
}

Look picture_look(VerticalAlpha::Match match = VerticalAlpha::Match::picture) {
    Look look;
    look.radius = {0.15f, 0.15f, 1.0f, 1.0f};
    look.vertical.match = match;
    return look;
}

LookInputs picture_inputs(ColumnLaw law) {
    LookInputs inputs;
    inputs.falloff_integral = real::pi / 3.0;  // of 1 - t
    inputs.falloff_variance = 0.15;
    inputs.column = law;
    return inputs;
}

// Light of a channel at a place in front of a slab: 1 - Product(1 - s c) as screen has it. Red is opacity
// where the colour is 1.
double screened_at(const ShadedSplats& shaded, double px, double pz, int channel) {
    double dark = 1.0;
    for (std::size_t i = 0; i < shaded.position.size(); ++i) {
        const double dx = double(shaded.position[i].x) - px, dz = double(shaded.position[i].z) - pz;
        const double r = double(shaded.radius[i]);
        if (dx * dx + dz * dz >= r * r) continue;
        const double t = std::sqrt(dx * dx + dz * dz) / r;
        dark *= 1.0 - double(shaded.alpha[i]) * (1.0 - t) * double(shaded.color[i][channel]);
    }
    return 1.0 - dark;
}

// Its mean over the slab but for its margins.
double screened_front(const ShadedSplats& shaded, int channel, int places = 800) {
    double sum = 0.0;
    for (int place = 0; place < places; ++place)
        sum += screened_at(shaded, (slab_half - 0.5) * (2.0 * double(test::uniform(place, 50)) - 1.0),
                           (slab_half - 0.5) * (2.0 * double(test::uniform(place, 51)) - 1.0), channel);
    return sum / places;
}

TEST(PictureMatch, ScreenShowsThePicturesLight) {
    const SplatSet set = colored_slab();
    const ShadedSplats shaded = apply_look(set, picture_look(), picture_inputs(ColumnLaw::screen));
    const ShadedSplats covered =
        apply_look(set, picture_look(VerticalAlpha::Match::coverage), picture_inputs(ColumnLaw::screen));
    for (int c = 0; c < 3; ++c) {
        const double wanted = double(slab_alpha) * double(slab_color[c]);
        EXPECT_NEAR(screened_front(shaded, c), wanted, 0.005 * wanted) << c;
    }
    EXPECT_GT(screened_front(covered, 1), 1.06 * double(slab_alpha * slab_color[1]))
        << "as coverage still does";
}

TEST(PictureMatch, TakesTheColorAndAlphaOfTheLook) {
    Look look = picture_look();
    look.alpha.power = 2.0f;
    look.grade.gain = 0.5f;
    const ShadedSplats shaded = apply_look(colored_slab(), look, picture_inputs(ColumnLaw::screen));
    EXPECT_NEAR(screened_front(shaded, 0), 0.49 * 0.45, 0.005 * 0.49 * 0.45);
}

ShadedSplats opacity_of(const SplatSet& set, const Look& look, ColumnLaw law = ColumnLaw::transmittance) {
    ShadedSplats shaded = apply_look(set, look, picture_inputs(law));
    for (glm::vec3& c : shaded.color) c = glm::vec3(1.0f);
    return shaded;
}

// Stripes narrower than a splat.
SplatSet striped_slab() {
    SplatSet set = colored_slab();
    for (std::size_t i = 0; i < set.alpha.size(); ++i)
        set.alpha[i] = std::fmod(double(set.position[i].x) + 8.0, 0.16) < 0.04 ? 0.95f : 0.1f;
    return set;
}

TEST(PictureMatch, DetailFinerThanSplatsDoesNotAddLight) {
    const double wanted = 0.25 * 0.95 + 0.75 * 0.1;
    EXPECT_NEAR(screened_front(opacity_of(striped_slab(), picture_look()), 0), wanted, 0.015 * wanted);
    const Look covered = picture_look(VerticalAlpha::Match::coverage);
    EXPECT_GT(screened_front(opacity_of(striped_slab(), covered), 0), 1.5 * wanted)
        << "as coverage still does";
}

// Means of opacity over squares of the slab, without its margins.
std::vector<double> light_of_squares(const ShadedSplats& shaded, int squares = 5) {
    std::vector<double> light;
    const double size = 2.0 * (slab_half - 0.4) / squares;
    for (int square = 0; square < squares * squares; ++square) {
        double sum = 0.0;
        for (int place = 0; place < 64; ++place)
            sum += screened_at(shaded, 0.4 - slab_half + size * (square % squares + (place % 8 + 0.5) / 8.0),
                               0.4 - slab_half + size * (square / squares + (place / 8 + 0.5) / 8.0), 0);
        light.push_back(sum / 64.0);
    }
    return light;
}

double mean(const std::vector<double>& light) {
    double sum = 0.0;
    for (const double l : light) sum += l;
    return sum / double(light.size());
}

// Standard deviation over the mean.
double spread(const std::vector<double>& light) {
    double squares = 0.0;
    for (const double l : light) squares += (l - mean(light)) * (l - mean(light));
    return std::sqrt(squares / double(light.size())) / mean(light);
}

TEST(PictureMatch, ThinningLeavesEverySquareItsLight) {
    const SplatSet set = colored_slab();
    Look look = picture_look(), covered = picture_look(VerticalAlpha::Match::coverage);
    look.density = covered.density = 0.25f;
    const std::vector<double> even = light_of_squares(opacity_of(set, look));
    const std::vector<double> grainy = light_of_squares(opacity_of(set, covered));
    EXPECT_GT(spread(grainy), 0.025);
    EXPECT_LT(spread(even), 0.4 * spread(grainy));
    EXPECT_NEAR(mean(even), double(slab_alpha), 0.01 * double(slab_alpha));
}

TEST(PictureMatch, FewOpaqueSplatsHideMoreThanTheirSum) {
    Look look = picture_look();
    look.density = 0.08f;
    SplatSet set = colored_slab();
    for (float& a : set.alpha) a = 0.5f;
    EXPECT_NEAR(mean(light_of_squares(opacity_of(set, look))), 0.5, 0.01);
}

TEST(PictureMatch, WhatNoiseAndCropsTakeStaysAway) {
    const SplatSet set = colored_slab();
    Look look = picture_look(), covered = picture_look(VerticalAlpha::Match::coverage);
    Noise noise;
    noise.frequency = 1.5f;
    noise.octaves = 1;
    noise.cull = noise.alpha = 0.8f;
    look.noise = covered.noise = {noise};
    look.crop.resize(1);
    look.crop[0].size = {1.6f, 9.0f, 9.0f};
    look.crop[0].soft = 0.4f;
    covered.crop = look.crop;
    const std::vector<double> matched = light_of_squares(opacity_of(set, look));
    const std::vector<double> plain = light_of_squares(opacity_of(set, covered));
    EXPECT_GT(spread(plain), 0.3);
    for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_NEAR(matched[i], plain[i], 0.04) << i;
}

TEST(PictureMatch, SurfacesThatShareTheirPlacesInThePictureEachShowIt) {
    SplatSet set = colored_slab();
    const std::size_t count = set.position.size();
    for (std::size_t i = 0; i < count; ++i) {
        set.position.push_back(set.position[i] + glm::vec3(10.0f, 0.0f, 0.0f));
        set.color.push_back(set.color[i]);
        set.alpha.push_back(set.alpha[i]);
        set.distance.push_back(set.distance[i]);
        set.id.push_back(set.id[i] + (1ull << 40));
        set.uv.push_back(set.uv[i]);
    }
    EXPECT_NEAR(screened_front(opacity_of(set, picture_look()), 0), double(slab_alpha), 0.01);
}

TEST(PictureMatch, PositionsBeyondAnEdgeDoNotDarkenIt) {
    SplatSet set = colored_slab();
    for (glm::vec2& uv : set.uv) uv = glm::clamp(2.0f * uv - 0.5f, 0.0f, 1.0f);  // the inner half is the mesh
    const ShadedSplats shaded = opacity_of(set, picture_look());
    double sum = 0.0;
    for (int place = 0; place < 400; ++place)
        sum += screened_at(shaded, 0.72 + 0.08 * double(test::uniform(place, 60)),
                           1.4 * double(test::uniform(place, 61)) - 0.7, 0);
    EXPECT_NEAR(sum / 400.0, double(slab_alpha), 0.02);
    const ShadedSplats covered = opacity_of(set, picture_look(VerticalAlpha::Match::coverage));
    for (std::size_t i = 0; i < set.uv.size(); ++i)
        if (set.uv[i].x == 1.0f) {
            ASSERT_EQ(shaded.alpha[i], covered.alpha[i]) << "nothing is known of it";
        }
}

TEST(PictureMatch, TheSameBitsOnAnyThreadsAndInPlace) {
    SplatSet set = colored_slab();
    Look look = picture_look();
    look.density = 0.3f;
    look.noise = {{1.3f, 4, 2.1f, 0.5f, 3, 0.6f, 0.4f, 0.1f, 0.5f, 0.2f}};
    const LookInputs inputs = picture_inputs(ColumnLaw::screen);
    const auto bits_of = [](const ShadedSplats& s) { return test::Bits() << s.color << s.alpha << s.id; };
    const test::Bits before = bits_of(apply_look(set, look, inputs));
    test::expect_same_bits([&] { return bits_of(apply_look(set, look, inputs)); });
    EXPECT_TRUE(bits_of(apply_look_in_place(set, look, inputs)).bytes() == before.bytes());
}

}  // namespace
}  // namespace astrosplat
