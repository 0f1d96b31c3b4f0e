// The look as a whole: the same bits, messages, progress.
#include "core/log.h"
#include "look/prepare.h"
#include "support/test.h"
#include "unit/look/cases.h"

namespace astrosplat {
namespace {

// The same splats to the last bit: a file's at the default look, on any number of threads, on every
// instruction set, and by look_splat, the function the preview runs.

test::Bits bits_of(const ShadedSplats& splats) {
    return test::Bits() << splats.position << splats.color << splats.alpha << splats.radius << splats.id;
}

void expect_same(const ShadedSplats& a, const ShadedSplats& b, const std::string& what) {
    EXPECT_TRUE(bits_of(a).bytes() == bits_of(b).bytes()) << what;
}

constexpr std::int64_t count = test::LookCase::splats;
using Case = test::LookCase;

ShadedSplats shade(const Case& c) {
    LookInputs inputs = c.inputs;
    inputs.thickness_map = c.look.thickness.map.empty() ? nullptr : &c.map;
    return apply_look(c.set, c.look, inputs);
}

TEST(SameBits, DefaultLookLeavesAFileUnchanged) {
    const SplatSet set = test::file_set(count);
    ShadedSplats expected;
    expected.position = set.position;
    expected.color = set.color;
    expected.alpha = set.alpha;
    expected.radius = set.radius;
    expected.id = set.id;
    expect_same(apply_look(set, {}, {}), expected, "default");
    Look inert;
    inert.noise.resize(1);
    inert.alpha.threshold = 0.1f;
    expect_same(apply_look(set, inert, {}), expected, "a noise without amounts");
}

TEST(SameBits, OnAnyThreadsAndInstructions) {
    for (const Case& c : test::look_cases()) {
        SCOPED_TRACE(c.name);
        test::expect_same_bits([&] { return bits_of(shade(c)); });
    }
}

TEST(SameBits, IntoArraysOfAnEarlierCall) {
    ShadedSplats used;
    for (const Case& c : test::look_cases()) {
        LookInputs inputs = c.inputs;
        inputs.thickness_map = &c.map;
        apply_look(c.set, c.look, inputs, used);
        expect_same(used, shade(c), c.name);
    }
}

TEST(SameBits, InTheMemoryOfTheSet) {
    for (const Case& c : test::look_cases())
        for (const bool own_radius : {true, false}) {
            Case given = c;
            if (!own_radius) given.set.radius.clear();
            given.look.radius = {0.05f, 0.2f, 1.6f, 0.7f};
            LookInputs inputs = given.inputs;
            inputs.thickness_map = &given.map;
            const ShadedSplats expected = shade(given);
            LookStatistics statistics;
            SplatSet set = given.set;
            expect_same(apply_look_in_place(set, given.look, inputs, {}, &statistics), expected, c.name);
            EXPECT_EQ(statistics.kept, expected.size());
            EXPECT_EQ(set.size(), 0);
            EXPECT_TRUE(set.distance.empty() && set.uv.empty() && set.radius.empty());
            EXPECT_EQ(set.max_distance, given.set.max_distance);
        }
}

TEST(SameBits, WhatCannotBeShadedInPlaceIsLeftAsItWas) {
    SplatSet set = test::file_set(count);
    const std::atomic<bool> cancelled{true};
    EXPECT_THROW(apply_look_in_place(set, {}, {}, Progress{{}, &cancelled}), Cancelled);
    Look mapped;
    mapped.thickness.map = "map.exr";  // the set has no uv
    EXPECT_THROW(apply_look_in_place(set, mapped, {}), InputError);
    expect_same(apply_look_in_place(set, {}, {}), apply_look(test::file_set(count), {}, {}), "afterwards");
}

TEST(SameBits, IdsAscend) {
    for (const Case& c : test::look_cases()) {
        const ShadedSplats shaded = shade(c);
        for (std::size_t i = 1; i < shaded.id.size(); ++i) ASSERT_LT(shaded.id[i - 1], shaded.id[i]);
    }
}

glm::vec3 map_value(const Case& c, glm::vec2 uv) {
    if (c.look.thickness.map.empty()) return glm::vec3(0.0f);
    const float x = shared::look_texel(uv.x, 3), y = shared::look_texel(1.0f - uv.y, 2);
    const int x0 = int(x), y0 = int(y), x1 = std::min(x0 + 1, 2), y1 = std::min(y0 + 1, 1);
    glm::vec3 value;
    for (int k = 0; k < 3; ++k)
        value[k] = shared::look_bilinear(c.map.at(x0, y0)[k], c.map.at(x1, y0)[k], c.map.at(x0, y1)[k],
                                         c.map.at(x1, y1)[k], x - float(x0), y - float(y0));
    return value;
}

TEST(SameBits, AsLookSplatOneByOne) {
    for (const Case& c : test::look_cases()) {
        const PreparedLook uniforms = prepare_look(
            c.set, c.look, c.inputs.thickness_map ? c.inputs : [&] {
                LookInputs inputs = c.inputs;
                inputs.thickness_map = &c.map;
                return inputs;
            }());
        ShadedSplats expected;
        for (std::size_t i = 0; i < std::size_t(count); ++i) {
            const std::uint64_t id = c.set.id[i];
            const shared::LookInput input{c.set.position[i],
                                          c.set.color[i],
                                          c.set.alpha[i],
                                          c.set.distance[i],
                                          c.set.radius[i],
                                          map_value(c, c.set.uv.empty() ? glm::vec2(0.0f) : c.set.uv[i]),
                                          std::uint32_t(id),
                                          std::uint32_t(id >> 32),
                                          outlined(uniforms, c.set.position[i])};
            const shared::LookOutput output = shared::look_splat(uniforms, input);
            if (!output.keep) continue;
            expected.position.push_back(output.position);
            expected.color.push_back(output.color);
            expected.alpha.push_back(output.alpha);
            expected.radius.push_back(output.radius);
            expected.id.push_back(id);
        }
        expect_same(shade(c), expected, c.name);
    }
}

// Every message a person can meet in the look, word for word.

std::string message(const SplatSet& set, const Look& look) { return ERROR_OF(apply_look(set, look, {})); }

TEST(LookErrors, CurveWithTooManyPoints) {
    Look look;
    for (int i = 0; i < 17; ++i) look.pdf.points.push_back({float(i), 1.0f});
    EXPECT_EQ(message(test::file_set(1), look), "look.pdf.points: expected at most 16 points, found 17");
}

TEST(LookErrors, CurveThatGoesBack) {
    Look look;
    look.vertical.points = {{0.0f, 1.0f}, {0.5f, 1.0f}, {0.25f, 0.0f}};
    EXPECT_EQ(message(test::file_set(1), look),
              "look.vertical.points: expected points in ascending order of x, found 0.25 after 0.5");
}

TEST(LookErrors, CurveOfAThicknessStopIsNamed) {
    Look look;
    look.thickness.stops.resize(1);
    look.thickness.stops[0].pdf.points = {{0.5f, 1.0f}, {0.5f, 0.0f}};
    EXPECT_EQ(message(test::file_set(1), look),
              "look.thickness.keys[0].points: expected points in ascending order of x, found 0.5 after 0.5");
}

TEST(LookErrors, TooManyStops) {
    Look look;
    look.thickness.stops.resize(9);
    EXPECT_EQ(message(test::file_set(1), look), "look.thickness.keys: expected at most 8 stops, found 9");
}

TEST(LookErrors, TooManyNoises) {
    Look look;
    look.noise.resize(5);
    for (Noise& noise : look.noise) noise.alpha = 0.1f;
    EXPECT_EQ(message(test::file_set(1), look), "look.noise: expected at most 4 noises, found 5");
}

TEST(LookErrors, ThicknessMapWithoutTextureCoordinates) {
    Look look;
    look.thickness.map = "map.exr";
    EXPECT_EQ(message(test::file_set(1), look),
              "look.thickness.map: expected splats with texture coordinates, found a set without");
}

TEST(LookErrors, NoRadiusKnown) {
    SplatSet set = test::file_set(1);
    set.radius.clear();
    EXPECT_EQ(message(set, {}),
              "look.radius: expected min and max, since the splat file holds no radius, found 0 and 0");
}

TEST(LookErrors, MatchWithoutSpacing) {
    Look look;
    look.vertical.match = VerticalAlpha::Match::coverage;
    EXPECT_EQ(message(test::file_set(1), look),
              "look.vertical.match: expected none, since the spacing of the splat file's lattice is not "
              "known, found "
              "coverage");
    look.vertical.match = VerticalAlpha::Match::sum;
    EXPECT_EQ(message(test::file_set(1), look),
              "look.vertical.match: expected none, since the spacing of the splat file's lattice is not "
              "known, found "
              "sum");
}

TEST(LookErrors, WarnsWhereColoursAreDividedTwice) {
    SplatSet set = test::file_set(1);
    set.divided = true;
    Look look;
    const Said said;
    apply_look(set, look, {});
    EXPECT_TRUE(said.warnings.empty());
    look.alpha.unpremultiply = true;
    apply_look(set, look, {});
    EXPECT_HAS(said.one_warning(), "they are divided again");
}

TEST(LookErrors, StopsWhenAsked) {
    const std::atomic<bool> stop{true};
    const Progress progress{{}, &stop};
    EXPECT_THROW(apply_look(test::file_set(10), {}, {}, progress), Cancelled);
}

TEST(LookProgress, RisesToTheWhole) {
    set_thread_count(1);
    std::vector<double> reported;
    Progress progress;
    progress.report = [&](double fraction) { reported.push_back(fraction); };
    apply_look(test::file_set(200000), {}, {}, progress);
    ASSERT_GT(reported.size(), 2u);
    EXPECT_TRUE(std::is_sorted(reported.begin(), reported.end()));
    EXPECT_GT(reported.front(), 0.0);
    EXPECT_EQ(reported.back(), 1.0);
}

TEST(LookErrors, AnEmptySetIsNoError) { EXPECT_EQ(apply_look(test::file_set(0), {}, {}).size(), 0); }

}  // namespace
}  // namespace astrosplat
