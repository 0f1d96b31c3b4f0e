// Each operator alone, on one or many splats, against its closed form.
#include "support/test.h"
#include "unit/look/sets.h"

namespace astrosplat {
namespace {

using test::one_splat;
using test::shade;

float alpha_of(const SplatSet& set, const Look& look, const LookInputs& inputs = {}) {
    return shade(set, look, inputs).alpha.at(0);
}
float grey_of(const SplatSet& set, const Look& look) { return shade(set, look).color.at(0).x; }
float radius_of(const SplatSet& set, const Look& look) { return shade(set, look).radius.at(0); }

TEST(Reach, DropsWhatLiesBeyond) {
    Look look;
    look.reach = 0.5f;
    EXPECT_EQ(shade(one_splat(0.5f, 1.0f, 1.0f), look).size(), 1);
    EXPECT_EQ(shade(one_splat(0.50001f, 1.0f, 1.0f), look).size(), 0);
}

TEST(Reach, OfZeroMeansMaxDistance) {
    SplatSet set = one_splat(0.75f, 1.0f, 1.0f);
    set.max_distance = 0.75;
    EXPECT_EQ(shade(set, {}).size(), 1);
    set.max_distance = 0.74;
    EXPECT_EQ(shade(set, {}).size(), 0);
}

TEST(Reach, OfAFileWithoutDistancesKeepsAll) {
    SplatSet set = one_splat(0.0f, 0.4f, 1.0f);
    set.max_distance = 0.0;
    Look look;
    look.vertical.shape = VerticalAlpha::Shape::linear;
    look.radius.vertical_scale = 3.0f;
    EXPECT_EQ(alpha_of(set, look), 0.4f);
    EXPECT_EQ(radius_of(set, look), 0.25f);
}

// --- thickness ---

struct ThicknessCase {
    SplatSet set = one_splat(0.0f, 0.5f, 1.0f);
    Image map = make_image(2, 2, 3);
    Look look;
    LookInputs inputs;

