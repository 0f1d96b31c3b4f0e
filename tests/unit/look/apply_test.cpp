// The look as a whole: the same bits, messages, progress.
#include "core/log.h"
#include "look/prepare.h"
#include "support/test.h"
#include "unit/look/sets.h"

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

constexpr std::int64_t count = 70001;  // several chunks, the last one odd

struct Case {
    std::string name;
    SplatSet set = test::file_set(count);
    Image map = make_image(3, 2, 3);
    Look look;
    LookInputs inputs;
};

// Every operator at once.
void use_everything(Case& c) {
    for (std::size_t i = 0; i < c.map.pixels.size(); ++i)
        c.map.pixels[i] = test::uniform(std::int64_t(i), 70);
    for (std::int64_t i = 0; i < count; ++i) c.set.uv.push_back({test::uniform(i, 71), test::uniform(i, 72)});
    c.set.spacing = {0.1, 0.1, 0.1};
    c.inputs.axis = {0.3f, 0.8f, -0.2f};
    c.look.density = 0.8f;
    c.look.reach = 1.7f;
    c.look.thickness.map = "map.exr";
    c.look.thickness.stops.resize(3);
    c.look.thickness.stops[0] = {{0.2f, 0.4f, 0.1f}, 1.0f, {}};
    c.look.thickness.stops[1] = {{0.9f, 0.4f, 0.8f}, 0.6f, {}};
    c.look.thickness.stops[1].pdf.shape = DensityCurve::Shape::gaussian;
    c.look.thickness.stops[2].pdf.shape = DensityCurve::Shape::curve;
    c.look.thickness.stops[2].pdf.points = {{0.1f, 0.9f}, {0.5f, 0.2f}, {0.8f, 0.7f}};
    c.look.noise = {{1.3f, 4, 2.1f, 0.5f, 3, 0.6f, 0.4f, 0.1f, 0.5f, 0.2f},
                    {5.3f, 2, 2.0f, 0.7f, 8, 0.0f, 0.0f, 0.05f, 0.3f, 0.4f}};
    c.look.crop.resize(2);
    c.look.crop[0].size = {6.0f, 0.8f, 7.0f};
    c.look.crop[0].rotate = {3.0f, 20.0f, 4.0f};
    c.look.crop[0].soft = 0.4f;
    c.look.crop[1].shape = Crop::Shape::sphere;
    c.look.crop[1].keep = Crop::Keep::outside;
    c.look.alpha = {1.7f, 0.9f, true, 1.2f};
    c.look.vertical.shape = VerticalAlpha::Shape::exponential;
    c.look.vertical.reach = 0.9f;
    c.look.vertical.match = VerticalAlpha::Match::coverage;
    c.look.radius = {0.05f, 0.2f, 1.6f, 0.7f};
    c.look.grade = {1.3f, {1.0f, 0.8f, 0.9f}, 1.4f, 1.8f, 0.05f};
}

std::vector<Case> cases() {
    std::vector<Case> all(5);
    all[0].name = "everything";
    use_everything(all[0]);
    all[1].name = "defaults";
    all[2].name = "curve, s106, sum";
    all[2].set.spacing = {0.1, 0.2, 0.1};
    all[2].look.pdf.shape = DensityCurve::Shape::curve;
    all[2].look.pdf.points = {{0.1f, 0.9f}, {0.5f, 0.2f}, {0.8f, 0.7f}};
    all[2].look.vertical.shape = VerticalAlpha::Shape::s106;
    all[2].look.vertical.match = VerticalAlpha::Match::sum;
    all[4].name = "everything, and splats that absorb";
    use_everything(all[4]);
    all[4].set.absorbs = true;
    for (std::size_t i = 0; i < std::size_t(count); i += 3) all[4].set.color[i] = {-0.8f, -1.0f, -1.35f};
    all[3].name = "one key, culling noise";
    all[3].look.thickness.stops = {{glm::vec3(1.0f), 0.7f, {}}};
    all[3].look.thickness.stops[0].pdf.shape = DensityCurve::Shape::smooth;
    all[3].look.noise = {{2.0f, 3, 2.0f, 0.5f, 1, 0.7f, 0.0f, 0.0f, 0.0f, 0.0f}};
    all[4].name = "picture under screen";
    use_everything(all[4]);
    all[4].look.thickness = {};
    all[4].set.uv.clear();  // and with it the cells of the picture
    all[4].look.vertical.match = VerticalAlpha::Match::picture;
    all[4].inputs.column = ColumnLaw::screen;
    return all;
}

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
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        test::expect_same_bits([&] { return bits_of(shade(c)); });
    }
}

TEST(SameBits, IntoArraysOfAnEarlierCall) {
    ShadedSplats used;
    for (const Case& c : cases()) {
        LookInputs inputs = c.inputs;
        inputs.thickness_map = &c.map;
        apply_look(c.set, c.look, inputs, used);
        expect_same(used, shade(c), c.name);
    }
}

TEST(SameBits, InTheMemoryOfTheSet) {
    for (const Case& c : cases())
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
    for (const Case& c : cases()) {
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
    for (const Case& c : cases()) {
        const LookUniforms uniforms = prepare_look(
            c.set, c.look, c.inputs.thickness_map ? c.inputs : [&] {
                LookInputs inputs = c.inputs;
                inputs.thickness_map = &c.map;
                return inputs;
            }());
        ShadedSplats expected;
        for (std::size_t i = 0; i < std::size_t(count); ++i) {
            const std::uint64_t id = c.set.id[i];
            const shared::LookInput input{
                c.set.position[i], c.set.color[i],
                c.set.alpha[i],    c.set.distance[i],
                c.set.radius[i],   map_value(c, c.set.uv.empty() ? glm::vec2(0.0f) : c.set.uv[i]),
                std::uint32_t(id), std::uint32_t(id >> 32)};
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
