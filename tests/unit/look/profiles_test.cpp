// Shapes over x against published numbers and closed forms, and crops.
#include "look/prepare.h"
#include "support/test.h"
#include "unit/look/sets.h"

namespace astrosplat {
namespace {

// Shapes over x: published numbers, curves after Fritsch and Carlson, kept fractions,
// and the integrals of columns.

using Shape = DensityCurve::Shape;
using namespace shared_types;

double formula(int shape, double rate, double x) {
    return double(shared::look_formula(shape, float(rate), float(x)));
}

TEST(Profile, S106HasThePublishedPieces) {
    EXPECT_FLOAT_EQ(shared::look_s106(0.0f), 1.0f);
    EXPECT_NEAR(shared::look_s106(0.2f), 1.0 - 1.515 * 0.2, 1e-6);
    EXPECT_NEAR(shared::look_s106(0.33f), 0.9 - 1.212 * 0.33, 1e-6);
    EXPECT_NEAR(shared::look_s106(0.5f), 0.9 - 1.212 * 0.5, 1e-6);
    EXPECT_NEAR(shared::look_s106(0.66f), 0.294 - 0.294 * 0.66, 1e-6);
    EXPECT_NEAR(shared::look_s106(0.9f), 0.0294, 1e-6);
    EXPECT_EQ(shared::look_s106(1.0f), 0.0f);
    EXPECT_EQ(shared::look_s106(7.0f), 0.0f);
}

TEST(Profile, FormulasAreThoseOfTheDesign) {
    for (double x : {0.0, 0.1, 0.25, 0.5, 0.75, 1.0}) {
        EXPECT_EQ(formula(PROFILE_CONSTANT, 3.0, x), 1.0);
        EXPECT_NEAR(formula(PROFILE_LINEAR, 3.0, x), 1.0 - x, 1e-6);
        EXPECT_NEAR(formula(PROFILE_QUADRATIC, 3.0, x), (1.0 - x) * (1.0 - x), 1e-6);
        EXPECT_NEAR(formula(PROFILE_EXPONENTIAL, 3.0, x), std::exp(-3.0 * x), 1e-6);
        EXPECT_NEAR(formula(PROFILE_GAUSSIAN, 3.0, x), std::exp(-3.0 * x * x), 1e-6);
        EXPECT_NEAR(formula(PROFILE_SMOOTH, 3.0, x), 1.0 - x * x * (3.0 - 2.0 * x), 1e-6);
    }
}

float at(const LookCurve& curve, double x) { return shared::look_curve(curve, float(x)); }

TEST(Curve, PassesThroughItsPointsAndIsConstantOutside) {
    const std::vector<glm::vec2> points = {
        {0.1f, 0.3f}, {0.2f, 0.9f}, {0.5f, 0.85f}, {0.55f, 0.1f}, {0.9f, 0.1f}};
    const LookCurve curve = make_curve(points, "k");
    for (const glm::vec2& p : points) EXPECT_EQ(at(curve, double(p.x)), p.y);
    EXPECT_EQ(at(curve, 0.0), 0.3f);
    EXPECT_EQ(at(curve, -5.0), 0.3f);
    EXPECT_EQ(at(curve, 2.0), 0.1f);
}

TEST(Curve, NeverLeavesTheRangeOfTwoNeighbours) {
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<glm::vec2> points;
        float x = 0.0f;
        for (int i = 0; i < 9; ++i) {
            const float step = test::uniform(trial * 9 + i, 30);
            x += 0.001f + step * step * step;
            points.push_back({x, test::uniform(trial * 9 + i, 31)});
        }
        const LookCurve curve = make_curve(points, "k");
        for (int i = 0; i + 1 < 9; ++i) {
            const glm::vec2 a = points[std::size_t(i)], b = points[std::size_t(i) + 1];
            float before = a.y;
            for (int k = 0; k <= 50; ++k) {
                const float y = at(curve, double(a.x) + (double(b.x) - double(a.x)) * k / 50.0);
                ASSERT_GE(y, std::min(a.y, b.y));
                ASSERT_LE(y, std::max(a.y, b.y));
                // Monotone up to the rounding of a float sum.
                ASSERT_GE((y - before) * (b.y > a.y ? 1.0f : -1.0f), -1e-6f);
                before = y;
            }
        }
    }
}

// Interior tangent of y = x^2 at 0, 1, 2 is the mean of the slopes 1 and 3: 2, the true one; on [1, 2] the
// Hermite cubic through (1, 1), (2, 4) with tangents 2 and 3 is worked out by hand at its middle: 2.5 + (2 -
// 3) / 8.
TEST(Curve, TangentsAreMeansOfSlopes) {
    const std::vector<glm::vec2> points = {{0.0f, 0.0f}, {1.0f, 1.0f}, {2.0f, 4.0f}};
    const LookCurve curve = make_curve(points, "k");
    EXPECT_FLOAT_EQ(curve.knots[1].z, 2.0f);
    EXPECT_FLOAT_EQ(curve.knots[2].z, 3.0f);
    EXPECT_FLOAT_EQ(at(curve, 1.5), 2.375f);
}

TEST(Curve, IsStraightThroughPointsOnALine) {
    const std::vector<glm::vec2> points = {{0.0f, 1.0f}, {0.3f, 0.7f}, {0.4f, 0.6f}, {1.0f, 0.0f}};
    const LookCurve curve = make_curve(points, "k");
    for (int i = 0; i <= 100; ++i) EXPECT_NEAR(at(curve, i / 100.0), 1.0 - i / 100.0, 1e-6);
}

TEST(Curve, WithoutPointsIsOne) { EXPECT_EQ(at(make_curve({}, "k"), 0.4), 1.0f); }

// Kept fraction at known x against p(x), within five standard deviations of the binomial.
TEST(Density, KeepsWhatEveryPdfSays) {
    constexpr std::int64_t count = 40000;
    SplatSet set = test::file_set(count);
    Look look;
    look.reach = 2.0f;
    look.density = 0.9f;
    look.pdf.rate = 2.0f;
    look.pdf.sigma = 0.4f;
    look.pdf.points = {{0.0f, 0.2f}, {0.5f, 0.8f}, {1.0f, 0.1f}};
    const auto wanted = [&](Shape shape, double x) {
        if (shape == Shape::linear) return 1.0 - x;
        if (shape == Shape::quadratic) return (1.0 - x) * (1.0 - x);
        if (shape == Shape::exponential) return std::exp(-2.0 * x);
        if (shape == Shape::gaussian) return std::exp(-x * x / (2.0 * 0.4 * 0.4));
        if (shape == Shape::smooth) return 1.0 - x * x * (3.0 - 2.0 * x);
        if (shape == Shape::curve) return x == 0.0 ? 0.2 : x == 0.5 ? 0.8 : x == 1.0 ? 0.1 : -1.0;
        return 1.0;
    };
    for (Shape shape : {Shape::constant, Shape::linear, Shape::quadratic, Shape::exponential, Shape::gaussian,
                        Shape::smooth, Shape::curve})
        for (double x : {0.0, 0.25, 0.5, 0.75, 1.0}) {
            const double p = 0.9 * wanted(shape, x);
            if (p < 0.0) continue;
            look.pdf.shape = shape;
            for (float& d : set.distance) d = float(2.0 * x);
            const double kept = double(apply_look(set, look, {}).size()) / double(count);
            EXPECT_NEAR(kept, p, 5.0 * std::sqrt(p * (1.0 - p) / double(count)) + 1e-12)
                << int(shape) << " at " << x;
        }
}

ColumnProfile column_of(int pdf, int vertical) {
    ColumnProfile column{};
    column.pdf.shape = pdf;
    column.pdf.rate = 3.0f;
    column.vertical.shape = vertical;
    column.vertical.rate = 2.0f;
    column.density = 1.0;
    column.end = 1.0;
    column.vertical_ratio = 1.0;
    return column;
}

TEST(ColumnIntegral, ClosedForms) {
    EXPECT_NEAR(column_integral(column_of(PROFILE_CONSTANT, PROFILE_CONSTANT), 1.0), 1.0, 1e-6);
    EXPECT_NEAR(column_integral(column_of(PROFILE_LINEAR, PROFILE_LINEAR), 1.0), 1.0 / 3.0, 1e-6);
    EXPECT_NEAR(column_integral(column_of(PROFILE_EXPONENTIAL, PROFILE_EXPONENTIAL), 1.0),
                (1.0 - std::exp(-5.0)) / 5.0, 1e-6);
    // v = 1 + x: Integral of (1 + x)^2 = 7/3.
    EXPECT_NEAR(column_integral(column_of(PROFILE_CONSTANT, PROFILE_CONSTANT), 2.0), 7.0 / 3.0, 1e-6);
    const double s106 = (0.33 - 1.515 * 0.33 * 0.33 / 2.0) +
                        (0.9 * 0.33 - 1.212 * (0.66 * 0.66 - 0.33 * 0.33) / 2.0) + 0.294 * 0.34 * 0.34 / 2.0;
    EXPECT_NEAR(column_integral(column_of(PROFILE_CONSTANT, PROFILE_S106), 1.0), s106, 1e-6);
    ColumnProfile half = column_of(PROFILE_CONSTANT, PROFILE_LINEAR);
    half.vertical_ratio = 2.0;  // 1 - 2x up to 1/2
    EXPECT_NEAR(column_integral(half, 1.0), 0.25, 1e-6);
    ColumnProfile cut = column_of(PROFILE_CONSTANT, PROFILE_LINEAR);
    cut.end = 0.5;
    EXPECT_NEAR(column_integral(cut, 1.0), 0.375, 1e-6);
    ColumnProfile dense = column_of(PROFILE_LINEAR, PROFILE_CONSTANT);
    dense.density = 2.0;  // min(1, 2 - 2x)
    EXPECT_NEAR(column_integral(dense, 1.0), 0.75, 1e-4);
}

TEST(ColumnIntegral, MeanSquareOfAUniformRadius) {
    EXPECT_DOUBLE_EQ(mean_square(2.0, 2.0), 4.0);
    EXPECT_DOUBLE_EQ(mean_square(0.0, 3.0), 3.0);
}

// Crops against their closed forms: what is kept, and the opacity within their soft edges.

/// Alpha 1 after the crops, at a place of the layer; 0: dropped.
float left_at(const glm::vec3& place, const std::vector<Crop>& crops) {
    SplatSet set = test::one_splat(0.0f, 1.0f, 1.0f);
    set.position[0] = place;
    Look look;
    look.crop = crops;
    const ShadedSplats shaded = test::shade(set, look);
    return shaded.size() == 0 ? 0.0f : shaded.alpha[0];
}

Crop box_of(const glm::vec3& center, const glm::vec3& size) {
    Crop crop;
    crop.center = center;
    crop.size = size;
    return crop;
}

Crop sphere_of(const glm::vec3& center, float radius) {
    Crop crop;
    crop.shape = Crop::Shape::sphere;
    crop.center = center;
    crop.radius = radius;
    return crop;
}

float smooth(float t) { return t * t * (3.0f - 2.0f * t); }

TEST(Crop, ABoxKeepsWhatLiesInIt) {
    const Crop box = box_of({1.0f, 2.0f, 3.0f}, {2.0f, 4.0f, 6.0f});
    EXPECT_EQ(left_at({1.0f, 2.0f, 3.0f}, {box}), 1.0f);
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            glm::vec3 place = box.center;
            place[axis] += side * 0.5f * box.size[axis];
            EXPECT_EQ(left_at(place, {box}), 1.0f) << "its surface is inside";
            place[axis] += side * 0.001f;
            EXPECT_EQ(left_at(place, {box}), 0.0f);
        }
}

