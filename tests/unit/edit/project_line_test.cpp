// Where points and lines of the world lie in a frame, and back: closed forms of a camera along -z.
#include "edit/placement.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace astrosplat {
namespace {

constexpr double width = 400.0, height = 200.0;  // px

/// At z = 10, seeing 4 scene units of height at the origin.
Camera camera_of(Projection projection) {
    CameraParams params;
    params.projection = projection;
    params.position = glm::dvec3(0.0, 0.0, 10.0);
    params.fov = 22.619864948040426;  // 2 atan(2 / 10)
    params.height = 4.0;
    return make_camera(params, width, height, {});
}

constexpr Projection projections[] = {Projection::perspective, Projection::orthographic};

TEST(ProjectPoint, APlaneOfFourUnitsFillsTheFramesHeight) {
    for (const Projection projection : projections) {
        const Camera camera = camera_of(projection);
        const auto at = project_point(camera, {1.0, 2.0, 0.0});
        ASSERT_TRUE(at);
        EXPECT_NEAR(at->x, 250.0f, 1e-4f);
        EXPECT_NEAR(at->y, 0.0f, 1e-4f);
        EXPECT_NEAR(units_per_px(camera, {1.0, 2.0, 0.0}), 4.0 / height, 1e-12);
        EXPECT_NEAR(view_depth(camera, {1.0, 2.0, 3.0}), 7.0, 1e-12);
    }
}

TEST(ProjectPoint, TheRayThroughItMeetsThePoint) {
    for (const Projection projection : projections) {
        const Camera camera = camera_of(projection);
        const glm::dvec3 point(1.5, -0.7, 3.0);
        const ViewRay ray = ray_through(camera, glm::dvec2(*project_point(camera, point)));
        EXPECT_NEAR(glm::length(ray.direction), 1.0, 1e-12);
        EXPECT_LT(glm::length(glm::cross(point - ray.origin, ray.direction)), 1e-5);
    }
}

TEST(ProjectPoint, OnScreenItIsScaledAndMoved) {
    for (const Projection projection : projections) {
        const Camera camera = camera_of(projection);
        const Camera shown = camera_on_screen(camera, {30.0, 40.0}, 0.5);
        const auto at = project_point(shown, {1.0, 2.0, 0.0});
        ASSERT_TRUE(at);
        EXPECT_NEAR(at->x, 30.0f + 125.0f, 1e-4f);
        EXPECT_NEAR(at->y, 40.0f, 1e-4f);
    }
}

TEST(ProjectLine, BehindTheEyeItIsCut) {
    const Camera camera = camera_of(Projection::perspective);
    EXPECT_FALSE(project_point(camera, {0.0, 0.0, 11.0}));
    const auto parts = project_line(camera, {{-1.0, 0.0, 0.0}, {0.0, 0.0, 20.0}, {1.0, 0.0, 0.0}});
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].size(), 2u);
    EXPECT_NEAR(parts[0][0].x, 150.0f, 1e-4f);
    EXPECT_NEAR(parts[1][1].x, 250.0f, 1e-4f);
}

TEST(ProjectLine, ParallelRaysSeeAlsoWhatLiesBehindTheirPlane) {
    const Camera camera = camera_of(Projection::orthographic);
    const auto parts = project_line(camera, {{-1.0, 0.0, 0.0}, {0.0, 0.0, 20.0}, {1.0, 0.0, 0.0}});
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].size(), 3u);
}

}  // namespace
}  // namespace astrosplat
