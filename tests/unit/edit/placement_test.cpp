// Where layers are in the world and back, angles of rotations, boxes, grid and axes.
#include "edit/placement.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "core/real.h"
#include "core/rotation.h"

namespace astrosplat {
namespace {

constexpr double small = 1e-9;

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_LT(glm::length(a - b), small)
        << a.x << " " << a.y << " " << a.z << " / " << b.x << " " << b.y << " " << b.z;
}

double difference(const glm::dmat3& a, const glm::dmat3& b) {
    double most = 0.0;
    for (int i = 0; i < 3; ++i) most = std::max(most, glm::length(a[i] - b[i]));
    return most;
}

TEST(Placement, ScalesThenTurnsThenMoves) {
    const LayerPlacement placement = placement_of({{10.0, 0.0, 0.0}, {0.0, 0.0, 90.0}, 2.0});
    expect_near(to_world(placement, {1.0, 0.0, 3.0}), {10.0, 2.0, 6.0});
    expect_near(to_layer(placement, {10.0, 2.0, 6.0}), {1.0, 0.0, 3.0});
}

TEST(Placement, AnglesSayTheirRotation) {
    for (const glm::dvec3 degrees : {glm::dvec3(10, 20, 30), glm::dvec3(-170, 80, 5), glm::dvec3(0, 0, 179)})
        expect_near(degrees_of(rotation_from_degrees(degrees), degrees), degrees);
}

/// The other triple of angles that says the same, whole turns, and a pole, where two angles turn about one
/// line.
TEST(Placement, OfAllAnglesTheNearestOnesAreTaken) {
    for (const glm::dvec3 degrees : {glm::dvec3(190, 160, 210), glm::dvec3(730, 20, -350),
                                     glm::dvec3(40, 90, 25), glm::dvec3(40, -90, 25)}) {
        const glm::dmat3 rotation = rotation_from_degrees(degrees);
        const glm::dvec3 found = degrees_of(rotation, degrees + glm::dvec3(0.1, -0.1, 0.1));
        EXPECT_LT(difference(rotation_from_degrees(found), rotation), 1e-7);
        EXPECT_LT(glm::length(found - degrees), 1.0);
    }
}

/// At a pole x and z turn about one line: x stays as it was.
TEST(Placement, AtAPoleTheAnglesStay) {
    const glm::dmat3 turned(0.0, 0.0, -1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0);  // by 90 degrees about y
    expect_near(degrees_of(turned, {40.0, 90.0, 40.0}), {40.0, 90.0, 40.0});
    expect_near(degrees_of(turned, {0.0, 90.0, 0.0}), {0.0, 90.0, 0.0});
}

TEST(Placement, RotationsFollowTheRightHand) {
    expect_near(rotation_about({0.0, 0.0, 1.0}, real::radians(90.0)) * glm::dvec3(1.0, 0.0, 0.0),
                {0.0, 1.0, 0.0});
    EXPECT_LT(
        difference(rotation_about({0.0, 1.0, 0.0}, real::radians(25.0)), rotation_from_degrees({0, 25, 0})),
        small);
}

TEST(SceneMarks, ABoxHasTwelveEdgesPlacedAsItsLayer) {
    const Bounds box{{0.0, 0.0, 0.0}, {1.0, 2.0, 3.0}};
    const std::vector<MarkLine> edges = box_edges(box, {{5.0, 0.0, 0.0}, {0.0, 0.0, 90.0}, 2.0});
    ASSERT_EQ(edges.size(), 12u);
    double length = 0.0;
    for (const MarkLine& edge : edges) length += glm::length(edge.to - edge.from);
    EXPECT_NEAR(length, 2.0 * 4.0 * (1.0 + 2.0 + 3.0), small);
    expect_near(edges[0].from, {5.0, 0.0, 0.0});
    expect_near(edges[0].to, {5.0, 2.0, 0.0});
    EXPECT_TRUE(box_edges({}, {}).empty());
}

TEST(SceneMarks, TheGridHasRoundStepsAndHoldsTheBox) {
    const Bounds box{{-4.0, -1.0, -3.0}, {6.0, 1.0, 5.0}};
    const Grid grid = grid_around(box, ViewKind::free);
    EXPECT_EQ(grid.spacing, 1.0);
    Bounds held;
    for (const MarkLine& line : grid.lines) {
        EXPECT_EQ(line.from.y, 0.0);
        EXPECT_EQ(line.to.y, 0.0);
        held.add(line.from);
        held.add(line.to);
    }
    EXPECT_TRUE(held.lo.x <= box.lo.x && held.hi.x >= box.hi.x && held.lo.z <= box.lo.z &&
                held.hi.z >= box.hi.z);
    EXPECT_EQ(grid_around({{0.0, 0.0, 0.0}, {0.02, 0.0, 0.0}}, ViewKind::free).spacing, 0.002);
    EXPECT_EQ(grid_around({{0.0, 0.0, 0.0}, {45.0, 1.0, 0.0}}, ViewKind::free).spacing, 5.0);
}

TEST(SceneMarks, TheGridFacesTheView) {
    const Bounds box{{-4.0, 2.0, -3.0}, {6.0, 4.0, 5.0}};
    const auto flat_in = [&](ViewKind view, int axis, double place) {
        for (const MarkLine& line : grid_around(box, view).lines)
            if (line.from[axis] != place || line.to[axis] != place) return false;
        return true;
    };
    EXPECT_TRUE(flat_in(ViewKind::front, 2, 0.0));
    EXPECT_TRUE(flat_in(ViewKind::side, 0, 0.0));
    EXPECT_TRUE(flat_in(ViewKind::top, 1, 2.0)) << "the side of the box that is nearest to the origin";
}

TEST(SceneMarks, AxesBeginAtTheOrigin) {
    const auto axes = axis_lines({{-4.0, -1.0, -3.0}, {6.0, 1.0, 5.0}});
    expect_near(axes[0].from, {0.0, 0.0, 0.0});
    expect_near(axes[0].to, {5.0, 0.0, 0.0});
    expect_near(axes[1].to, {0.0, 5.0, 0.0});
    expect_near(axes[2].to, {0.0, 0.0, 5.0});
}

}  // namespace
}  // namespace astrosplat
