// Bezier keyframes against curves worked out by hand: handles, automatic, flat and free, of scalars and
// positions.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "camera/keyframe.h"
#include "core/real.h"

namespace astrosplat {
namespace {

constexpr Interpolation bezier = Interpolation::bezier;
constexpr HandleKind flat = HandleKind::flat, free_hand = HandleKind::free;
using Scalars = std::vector<Keyframe<double>>;
using Positions = std::vector<Keyframe<glm::dvec3>>;

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
        before.push_back({10.0 * static_cast<double>(i), points[i], bezier});
        after.push_back({10.0 * static_cast<double>(i), turned(points[i]), bezier});
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