    ThicknessCase() {
        // Rows from the top: red green / blue black.
        const float values[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
        std::copy(std::begin(values), std::end(values), map.pixels.begin());
        set.uv.resize(1);
        look.reach = 1.0f;
        look.thickness.map = "map.exr";
        look.thickness.stops = {{{1, 0, 0}, 1.0f, {}}, {{0, 1, 0}, 0.5f, {}}, {{0, 0, 1}, 0.25f, {}}};
        look.radius.vertical_scale = 0.0f;  // radius is 0.25 (1 - x), so it tells x
        inputs.thickness_map = &map;
    }
    double reach_at(float u, float v) {
        set.uv[0] = {u, v};
        set.distance[0] = 0.0625f;
        const double x = 1.0 - 4.0 * double(shade(set, look, inputs).radius.at(0));
        return 0.0625 / x;
    }
};

double weight(double r, double g, double b, glm::vec3 key) {
    const double d = (r - double(key.x)) * (r - double(key.x)) + (g - double(key.y)) * (g - double(key.y)) +
                     (b - double(key.z)) * (b - double(key.z)) + 1e-4;
    return 1.0 / (d * d);
}

TEST(Thickness, StopsWeighAsTheirDistanceInTheMap) {
    ThicknessCase c;
    const double near = 1.0 / 1e-8, far = 1.0 / ((2.0 + 1e-4) * (2.0 + 1e-4));
    const double sum = near + 2.0 * far;
    EXPECT_NEAR(c.reach_at(0.25f, 0.75f), (near + far * 0.5 + far * 0.25) / sum, 1e-5);  // red: top left
    EXPECT_NEAR(c.reach_at(0.75f, 0.75f), (far + near * 0.5 + far * 0.25) / sum, 1e-5);  // green: top right
    EXPECT_NEAR(c.reach_at(0.25f, 0.25f), (far + far * 0.5 + near * 0.25) / sum, 1e-5);  // blue: bottom left
}

TEST(Thickness, MapIsReadBilinearlyAndClamped) {
    ThicknessCase c;
    const auto expected = [&](double r, double g, double b) {
        double sum = 0.0, reach = 0.0;
        for (const ThicknessStop& key : c.look.thickness.stops) {
            const double w = weight(r, g, b, key.color);
            sum += w;
            reach += w * double(key.scale);
        }
        return reach / sum;
    };
    EXPECT_NEAR(c.reach_at(0.5f, 0.75f), expected(0.5, 0.5, 0.0), 1e-5);
    EXPECT_NEAR(c.reach_at(0.375f, 0.625f), expected(0.5625, 0.1875, 0.1875), 1e-5);
    EXPECT_NEAR(c.reach_at(-3.0f, 9.0f), expected(1.0, 0.0, 0.0), 1e-5);
    EXPECT_NEAR(c.reach_at(0.25f, -9.0f), expected(0.0, 0.0, 1.0), 1e-5);
}

TEST(Thickness, PdfIsTheWeightedMeanOfTheStops) {
    constexpr std::int64_t count = 40000;
    ThicknessCase c;
    c.set = test::file_set(count);
    c.set.uv.assign(std::size_t(count), {0.5f, 0.75f});  // half red, half green
    for (float& d : c.set.distance) d = 0.25f;
    c.look.thickness.stops.resize(2);
    c.look.thickness.stops[0] = {{1, 0, 0}, 1.0f, {}};
    c.look.thickness.stops[1] = {{0, 1, 0}, 1.0f, {}};
    c.look.thickness.stops[1].pdf.shape = DensityCurve::Shape::quadratic;
    const double p = 0.5 + 0.5 * 0.75 * 0.75;
    EXPECT_NEAR(double(shade(c.set, c.look, c.inputs).size()) / double(count), p,
                5.0 * std::sqrt(p * (1.0 - p) / double(count)));
}

TEST(Thickness, WithoutAMapTheFirstStopCounts) {
    Look look;
    look.reach = 1.0f;
    look.thickness.stops = {{{1, 0, 0}, 0.5f, {}}, {{0, 1, 0}, 9.0f, {}}};
    EXPECT_EQ(shade(one_splat(0.5f, 1.0f, 1.0f), look).size(), 1);
    EXPECT_EQ(shade(one_splat(0.51f, 1.0f, 1.0f), look).size(), 0);
}

// --- noise ---

float fbm(const Noise& noise, float x, float y, float z) {
    float sum = 0.0f, amplitude = 1.0f;
    for (int i = 0; i < noise.octaves; ++i, amplitude *= noise.gain) sum += amplitude;
    return shared::as_fbm(x, y, z, noise.frequency, noise.octaves, noise.lacunarity, noise.gain, 1.0f / sum,
                          std::uint32_t(noise.seed));
}

struct NoiseCase {
    SplatSet set = one_splat(0.5f, 0.4f, 0.5f);
    Look look;
    NoiseCase() { look.noise.resize(1); }
    Noise& noise() { return look.noise[0]; }
    float n() { return fbm(noise(), 1.0f, 2.0f, 3.0f); }
    float across() { return fbm(noise(), 1.0f, 0.0f, 3.0f); }
};

TEST(Noise, JitterMovesAlongTheAxis) {
    NoiseCase c;
    c.noise().jitter = 0.7f;
    LookInputs inputs;
    EXPECT_EQ(shade(c.set, c.look, inputs).position.at(0), glm::vec3(1.0f, 2.0f + c.n() * 0.7f, 3.0f));
    inputs.axis = {0.0f, 0.0f, 2.0f};  // its length does not matter
    EXPECT_EQ(shade(c.set, c.look, inputs).position.at(0), glm::vec3(1.0f, 2.0f, 3.0f + c.n() * 0.7f));
}

TEST(Noise, AlphaAndBrightnessMultiply) {
    NoiseCase c;
    c.noise().alpha = 0.8f;
    EXPECT_FLOAT_EQ(alpha_of(c.set, c.look), 0.4f * (1.0f + 0.8f * c.n()));
    EXPECT_EQ(grey_of(c.set, c.look), 0.5f);
    c.noise().alpha = 0.0f;
    c.noise().brightness = 0.6f;
    EXPECT_FLOAT_EQ(grey_of(c.set, c.look), 0.5f * (1.0f + 0.6f * c.n()));
    EXPECT_EQ(alpha_of(c.set, c.look), 0.4f);
}

TEST(Noise, SilhouetteTakesReachByTheNoiseAcrossTheAxis) {
    NoiseCase c;
    c.noise().silhouette = 0.9f;
    c.look.reach = 2.0f;
    c.look.radius.vertical_scale = 0.0f;
    const double reach = 2.0 * (1.0 - 0.9 * (0.5 + 0.5 * double(c.across())));
    EXPECT_NEAR(radius_of(c.set, c.look), 0.25 * (1.0 - 0.5 / reach), 1e-6);
    c.set.position[0].y = -7.0f;  // along the axis nothing changes
    EXPECT_NEAR(radius_of(c.set, c.look), 0.25 * (1.0 - 0.5 / reach), 1e-6);
}

TEST(Noise, CullTakesDensity) {
    constexpr std::int64_t count = 40000;
    NoiseCase c;
    const SplatSet one = c.set;
    c.set = test::file_set(count);
    for (glm::vec3& p : c.set.position) p = one.position[0];
    c.noise().cull = 0.8f;
    const double p = 1.0 - 0.8 * (0.5 + 0.5 * double(c.n()));
    EXPECT_NEAR(double(shade(c.set, c.look).size()) / double(count), p,
                5.0 * std::sqrt(p * (1.0 - p) / double(count)));
}

TEST(Noise, EntriesOfAListWorkTogether) {
    NoiseCase c;
    c.look.noise.resize(3);
    c.look.noise[0].alpha = 0.5f;
    c.look.noise[1] = {7.0f, 2, 2.0f, 0.5f, 5, 0.0f, 0.0f, 0.0f, 0.3f, 0.0f};
    c.look.noise[2] = {3.0f, 1, 2.0f, 0.5f, 9, 0.0f, 0.0f, 0.2f, 0.0f, 0.0f};
    const ShadedSplats shaded = shade(c.set, c.look);
    EXPECT_FLOAT_EQ(shaded.alpha[0], 0.4f * (1.0f + 0.5f * fbm(c.look.noise[0], 1, 2, 3)) *
                                         (1.0f + 0.3f * fbm(c.look.noise[1], 1, 2, 3)));
    EXPECT_FLOAT_EQ(shaded.position[0].y, 2.0f + 0.2f * fbm(c.look.noise[2], 1, 2, 3));
}

// --- horizontal alpha ---

TEST(HorizontalAlpha, PowerActsBelowTheThreshold) {
    Look look;
    look.alpha.power = 3.0f;
    EXPECT_NEAR(alpha_of(one_splat(0, 0.5f, 1), look), 0.125, 1e-6);
    EXPECT_EQ(alpha_of(one_splat(0, 0.96f, 1), look), 0.96f);
    EXPECT_EQ(alpha_of(one_splat(0, 0.95f, 1), look), 0.95f);
    EXPECT_EQ(alpha_of(one_splat(0, 0.0f, 1), look), 0.0f);
}

TEST(HorizontalAlpha, UnpremultiplyDividesBelowTheThreshold) {
    Look look;
    look.alpha.unpremultiply = true;
    look.alpha.power = 2.0f;  // the colour is divided by the alpha before the power
    EXPECT_FLOAT_EQ(grey_of(one_splat(0, 0.5f, 0.25f), look), 0.5f);
    EXPECT_EQ(grey_of(one_splat(0, 0.97f, 0.25f), look), 0.25f);
    EXPECT_EQ(grey_of(one_splat(0, 0.0f, 0.25f), look), 0.25f);
}

TEST(HorizontalAlpha, GainMultipliesAndClamps) {
    Look look;
    look.alpha.gain = 1.5f;
    EXPECT_FLOAT_EQ(alpha_of(one_splat(0, 0.5f, 1), look), 0.75f);
    EXPECT_EQ(alpha_of(one_splat(0, 0.97f, 1), look), 1.0f);
}

// --- vertical alpha without match ---

TEST(VerticalAlpha, ShapesMultiply) {
    Look look;
    look.reach = 2.0f;
    look.vertical.rate = 2.0f;
    look.vertical.points = {{0.0f, 1.0f}, {0.25f, 0.2f}};
    const auto at = [&](VerticalAlpha::Shape shape) {
        look.vertical.shape = shape;
        return double(alpha_of(one_splat(0.5f, 0.8f, 1), look));  // x = 1/4
    };
    EXPECT_NEAR(at(VerticalAlpha::Shape::none), 0.8, 1e-7);
    EXPECT_NEAR(at(VerticalAlpha::Shape::constant), 0.8, 1e-7);
    EXPECT_NEAR(at(VerticalAlpha::Shape::linear), 0.8 * 0.75, 1e-6);
    EXPECT_NEAR(at(VerticalAlpha::Shape::exponential), 0.8 * std::exp(-0.5), 1e-6);
    EXPECT_NEAR(at(VerticalAlpha::Shape::s106), 0.8 * (1.0 - 1.515 * 0.25), 1e-6);
    EXPECT_NEAR(at(VerticalAlpha::Shape::curve), 0.8 * 0.2, 1e-6);
}

TEST(VerticalAlpha, HasItsOwnReachForTheShapeOnly) {
    Look look;
    look.reach = 2.0f;
    look.vertical.shape = VerticalAlpha::Shape::linear;
    look.vertical.reach = 1.0f;
    look.radius.vertical_scale = 0.0f;
    EXPECT_NEAR(alpha_of(one_splat(0.25f, 0.8f, 1), look), 0.8 * 0.75, 1e-6);
    EXPECT_NEAR(radius_of(one_splat(0.25f, 0.8f, 1), look), 0.25 * 0.875, 1e-6);
    EXPECT_EQ(alpha_of(one_splat(1.5f, 0.8f, 1), look), 0.0f);  // kept, but f is 0
}

// --- radius ---

TEST(Radius, IsUniformBetweenItsBounds) {
    constexpr std::int64_t count = 100000;
    Look look;
    look.radius.min = 0.2f;
    look.radius.max = 0.6f;
    const ShadedSplats shaded = shade(test::file_set(count), look);
    double sum = 0.0, squares = 0.0;
    for (float r : shaded.radius) {
        ASSERT_GE(r, 0.2f);
        ASSERT_LT(r, 0.6f);
        sum += double(r);
        squares += double(r) * double(r);
    }
    EXPECT_NEAR(sum / count, 0.4, 5.0 * 0.4 / std::sqrt(12.0 * count));
    EXPECT_NEAR(squares / count, (0.04 + 0.12 + 0.36) / 3.0, 0.001);
}

TEST(Radius, FactorsFollowAlphaAndX) {
    Look look;
    look.reach = 2.0f;
    look.radius.horizontal_scale = 3.0f;
    EXPECT_NEAR(radius_of(one_splat(0.5f, 0.75f, 1), look), 0.25 * 1.5, 1e-6);
    look.radius.vertical_scale = 0.5f;
    EXPECT_NEAR(radius_of(one_splat(0.5f, 0.75f, 1), look), 0.25 * 1.5 * 0.875, 1e-6);
    look.alpha.power = 2.0f;  // the alpha of step 4
    EXPECT_NEAR(radius_of(one_splat(0.5f, 0.75f, 1), look), 0.25 * (1.0 + 2.0 * 0.4375) * 0.875, 1e-6);
}

TEST(Radius, OfGeneratedSetsIsPointSixDiagonals) {
    SplatSet set = one_splat(0, 1, 1);
    set.radius.clear();
    set.generated = true;
    set.spacing = {1.0, 2.0, 2.0};
    EXPECT_FLOAT_EQ(radius_of(set, {}), 1.8f);
}

// --- grade ---

TEST(Grade, BlackGainAndTint) {
    Look look;
    look.grade.black = 0.2f;
    EXPECT_FLOAT_EQ(grey_of(one_splat(0, 1, 0.6f), look), 0.5f);
    EXPECT_EQ(grey_of(one_splat(0, 1, 0.1f), look), 0.0f);
    look.grade.gain = 2.0f;
    look.grade.tint = {1.0f, 0.5f, 0.25f};
    const glm::vec3 c = shade(one_splat(0, 1, 0.6f), look).color.at(0);
    EXPECT_FLOAT_EQ(c.x, 1.0f);
    EXPECT_FLOAT_EQ(c.y, 0.5f);
    EXPECT_FLOAT_EQ(c.z, 0.25f);
}

TEST(Grade, SplatsThatAbsorbKeepColourAndAlpha) {
    SplatSet set = one_splat(0.5f, 0.3f, 0.6f);
    set.color[0] = {-0.8f, -1.0f, -1.35f};
    Look look;
    look.grade.gain = 2.0f;
    look.alpha.power = 3.0f;
    look.vertical.shape = VerticalAlpha::Shape::linear;
    EXPECT_EQ(shade(set, look).color.at(0), glm::vec3(0.0f));  // as in any file
    set.absorbs = true;
    const ShadedSplats dust = shade(set, look);
    EXPECT_EQ(dust.color.at(0), set.color[0]);
    EXPECT_EQ(dust.alpha.at(0), 0.3f);
}

TEST(Grade, SaturationTurnsAboutLuminance) {
    SplatSet set = one_splat(0, 1, 0);
    set.color[0] = {1.0f, 0.5f, 0.0f};
    Look look;
    look.grade.saturation = 0.0f;
    const float y = 0.2126f + 0.7152f * 0.5f;
    const glm::vec3 grey = shade(set, look).color.at(0);
    EXPECT_FLOAT_EQ(grey.x, y);
    EXPECT_FLOAT_EQ(grey.z, y);
    look.grade.saturation = 2.0f;
    const glm::vec3 strong = shade(set, look).color.at(0);
    EXPECT_FLOAT_EQ(strong.x, 2.0f - y);
    EXPECT_FLOAT_EQ(strong.y, 1.0f - y);
    EXPECT_EQ(strong.z, 0.0f);
}

TEST(Grade, GammaIsLast) {
    Look look;
    look.grade.gamma = 2.0f;
    look.grade.gain = 0.5f;
    EXPECT_NEAR(grey_of(one_splat(0, 1, 0.5f), look), 0.5, 1e-6);
}

}  // namespace
}  // namespace astrosplat
