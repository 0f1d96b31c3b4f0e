// Interpolation along a camera's path and along Bezier curves, against values worked out by hand.
#include "camera/keyframe.h"
#include "support/test.h"

namespace astrosplat {
namespace {

constexpr Interpolation linear = Interpolation::linear, smooth = Interpolation::smooth,
                        step = Interpolation::step;
using Scalars = std::vector<Keyframe<double>>;
using Positions = std::vector<Keyframe<glm::dvec3>>;
using Rotations = std::vector<Keyframe<glm::dvec4>>;

glm::dvec4 about_y(double degrees) {
    double h = real::radians(degrees) * 0.5;
    return {0.0, real::sin(h), 0.0, real::cos(h)};
}
double degrees_about_y(const glm::dvec4& q) { return real::degrees(2.0 * real::atan2(q.y, q.w)); }

void expect_at(const glm::dvec3& got, const glm::dvec3& expected, double tolerance) {
    EXPECT_NEAR(glm::distance(got, expected), 0.0, tolerance)
        << got.x << " " << got.y << " " << got.z << " instead of " << expected.x << " " << expected.y << " "
        << expected.z;
}

/// Only ratios of intervals and of distances matter, not whether they are far above 1 or below.
TEST(Positions, DoNotDependOnTheUnitsOfTimeAndSpace) {
    const Positions keyframes = {
        {0, {0, 0, 0}, smooth}, {2, {1, 3, 0}, smooth}, {3, {4, 3, 1}, smooth}, {7, {5, 0, 2}, smooth}};
    for (const bool constant_speed : {false, true})
        for (const double scale : {1.0 / 1024.0, 1024.0}) {
            Positions longer = keyframes, larger = keyframes;
            for (auto& keyframe : longer) keyframe.frame *= scale;
            for (auto& keyframe : larger) keyframe.value *= scale;
            for (double frame = 0.25; frame < 7.0; frame += 0.25) {
                const glm::dvec3 wanted = evaluate_position(keyframes, frame, Ends::through, constant_speed);
                expect_at(evaluate_position(longer, frame * scale, Ends::through, constant_speed), wanted,
                          1e-9);
                expect_at(evaluate_position(larger, frame, Ends::through, constant_speed) / scale, wanted,
                          1e-9);
            }
        }
}

TEST(Scalars, HeldOutsideTheKeyframes) {
    Scalars keyframes = {{1, 5.0, smooth}, {3, 7.0, smooth}};
    EXPECT_EQ(evaluate_scalar(keyframes, -100, Ends::through), 5.0);
    EXPECT_EQ(evaluate_scalar(keyframes, 1, Ends::through), 5.0);
    EXPECT_EQ(evaluate_scalar(keyframes, 3, Ends::through), 7.0);
    EXPECT_EQ(evaluate_scalar(keyframes, 100, Ends::through), 7.0);
    EXPECT_EQ(evaluate_scalar(Scalars{{4, 2.5, linear}}, 9, Ends::ease), 2.5);
}

TEST(Scalars, LinearAndStep) {
    Scalars keyframes = {{0, 1.0, linear}, {10, 2.0, step}, {20, 5.0, linear}};
    EXPECT_DOUBLE_EQ(evaluate_scalar(keyframes, 2.5, Ends::ease), 1.25);
    EXPECT_EQ(evaluate_scalar(keyframes, 10, Ends::ease), 2.0);
    EXPECT_EQ(evaluate_scalar(keyframes, 19.999, Ends::ease), 2.0);
    EXPECT_EQ(evaluate_scalar(keyframes, 20, Ends::ease), 5.0);
}

TEST(Scalars, TwoEasedKeyframesAreSmoothstep) {
    Scalars keyframes = {{0, 0.0, smooth}, {10, 1.0, smooth}};
    for (double u : {0.1, 0.25, 0.5, 0.9})
        EXPECT_NEAR(evaluate_scalar(keyframes, 10 * u, Ends::ease), u * u * (3 - 2 * u), 1e-15);
}

TEST(Scalars, TwoKeyframesThroughAreALine) {
    Scalars keyframes = {{0, 0.0, smooth}, {10, 1.0, smooth}};
    EXPECT_NEAR(evaluate_scalar(keyframes, 3, Ends::through), 0.3, 1e-15);
}

TEST(Scalars, InnerTangentIsTheChordOfTheNeighbours) {
    // Keys at uneven frames on a line stay on it; its slope is what the tangent rule gives.
    Scalars line = {{0, 0.0, smooth}, {1, 1.0, smooth}, {5, 5.0, smooth}, {7, 7.0, smooth}};
    for (double f : {0.3, 2.2, 6.9}) EXPECT_NEAR(evaluate_scalar(line, f, Ends::through), f, 1e-14);
    // (0, 0) (2, 2) (4, 8): tangent 2 at the middle key; Hermite at frame 1 with one-sided tangent 1 at the
    // start: h01 * 2 + h10 * 2 * 1 + h11 * 2 * 2 at u = 1/2 = 1 + 0.25 - 0.5.
    Scalars bend = {{0, 0.0, smooth}, {2, 2.0, smooth}, {4, 8.0, smooth}};
    EXPECT_NEAR(evaluate_scalar(bend, 1, Ends::through), 0.75, 1e-15);
}

TEST(Scalars, SmoothNeverLeavesTheRangeOfItsTwoKeyframes) {
    Scalars keyframes = {
        {0, 0.0, smooth}, {10, 0.0, smooth}, {20, 10.0, smooth}, {30, 10.0, smooth}, {40, -3.0, smooth}};
    for (int f = 0; f <= 400; ++f) {
        double v = evaluate_scalar(keyframes, f * 0.1, Ends::through);
        auto i = std::min<std::size_t>(std::size_t(f) / 100, 3);
        EXPECT_GE(v, std::fmin(keyframes[i].value, keyframes[i + 1].value));
        EXPECT_LE(v, std::fmax(keyframes[i].value, keyframes[i + 1].value));
    }
}

TEST(Positions, PassThroughTheirKeyframesAtTheirFrames) {
    Positions keyframes = {
        {1, {0, 0, 0}, smooth}, {5, {3, 1, 0}, smooth}, {20, {4, 4, 4}, smooth}, {21, {0, 5, 1}, smooth}};
    for (Ends ends : {Ends::ease, Ends::through})
        for (const auto& keyframe : keyframes)
            expect_at(evaluate_position(keyframes, keyframe.frame, ends, false), keyframe.value, 1e-14);
}

TEST(Positions, CentripetalCurveOfFourKeyframesMatchesBarryAndGoldman) {
    // The pyramid of Barry and Goldman (1988) with knots sqrt(distance), an independent form of
    // the same curve.
    Positions keyframes = {
        {0, {0, 0, 0}, smooth}, {1, {1, 0, 0}, smooth}, {2, {1, 4, 0}, smooth}, {3, {3, 5, 2}, smooth}};
    double t[4] = {0, 0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i)
        t[i + 1] = t[i] + std::sqrt(glm::distance(keyframes[i].value, keyframes[i + 1].value));
    double best = 1e9;
    glm::dvec3 got = evaluate_position(keyframes, 1.5, Ends::through, false);
    for (int k = 0; k <= 100000; ++k) {
        double s = t[1] + (t[2] - t[1]) * k / 100000.0;
        auto mix = [&](const glm::dvec3& a, const glm::dvec3& b, double ta, double tb) {
            return a * ((tb - s) / (tb - ta)) + b * ((s - ta) / (tb - ta));
        };
        glm::dvec3 a1 = mix(keyframes[0].value, keyframes[1].value, t[0], t[1]),
                   a2 = mix(keyframes[1].value, keyframes[2].value, t[1], t[2]),
                   a3 = mix(keyframes[2].value, keyframes[3].value, t[2], t[3]);
        glm::dvec3 b1 = mix(a1, a2, t[0], t[2]), b2 = mix(a2, a3, t[1], t[3]);
        best = std::fmin(best, glm::distance(got, mix(b1, b2, t[1], t[2])));
    }
    EXPECT_LT(best, 1e-4);  // half the sampling step along the curve
}

TEST(Positions, SpeedIsContinuousAtKeyframesOfUnevenFrames) {
    Positions keyframes = {
        {0, {0, 0, 0}, smooth}, {10, {5, 0, 0}, smooth}, {12, {6, 2, 0}, smooth}, {40, {0, 9, 1}, smooth}};
    const double h = 1e-5;
    for (double f : {10.0, 12.0}) {
        auto at = [&](double frame) { return evaluate_position(keyframes, frame, Ends::ease, false); };
        expect_at((at(f) - at(f - h)) / h, (at(f + h) - at(f)) / h, 1e-3);
    }
}

TEST(Positions, EvenKeyframesOnALineMoveEvenly) {
    Positions keyframes = {{0, {0, 0, 0}, smooth}, {10, {1, 2, 3}, smooth}, {20, {2, 4, 6}, smooth}};
    expect_at(evaluate_position(keyframes, 13, Ends::through, false), glm::dvec3(1.3, 2.6, 3.9), 1e-14);
}

TEST(Positions, EaseStartsAndEndsAtRest) {
    Positions keyframes = {{0, {0, 0, 0}, smooth}, {10, {5, 0, 0}, smooth}, {20, {5, 5, 0}, smooth}};
    auto moved = [&](double a, double b) {
        return glm::distance(evaluate_position(keyframes, a, Ends::ease, false),
                             evaluate_position(keyframes, b, Ends::ease, false));
    };
    EXPECT_LT(moved(0, 0.01), 1e-4);
    EXPECT_LT(moved(19.99, 20), 1e-4);
    EXPECT_GT(moved(9.99, 10), 1e-3);
}

// A slow stretch before a fast one: the chord over both is far steeper than the slow stretch may take.
TEST(Positions, NeverRunBackwardsBetweenSlowAndFastStretches) {
    Positions keyframes = {{0, {0, 0, 0}, smooth}, {10, {0.01, 0, 0}, smooth}, {11, {100, 0, 0}, smooth}};
    for (Ends ends : {Ends::ease, Ends::through}) {
        double before = 0.0;
        for (int i = 0; i <= 1100; ++i) {
            const double x = evaluate_position(keyframes, i * 0.01, ends, false).x;
            ASSERT_GE(x, before) << "frame " << i * 0.01;
            before = x;
        }
    }
    Rotations turn = {{0, about_y(0), smooth}, {10, about_y(0.1), smooth}, {11, about_y(120), smooth}};
    for (int i = 0; i <= 1000; ++i)
        ASSERT_GE(degrees_about_y(evaluate_rotation(turn, i * 0.01, Ends::through)), -1e-9) << i * 0.01;
}

TEST(Positions, CoincidentKeyframesRest) {
    Positions keyframes = {
        {0, {0, 0, 0}, smooth}, {10, {1, 1, 0}, smooth}, {20, {1, 1, 0}, smooth}, {30, {4, 0, 0}, smooth}};
    for (bool constant_speed : {false, true})
        for (int f = 0; f <= 30; ++f) {
            glm::dvec3 p = evaluate_position(keyframes, f, Ends::ease, constant_speed);
            EXPECT_TRUE(std::isfinite(p.x + p.y + p.z)) << f;
        }
    expect_at(evaluate_position(keyframes, 15, Ends::ease, false), glm::dvec3(1, 1, 0), 0.0);
    Positions still = {{0, {2, 2, 2}, smooth}, {10, {2, 2, 2}, smooth}};
    expect_at(evaluate_position(still, 5, Ends::ease, true), glm::dvec3(2, 2, 2), 0.0);
}

TEST(Positions, ConstantSpeedCoversEqualLengthsInEqualTimes) {
    Positions keyframes = {
        {0, {0, 0, 0}, smooth}, {3, {10, 0, 0}, smooth}, {50, {11, 1, 0}, smooth}, {60, {0, 8, 5}, smooth}};
    auto at = [&](double f) { return evaluate_position(keyframes, f, Ends::through, true); };
    double first = glm::distance(at(0), at(0.01));
    for (double f : {2.0, 14.0, 37.7, 59.9})
        EXPECT_NEAR(glm::distance(at(f), at(f + 0.01)), first, 1e-5 * first) << f;
    expect_at(at(60), keyframes.back().value, 0.0);
    expect_at(at(60 - 1e-9), keyframes.back().value, 1e-8);
}

TEST(Positions, ConstantSpeedOnALineIsLinear) {
    Positions keyframes = {{0, {0, 0, 0}, linear}, {1, {1, 0, 0}, linear}, {10, {10, 0, 0}, linear}};
    expect_at(evaluate_position(keyframes, 2.5, Ends::ease, true), glm::dvec3(2.5, 0, 0), 1e-12);
}

TEST(Positions, ConstantSpeedEasesOverATenthAtEachEnd) {
    Positions keyframes = {{0, {0, 0, 0}, smooth}, {100, {90, 0, 0}, smooth}};
    auto x = [&](double f) { return evaluate_position(keyframes, f, Ends::ease, true).x; };
    EXPECT_NEAR(x(10), 5.0, 1e-9);   // half the pace over the ramp
    EXPECT_NEAR(x(50), 45.0, 1e-9);  // then 1 per frame
    EXPECT_NEAR(x(60) - x(50), 10.0, 1e-9);
    EXPECT_NEAR(x(90), 85.0, 1e-9);
    EXPECT_LT(x(0.01), 1e-6);
    EXPECT_NEAR(90.0 - x(95), x(5), 1e-9);  // the end mirrors the start
    EXPECT_LT(90.0 - x(99.99), 1e-6);
}

TEST(Rotations, LinearTurnsEvenlyTheShorterWay) {
    Rotations keyframes = {{0, about_y(0), linear},
                           {10, -about_y(90), linear}};  // q and -q are the same rotation
    EXPECT_NEAR(degrees_about_y(evaluate_rotation(keyframes, 3, Ends::ease)), 27.0, 1e-12);
    Rotations far = {{0, about_y(170), linear}, {10, about_y(190), linear}};
    EXPECT_NEAR(std::fabs(degrees_about_y(evaluate_rotation(far, 5, Ends::ease))), 180.0, 1e-12);
}

TEST(Rotations, StepHolds) {
    Rotations keyframes = {{0, about_y(10), step}, {10, about_y(90), linear}};
    EXPECT_NEAR(degrees_about_y(evaluate_rotation(keyframes, 9.9, Ends::ease)), 10.0, 1e-12);
    EXPECT_NEAR(degrees_about_y(evaluate_rotation(keyframes, 10.0, Ends::ease)), 90.0, 1e-12);
}

TEST(Rotations, SmoothEasesAndKeepsItsSpeedAtKeyframes) {
    Rotations keyframes = {{0, about_y(0), smooth}, {10, about_y(30), smooth}, {40, about_y(60), smooth}};
    auto at = [&](double f) { return degrees_about_y(evaluate_rotation(keyframes, f, Ends::ease)); };
    EXPECT_LT(at(0.01), 1e-3);
    EXPECT_NEAR(at(10), 30.0, 1e-12);
    EXPECT_NEAR((at(10.0) - at(9.999)) / 0.001, (at(10.001) - at(10.0)) / 0.001, 1e-2);
    Rotations two = {{0, about_y(0), smooth}, {10, about_y(90), smooth}};
    EXPECT_NEAR(degrees_about_y(evaluate_rotation(two, 2.5, Ends::ease)), 90.0 * 0.15625, 1e-12);
}

TEST(Rotations, EqualAndUnnormalisedKeyframesAreSafe) {
    Rotations keyframes = {{0, about_y(30) * 2.0, smooth}, {10, about_y(30), smooth}};
    glm::dvec4 q = evaluate_rotation(keyframes, 4, Ends::ease);
    EXPECT_NEAR(glm::length(q), 1.0, 1e-15);
    EXPECT_NEAR(degrees_about_y(q), 30.0, 1e-12);
    EXPECT_NEAR(glm::length(evaluate_rotation(keyframes, -4, Ends::ease)), 1.0, 1e-15);
}

// Bezier keyframes against curves worked out by hand: handles, automatic, flat and free,
// of scalars and positions.

constexpr Interpolation bezier = Interpolation::bezier;
constexpr HandleKind flat = HandleKind::flat, free_hand = HandleKind::free;

double scalar_at(const Scalars& keyframes, double frame, Ends ends = Ends::ease) {
    return evaluate_scalar(keyframes, frame, ends);
}

TEST(BezierScalars, FlatHandlesAreSmoothstep) {
    const Scalars keyframes = {{0, 1.0, bezier, {}, {flat}}, {10, 3.0, bezier, {flat}}};
    for (const double u : {0.0, 0.1, 0.25, 0.5, 0.9, 1.0})
        EXPECT_NEAR(scalar_at(keyframes, 10 * u), 1.0 + 2.0 * u * u * (3 - 2 * u), 1e-14) << u;
}

/// With the handles on the line between the keyframes, at whatever frames, the way is that line.
TEST(BezierScalars, HandlesOnALineAreALine) {
    const Scalars keyframes = {{0, 0.0, bezier, {}, {free_hand, 8.0, 4.0}},
                               {10, 5.0, bezier, {free_hand, -1.0, -0.5}}};
    for (double frame = 0.0; frame <= 10.0; frame += 0.5)
        EXPECT_NEAR(scalar_at(keyframes, frame), 0.5 * frame, 1e-12) << frame;
}

/// Both handles reach half the segment: at u, frame = 10 (3/2 u (1-u) + u^3 ...) and value = 3 u^2 - 2 u^3.
TEST(BezierScalars, FramesOfHandlesTimeTheCurve) {
    const Scalars keyframes = {{0, 0.0, bezier, {}, {free_hand, 5.0, 0.0}},
                               {10, 1.0, bezier, {free_hand, -5.0, 0.0}}};
    for (const double u : {0.1, 0.3, 0.5, 0.8}) {
        const double v = 1.0 - u;
        const double frame = 10.0 * (3 * v * v * u * 0.5 + 3 * v * u * u * 0.5 + u * u * u);
        EXPECT_NEAR(scalar_at(keyframes, frame), u * u * (3 - 2 * u), 1e-12) << u;
    }
}

TEST(BezierScalars, AutomaticHandlesPointAlongTheNeighboursAndNeverOvershoot) {
    const Scalars line = {{0, 0.0, bezier}, {3, 3.0, bezier}, {10, 10.0, bezier}};
    for (const double frame : {0.5, 2.0, 4.0, 9.0})
        EXPECT_NEAR(scalar_at(line, frame, Ends::through), frame, 1e-12);
    const Scalars steps = {{0, 0.0, bezier}, {10, 0.0, bezier}, {11, 5.0, bezier}, {20, 4.0, bezier}};
    for (double frame = 0.0; frame <= 20.0; frame += 0.05) {
        EXPECT_GE(scalar_at(steps, frame), -1e-12) << frame;
        EXPECT_LE(scalar_at(steps, frame), 5.0 + 1e-12) << frame;
    }
    EXPECT_NEAR(scalar_at(steps, 5.0), 0.0, 1e-12);
}

TEST(BezierScalars, EndsRestOrGoThrough) {
    const Scalars keyframes = {{0, 0.0, bezier}, {10, 1.0, bezier}};
    EXPECT_NEAR(scalar_at(keyframes, 1.0, Ends::ease), 0.01 * 2.8, 1e-12);
    EXPECT_NEAR(scalar_at(keyframes, 1.0, Ends::through), 0.1, 1e-12);
}

/// A handle beyond the next keyframe is shortened to it, in its direction: time never runs backwards.
TEST(BezierScalars, LongHandlesAreShortenedToTheirSegment) {
    const Scalars longer = {{0, 0.0, bezier, {}, {free_hand, 40.0, 8.0}}, {10, 1.0, bezier, {flat}}};
    const Scalars fits = {{0, 0.0, bezier, {}, {free_hand, 10.0, 2.0}}, {10, 1.0, bezier, {flat}}};
    for (double frame = 0.0; frame <= 10.0; frame += 0.25)
        EXPECT_EQ(scalar_at(longer, frame), scalar_at(fits, frame)) << frame;
    EXPECT_EQ(handle_after(std::span(longer), 0, Ends::ease).frames, 10.0);
    EXPECT_EQ(handle_after(std::span(longer), 0, Ends::ease).value, 2.0);
}

TEST(BezierScalars, OnlyTheirOwnSegmentHeedsTheHandles) {
    const Scalars keyframes = {{0, 0.0, Interpolation::linear, {}, {free_hand, 5.0, 9.0}},
                               {10, 1.0, bezier, {free_hand, -5.0, 9.0}, {flat}},
                               {20, 0.0, bezier, {flat}}};
    EXPECT_EQ(scalar_at(keyframes, 5.0), 0.5);
    EXPECT_NEAR(scalar_at(keyframes, 15.0), 0.5, 1e-14);
}

/// A quarter of a circle with handles of 4/3 tan(90 deg / 4) keeps its radius within 0.03 %.
TEST(BezierPositions, AQuarterCircleIsRound) {
    const double h = 4.0 / 3.0 * real::tan(real::pi / 8.0);
    const Positions keyframes = {{0, {1, 0, 0}, bezier, {}, {free_hand, 10.0 / 3.0, {0, 0, h}}},
                                 {10, {0, 0, 1}, bezier, {free_hand, -10.0 / 3.0, {h, 0, 0}}}};
    for (double frame = 0.0; frame <= 10.0; frame += 0.125) {
        const glm::dvec3 p = evaluate_position(keyframes, frame, Ends::ease, false);
        EXPECT_NEAR(glm::length(p), 1.0, 3e-4) << frame;
        EXPECT_EQ(p.y, 0.0);
    }
    const glm::dvec3 middle = evaluate_position(keyframes, 5.0, Ends::ease, false);
    EXPECT_NEAR(glm::distance(middle, glm::dvec3(std::sqrt(0.5), 0.0, std::sqrt(0.5))), 0.0, 1e-12);
}

/// A path does not depend on the axes that describe it: automatic handles turn with it.
TEST(BezierPositions, AutomaticHandlesTurnWithThePath) {
    const std::vector<glm::dvec3> points = {{0, 0, 0}, {3, 1, 0}, {4, 5, 2}, {1, 5, 3}};
    const auto turned = [](const glm::dvec3& p) {
        return glm::dvec3(0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y, p.z);
    };
    Positions before, after;
    for (std::size_t i = 0; i < points.size(); ++i) {
        before.push_back({10.0 * double(i), points[i], bezier});
        after.push_back({10.0 * double(i), turned(points[i]), bezier});
    }
    for (double frame = 0.0; frame <= 30.0; frame += 0.7)
        EXPECT_NEAR(glm::distance(turned(evaluate_position(before, frame, Ends::ease, false)),
                                  evaluate_position(after, frame, Ends::ease, false)),
                    0.0, 1e-12);
}

TEST(BezierPositions, ConstantSpeedRunsAlongTheSameCurve) {
    const Positions keyframes = {{0, {0, 0, 0}, bezier, {}, {free_hand, 2.0, {0, 4, 0}}},
                                 {20, {4, 0, 0}, bezier, {free_hand, -9.0, {0, 4, 0}}}};
    const auto at = [&](double frame) { return evaluate_position(keyframes, frame, Ends::through, true); };
    // Between the samples the speed is even; by symmetry half of the way is at its top, 3/4 of 4 up.
    EXPECT_NEAR(glm::distance(at(10.0), glm::dvec3(2.0, 3.0, 0.0)), 0.0, 1e-9);
    const double first = glm::distance(at(1.0), at(1.01));
    for (const double frame : {3.0, 7.0, 13.0, 19.0})
        EXPECT_NEAR(glm::distance(at(frame), at(frame + 0.01)), first, 1e-5) << frame;
}

}  // namespace
}  // namespace astrosplat