TEST(Crop, ASphereKeepsWhatLiesInIt) {
    const Crop sphere = sphere_of({1.0f, 0.0f, -1.0f}, 5.0f);
    EXPECT_EQ(left_at({4.0f, 4.0f, -1.0f}, {sphere}), 1.0f);
    EXPECT_EQ(left_at({4.0f, 4.01f, -1.0f}, {sphere}), 0.0f);
    EXPECT_EQ(left_at({1.0f, 0.0f, -6.01f}, {sphere}), 0.0f);
}

Crop outline_of(const std::string& lines, float width = 0.0f) {
    Crop crop;
    crop.shape = Crop::Shape::outline;
    crop.outline = lines;
    crop.width = width;
    crop.center = {1.0f, 2.0f, 10.0f};
    return crop;
}

/// A place at a depth of an unturned outline's view.
glm::vec3 seen_at(const glm::vec2& place, float depth) {
    return {1.0f + depth * place.x, 2.0f + depth * place.y, 10.0f - depth};
}

TEST(Crop, AnOutlineKeepsWhatLiesBehindIt) {
    const Crop square = outline_of("M -0.5 -0.25 0.5 -0.25 0.5 0.25 -0.5 0.25");
    for (const float depth : {0.25f, 4.0f, 1024.0f}) {  // powers of two: no rounding
        EXPECT_EQ(left_at(seen_at({0.4375f, 0.1875f}, depth), {square}), 1.0f) << depth;
        EXPECT_EQ(left_at(seen_at({0.5625f, 0.1875f}, depth), {square}), 0.0f) << depth;
        EXPECT_EQ(left_at(seen_at({0.4375f, -0.3125f}, depth), {square}), 0.0f) << depth;
    }
    EXPECT_EQ(left_at(seen_at({0.0f, 0.0f}, -4.0f), {square}), 0.0f) << "behind the eye";
    Crop turned = square;
    turned.rotate = {0.0f, 0.0f, 90.0f};  // of the view: its right is the layer's up
    EXPECT_EQ(left_at(seen_at({0.1875f, 0.4375f}, 4.0f), {turned}), 1.0f);
    EXPECT_EQ(left_at(seen_at({0.4375f, 0.1875f}, 4.0f), {turned}), 0.0f);
    Crop parallel = square;
    parallel.parallel = true;
    EXPECT_EQ(left_at({1.4375f, 2.1875f, -90.0f}, {parallel}), 1.0f);
    EXPECT_EQ(left_at({1.4375f, 2.1875f, 90.0f}, {parallel}), 1.0f) << "there is no eye";
    EXPECT_EQ(left_at({1.5625f, 2.1875f, -90.0f}, {parallel}), 0.0f);
}

