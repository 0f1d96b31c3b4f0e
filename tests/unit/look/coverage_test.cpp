// match = "coverage" and "sum": a slab of lattice seen in front shows the picture's alpha again. The slab is
// summed here by hand at random places of the plane, with the falloff 1 - t, whose integral over the disc is
// pi / 3.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/real.h"
#include "unit/look/sets.h"

namespace astrosplat {
namespace {

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

}  // namespace
}  // namespace astrosplat
