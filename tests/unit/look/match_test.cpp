// match = "coverage", "sum" and "picture": what is drawn has the picture's light.
#include "support/test.h"
#include "unit/look/sets.h"

namespace astrosplat {
namespace {

// match = "coverage" and "sum": a slab of lattice seen in front shows the picture's alpha again. The slab is
// summed here by hand at random places of the plane, with the falloff 1 - t, whose integral over the disc is
// pi / 3.

constexpr double half = 1.6, spacing = 0.08, max_distance = 0.4;
constexpr int places = 1500;

// Mean over places of 1 - Product(1 - alpha w), or of Sum(alpha w) where light adds.
double front_view(const ShadedSplats& shaded, bool adds) {
    double sum = 0.0;
    for (int place = 0; place < places; ++place) {
        const double inner = half - 0.5;
        const double px = inner * (2.0 * double(test::uniform(place, 50)) - 1.0);
        const double pz = inner * (2.0 * double(test::uniform(place, 51)) - 1.0);
        double light = 0.0, transmittance = 1.0;
        for (std::size_t i = 0; i < shaded.position.size(); ++i) {
            const double dx = double(shaded.position[i].x) - px, dz = double(shaded.position[i].z) - pz;
            const double r = double(shaded.radius[i]), squared = dx * dx + dz * dz;
            if (squared >= r * r) continue;
            const double s = double(shaded.alpha[i]) * (1.0 - std::sqrt(squared) / r);
            light += s;
            transmittance *= 1.0 - s;
        }
        sum += adds ? light : 1.0 - transmittance;
    }
    return sum / places;
}

LookInputs inputs_of(ColumnLaw law) {
    LookInputs inputs;
    inputs.falloff_integral = real::pi / 3.0;
    inputs.column = law;
    return inputs;
}

struct Setting {
    std::string name;
    Look look;
};

std::vector<Setting> settings() {
    using Pdf = DensityCurve::Shape;
    using Vertical = VerticalAlpha::Shape;
    std::vector<Setting> all;
    const auto add = [&](const std::string& name, Pdf pdf, Vertical vertical) -> Look& {
        Look look;
        look.pdf.shape = pdf;
        look.vertical.shape = vertical;
        look.radius.min = 0.12f;
        look.radius.max = 0.2f;
        all.push_back({name, look});
        return all.back().look;
    };
    add("constant", Pdf::constant, Vertical::none);
    add("gaussian, linear", Pdf::gaussian, Vertical::linear);
    add("exponential, s106", Pdf::exponential, Vertical::s106);
    add("smooth, exponential", Pdf::smooth, Vertical::exponential);
    add("default radius", Pdf::linear, Vertical::none).radius = {};
    add("radius factors", Pdf::linear, Vertical::constant).radius = {0.1f, 0.2f, 1.5f, 0.5f};
    add("density", Pdf::constant, Vertical::linear).density = 0.5f;
    add("short reach", Pdf::constant, Vertical::linear).reach = 0.25f;
    add("reach beyond the set", Pdf::linear, Vertical::linear).reach = 0.8f;
    add("vertical reach", Pdf::constant, Vertical::linear).vertical.reach = 0.2f;
    Look& curves = add("curves", Pdf::curve, Vertical::curve);
    curves.pdf.points = {{0.0f, 0.3f}, {0.4f, 1.0f}, {1.0f, 0.2f}};
    curves.vertical.points = {{0.0f, 0.1f}, {0.5f, 1.0f}, {0.8f, 0.0f}};
    return all;
}

TEST(Coverage, FrontViewShowsTheAlphaUnderOver) {
    for (float alpha : {0.1f, 0.3f, 0.5f, 0.7f, 0.9f}) {
        const SplatSet set = test::slab(spacing, half, max_distance, alpha);
        for (const Setting& setting : settings()) {
            const ShadedSplats shaded = apply_look(set, setting.look, inputs_of(ColumnLaw::transmittance));
            EXPECT_NEAR(front_view(shaded, false), double(alpha), 0.02) << setting.name;
        }
    }
}

TEST(Coverage, FrontViewShowsTheAlphaUnderAdd) {
    for (float alpha : {0.1f, 0.5f, 0.9f}) {
        const SplatSet set = test::slab(spacing, half, max_distance, alpha);
        for (const Setting& setting : settings()) {
            const ShadedSplats shaded = apply_look(set, setting.look, inputs_of(ColumnLaw::sum));
            EXPECT_NEAR(front_view(shaded, true), double(alpha), 0.02) << setting.name;
        }
    }
}

TEST(Coverage, ActsOnTheAlphaOfStepFour) {
    const SplatSet set = test::slab(spacing, half, max_distance, 0.5f);
    Look look;
    look.alpha.power = 2.0f;
    look.radius = {0.15f, 0.15f, 1.0f, 1.0f};
    const ShadedSplats shaded = apply_look(set, look, inputs_of(ColumnLaw::transmittance));
    EXPECT_NEAR(front_view(shaded, false), 0.25, 0.02);
}

TEST(Coverage, HoldsWithThicknessStops) {
    SplatSet set = test::slab(spacing, half, max_distance, 0.6f);
    set.uv.assign(set.position.size(), {0.5f, 0.5f});
    Image map = make_image(1, 1, 1, 0.5f);  // half way between the keys
    Look look;
    look.radius = {0.15f, 0.15f, 1.0f, 1.0f};
    look.thickness.map = "map.exr";
    look.thickness.stops = {{glm::vec3(0.0f), 1.0f, {}}, {glm::vec3(1.0f), 0.5f, {}}};
    LookInputs inputs = inputs_of(ColumnLaw::transmittance);
    inputs.thickness_map = &map;
    EXPECT_NEAR(front_view(apply_look(set, look, inputs), false), 0.6, 0.02);
}

TEST(Coverage, HoldsWhereTheSetHasItsOwnRadii) {
    SplatSet set = test::slab(spacing, half, max_distance, 0.6f);
    for (std::int64_t i = 0; i < set.size(); ++i) set.radius.push_back(0.1f + 0.1f * test::uniform(i, 60));
    const ShadedSplats shaded = apply_look(set, {}, inputs_of(ColumnLaw::transmittance));
    EXPECT_NEAR(front_view(shaded, false), 0.6, 0.02);
}

// s = -ln(1 - min(a, 0.998)) / (a M) by hand: M = 2 / h^3 * I * r^2 * 2 reach.
TEST(Coverage, IsTheStatedFormula) {
    const double mean =
        2.0 / (spacing * spacing * spacing) * (real::pi / 3.0) * 0.15 * 0.15 * 2.0 * max_distance;
    Look look;
    look.radius = {0.15f, 0.15f, 1.0f, 1.0f};
    for (float a : {1e-6f, 0.01f, 0.5f, 0.9f, 0.999f, 1.0f}) {
        SplatSet set = test::slab(spacing, 0.2, max_distance, a);
        const double depth = -std::log1p(-std::min(double(a), 0.998));
        EXPECT_NEAR(apply_look(set, look, inputs_of(ColumnLaw::transmittance)).alpha[0] / (depth / mean), 1.0,
                    2e-6);
        EXPECT_NEAR(apply_look(set, look, inputs_of(ColumnLaw::sum)).alpha[0] / (double(a) / mean), 1.0,
                    2e-6);
        EXPECT_EQ(apply_look(set, look, inputs_of(ColumnLaw::maximum)).alpha[0], a);
    }
}

// Alphas of one lattice column (one splat a plane) sum to the picture's alpha, whatever the profiles.
TEST(MatchSum, ColumnsOfPlanesSumToTheAlpha) {
    const SplatSet set = test::slab(spacing, half, max_distance, 0.6f);
    const double columns = 2.0 * std::pow(2.0 * half / spacing, 2.0);  // corners and centres
    for (const Setting& setting : settings()) {
        Look look = setting.look;
        look.vertical.match = VerticalAlpha::Match::sum;
        double sum = 0.0;
        for (float a : apply_look(set, look, inputs_of(ColumnLaw::transmittance)).alpha) sum += double(a);
        EXPECT_NEAR(sum / columns, 0.6, 0.01) << setting.name;
    }
}

TEST(Match, AutomaticIsCoverageForMeshesAndNoneForFiles) {
    SplatSet set = test::slab(spacing, 0.2, max_distance, 0.6f);
    Look look;
    const float automatic = apply_look(set, look, {}).alpha[0];
    look.vertical.match = VerticalAlpha::Match::coverage;
    EXPECT_EQ(apply_look(set, look, {}).alpha[0], automatic);
    EXPECT_NE(automatic, 0.6f);
    look.vertical.match = VerticalAlpha::Match::none;
    EXPECT_EQ(apply_look(set, look, {}).alpha[0], 0.6f);
    set.generated = false;
    look.vertical.match = VerticalAlpha::Match::automatic;
    look.radius = {0.1f, 0.1f, 1.0f, 1.0f};
    EXPECT_EQ(apply_look(set, look, {}).alpha[0], 0.6f);
}

// match = "picture": what is drawn has the picture's light and not more, wherever splats overlap, however few
// of the positions become splats, and whatever shares their u and v.

constexpr double slab_half = 1.6, slab_spacing = 0.08, slab_distance = 0.4;
constexpr float slab_alpha = 0.7f;
const glm::vec3 slab_color{0.9f, 0.4f, 0.1f};

SplatSet colored_slab(double step = slab_spacing) {
    SplatSet set = test::slab(step, slab_half, slab_distance, slab_alpha);
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
double screened_front(const ShadedSplats& shaded, int channel, int tried = 800) {
    double sum = 0.0;
    for (int place = 0; place < tried; ++place)
        sum += screened_at(shaded, (slab_half - 0.5) * (2.0 * double(test::uniform(place, 50)) - 1.0),
                           (slab_half - 0.5) * (2.0 * double(test::uniform(place, 51)) - 1.0), channel);
    return sum / tried;
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