TEST(Crop, APolygonInAnotherIsAHole) {
    const Crop ring = outline_of("M -1 -1 1 -1 1 1 -1 1 M -0.5 -0.5 0.5 -0.5 0.5 0.5 -0.5 0.5");
    EXPECT_EQ(left_at(seen_at({0.75f, 0.0f}, 3.0f), {ring}), 1.0f);
    EXPECT_EQ(left_at(seen_at({0.25f, 0.0f}, 3.0f), {ring}), 0.0f);
}

/// Polygons that cross themselves, against the angles that their edges span, which go around a place.
TEST(Crop, PolygonsAgainstTheirAngles) {
    for (std::int64_t shape = 0; shape < 8; ++shape) {
        std::vector<std::vector<glm::vec2>> lines(1);
        for (std::int64_t i = 0; i < 3 + 2 * shape; ++i)
            lines[0].emplace_back(test::uniform(64 * shape + i, 81) - 0.5f,
                                  std::round(8.0f * test::uniform(64 * shape + i, 82)) / 8.0f - 0.5f);
        const Crop crop = outline_of(outline_text(lines));
        lines = outline_lines(crop.outline);
        for (std::int64_t i = 0; i < 200; ++i) {
            const glm::vec2 place{test::uniform(i, 83) - 0.5f, test::uniform(i, 84) - 0.5f};
            double angle = 0.0;
            for (std::size_t k = 0; k < lines[0].size(); ++k) {
                const glm::dvec2 a = glm::dvec2(lines[0][k]) - glm::dvec2(place);
                const glm::dvec2 b = glm::dvec2(lines[0][(k + 1) % lines[0].size()]) - glm::dvec2(place);
                angle += std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
            }
            const bool inside = std::llround(angle / (2.0 * 3.14159265358979)) % 2 != 0;
            ASSERT_EQ(left_at(seen_at(place, 2.0f), {crop}), inside ? 1.0f : 0.0f)
                << crop.outline << " at " << place.x << " " << place.y;
        }
    }
}

TEST(Crop, StrokesTakeWhatAnyOfThemCovers) {
    Crop strokes = outline_of("M -0.5 0 0 0 M -0.25 -0.25 -0.25 0.25 M 0.5 0.5 0.5 0.75", 0.25f);
    for (const Crop::Keep keep : {Crop::Keep::inside, Crop::Keep::outside}) {
        strokes.keep = keep;
        const float covered = keep == Crop::Keep::inside ? 1.0f : 0.0f;
        for (const glm::vec2& place : {glm::vec2(-0.25f, 0.0f),
                                       {-0.4375f, 0.0625f},
                                       {-0.1875f, 0.1875f},
                                       {0.0625f, 0.0f},
                                       {0.4375f, 0.625f}})
            EXPECT_EQ(left_at(seen_at(place, 4.0f), {strokes}), covered) << place.x << " " << place.y;
        for (const glm::vec2& place :
             {glm::vec2(0.1875f, 0.0f), {-0.4375f, 0.1875f}, {0.09375f, 0.09375f}, {0.3125f, 0.625f}})
            EXPECT_EQ(left_at(seen_at(place, 4.0f), {strokes}), 1.0f - covered) << place.x << " " << place.y;
    }
}

/// In scene units at the splat's depth, on both sides of the line.
TEST(Crop, TheSoftEdgeOfAnOutline) {
    Crop square = outline_of("M -0.5 -0.5 0.5 -0.5 0.5 0.5 -0.5 0.5");
    Crop stroke = outline_of("M -0.25 -0.5 -0.25 0.5", 1.5f);  // its right rim at the square's
    square.soft = stroke.soft = 0.8f;
    for (const Crop& crop : {square, stroke})
        for (const float depth : {2.0f, 8.0f}) {
            const float rim = 1.0f + 0.5f * depth, z = 10.0f - depth;
            EXPECT_NEAR(left_at({rim - 0.2f, 2.0f, z}, {crop}), smooth(0.75f), 2e-5f);
            EXPECT_NEAR(left_at({rim, 2.0f, z}, {crop}), 0.5f, 2e-5f);
            EXPECT_NEAR(left_at({rim + 0.2f, 2.0f, z}, {crop}), smooth(0.25f), 2e-5f);
            EXPECT_EQ(left_at({rim + 0.41f, 2.0f, z}, {crop}), 0.0f);
        }
}

TEST(Crop, OutlinesAreReadAsTheyAreWritten) {
    const std::vector<std::vector<glm::vec2>> lines{{{0.125f, -3.0f}, {1e-4f, 2.5f}},
                                                    {{7.0f, 8.0f}, {9.0f, 10.0f}}};
    EXPECT_EQ(outline_text(lines), "M 0.125 -3 0.0001 2.5 M 7 8 9 10");
    EXPECT_EQ(outline_lines(outline_text(lines)), lines);
    EXPECT_EQ(outline_lines(" M0.125,-3 1e-4,2.5\nM7 8 9 10 "), lines);
    for (const char* wrong : {"", "1 2 3 4", "M", "M 1 2", "M 1 2 3", "M 1 2 3 4 M", "M 1 2 3 x",
                              "M 1 2 L 3 4", "M 1 2 3 nan", "M 1 2 3 1e9", "M 1 2 3 4e99"})
        EXPECT_THROW(outline_lines(wrong), InputError) << wrong;
}

TEST(Crop, OpacityFallsOverTheSoftEdge) {
    Crop box = box_of({0.0f, 0.0f, 0.0f}, {4.0f, 4.0f, 4.0f});
    Crop sphere = sphere_of({0.0f, 0.0f, 0.0f}, 2.0f);
    box.soft = sphere.soft = 0.8f;
    for (const Crop& crop : {box, sphere}) {
        EXPECT_EQ(left_at({1.6f, 0.0f, 0.0f}, {crop}), 1.0f);
        EXPECT_NEAR(left_at({1.8f, 0.0f, 0.0f}, {crop}), smooth(0.75f), 1e-6f);
        EXPECT_NEAR(left_at({2.0f, 0.0f, 0.0f}, {crop}), 0.5f, 1e-6f);
        EXPECT_NEAR(left_at({0.0f, -2.2f, 0.0f}, {crop}), smooth(0.25f), 1e-6f);
        EXPECT_EQ(left_at({0.0f, 0.0f, 2.4f}, {crop}), 0.0f);
    }
}

/// Outside of an edge or a corner the distance is that from it.
TEST(Crop, TheSoftEdgeOfABoxIsRound) {
    Crop box = box_of({0.0f, 0.0f, 0.0f}, {2.0f, 2.0f, 2.0f});
    box.soft = 2.0f;
    EXPECT_NEAR(left_at({1.3f, 1.4f, 0.0f}, {box}), smooth(0.25f), 1e-6f);
    const float each = 0.5f / std::sqrt(3.0f);
    EXPECT_NEAR(left_at(glm::vec3(1.0f + each), {box}), smooth(0.25f), 1e-5f);
}

TEST(Crop, OutsideIsTheRest) {
    for (const float soft : {0.0f, 1.0f})
        for (Crop crop :
             {box_of({0.0f, 0.0f, 0.0f}, {2.0f, 2.0f, 2.0f}), sphere_of({0.0f, 0.0f, 0.0f}, 1.0f)}) {
            crop.soft = soft;
            Crop rest = crop;
            rest.keep = Crop::Keep::outside;
            for (const float x : {0.0f, 0.6f, 0.9f, 1.0f, 1.2f, 1.6f})
                EXPECT_NEAR(left_at({x, 0.0f, 0.0f}, {crop}) + left_at({x, 0.0f, 0.0f}, {rest}), 1.0f, 1e-6f)
                    << x;
        }
}

TEST(Crop, ABoxIsTurnedAboutItsCentre) {
    Crop box = box_of({10.0f, 0.0f, 0.0f}, {4.0f, 1.0f, 1.0f});
    box.rotate = {0.0f, 0.0f, 90.0f};
    EXPECT_EQ(left_at({10.0f, 1.9f, 0.0f}, {box}), 1.0f);
    EXPECT_EQ(left_at({11.9f, 0.0f, 0.0f}, {box}), 0.0f);
    box.rotate = {0.0f, 0.0f, 45.0f};
    EXPECT_EQ(left_at({11.3f, 1.3f, 0.0f}, {box}), 1.0f);
    EXPECT_EQ(left_at({11.3f, -1.3f, 0.0f}, {box}), 0.0f);
}

TEST(Crop, OfSeveralAllHold) {
    Crop wide = box_of({0.0f, 0.0f, 0.0f}, {4.0f, 4.0f, 4.0f}), hole = sphere_of({0.0f, 0.0f, 0.0f}, 1.0f);
    hole.keep = Crop::Keep::outside;
    EXPECT_EQ(left_at({0.5f, 0.0f, 0.0f}, {wide, hole}), 0.0f);
    EXPECT_EQ(left_at({1.5f, 0.0f, 0.0f}, {wide, hole}), 1.0f);
    EXPECT_EQ(left_at({2.5f, 0.0f, 0.0f}, {wide, hole}), 0.0f);
    wide.soft = hole.soft = 2.0f;
    EXPECT_NEAR(left_at({1.5f, 0.0f, 0.0f}, {wide, hole}), smooth(0.75f) * smooth(0.75f), 1e-6f);
}

TEST(Crop, DustFadesToo) {
    SplatSet set = test::one_splat(0.0f, 0.6f, -1.0f);
    set.absorbs = true;
    Look look;
    look.crop = {box_of(set.position[0] + glm::vec3(1.0f, 0.0f, 0.0f), {2.0f, 9.0f, 9.0f})};
    look.crop[0].soft = 0.5f;
    EXPECT_NEAR(test::shade(set, look).alpha.at(0), 0.3f, 1e-6f);
    EXPECT_EQ(test::shade(set, look).color.at(0).x, -1.0f);
}

TEST(Crop, OneThatCutsNothingChangesNoBit) {
    const SplatSet set = test::file_set(3000);
    Look look;
    const ShadedSplats before = test::shade(set, look);
    look.crop = {box_of({0.0f, 0.0f, 0.0f}, glm::vec3(100.0f))};
    const ShadedSplats after = test::shade(set, look);
    ASSERT_EQ(after.size(), before.size());
    EXPECT_EQ(std::memcmp(after.alpha.data(), before.alpha.data(), before.alpha.size() * sizeof(float)), 0);
}

TEST(Crop, MoreThanEightAreRefused) {
    Look look;
    look.crop.resize(9);
    EXPECT_EQ(ERROR_OF(test::shade(test::file_set(1), look)),
              "look.crop: expected at most 8 boxes and spheres, found 9");
}

}  // namespace
}  // namespace astrosplat
