// The table of projections: each has lines of its own in every function of shaders/shared/projection.glsl
// that needs them, and the functions agree about where a point appears. A new projection is tested as soon as
// it has a name.
#include "camera/projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "camera/camera.h"

namespace astrosplat {
namespace {

constexpr int projection_count = int(names_of(Projection{}).size());

CameraParams params_of(int projection) {
    CameraParams params;
    params.projection = Projection(projection);
    params.position = glm::dvec3(0.0);
    params.target = {0.0, 0.0, -1.0};
    return params;
}

ExactLens lens_of(int projection) {
    return make_exact_lens(make_camera(params_of(projection), 640, 480, {}));
}

std::string name(int projection) { return std::string(name_of(Projection(projection))); }

const glm::dvec2 places[] = {{320.0, 240.0}, {250.25, 300.0}, {401.0, 128.5}, {330.0, 90.0}};

TEST(Projections, PointsAppearWhereTheyArePut) {
    for (int k = 0; k < projection_count; ++k) {
        const ExactLens lens = lens_of(k);
        for (const glm::dvec2& place : places)
            for (const double depth : {0.3, 7.0}) {
                EXPECT_TRUE(exact::shows(lens, place.x, place.y)) << name(k);
                const glm::dvec3 p = exact::point_at_depth(lens, place.x, place.y, depth);
                const exact::Instance at = exact::instance_of(lens, p);
                EXPECT_NEAR(at.x_px, place.x, 1e-9) << name(k);
                EXPECT_NEAR(at.y_px, place.y, 1e-9) << name(k);
                EXPECT_NEAR(at.depth, depth, 1e-12) << name(k);
                EXPECT_NEAR(exact::axis_depth(lens, at.x_px, at.y_px, exact::sort_depth(lens, p)), depth,
                            1e-9)
                    << name(k);
            }
    }
}

TEST(Projections, RaysLeadToWhatAppears) {
    for (int k = 0; k < projection_count; ++k) {
        const ExactLens lens = lens_of(k);
        if (exact::has_parallel_rays(lens)) continue;
        for (const glm::dvec2& place : places) {
            const exact::Instance at = exact::instance_of(lens, exact::ray_through(lens, place.x, place.y));
            EXPECT_NEAR(at.x_px, place.x, 1e-9) << name(k);
            EXPECT_NEAR(at.y_px, place.y, 1e-9) << name(k);
        }
    }
}

/// A ball's outline is no wider than px_per_unit says in the middle, onto the sphere: the chord.
TEST(Projections, WhatIsNearAppearsWithinReach) {
    for (int k = 0; k < projection_count; ++k) {
        const ExactLens lens = lens_of(k);
        for (const glm::dvec2& place : places) {
            constexpr double distance = 5.0, radius = 0.4;
            const glm::dvec3 p = exact::point_at_depth(lens, place.x, place.y, distance);
            const exact::Instance at = exact::instance_of(lens, p);
            const double reach = exact::reach_px(lens, p, radius, 0.0);
            double farthest = 0.0;
            for (int i = 0; i < 1000; ++i) {
                const double z = 1.0 - (2.0 * i + 1.0) / 1000.0, turn = 2.399963 * i,
                             across = std::sqrt(1.0 - z * z);
                const glm::dvec3 on_ball(across * std::cos(turn), across * std::sin(turn), z);
                const exact::Instance other = exact::instance_of(lens, p + radius * on_ball);
                farthest =
                    std::max({farthest, std::fabs(other.x_px - at.x_px), std::fabs(other.y_px - at.y_px)});
            }
            EXPECT_LE(farthest, reach) << name(k);
            EXPECT_GT(farthest, 0.4 * reach) << name(k);
        }
    }
}

/// One that was forgotten in the table is drawn as another.
TEST(Projections, NoTwoShowAPointAtOnePlace) {
    const glm::dvec3 p(1.1, 0.7, -2.0);
    for (int a = 0; a < projection_count; ++a)
        for (int b = 0; b < a; ++b) {
            ExactLens lens = lens_of(a);
            const exact::Instance first = exact::instance_of(lens, p);
            const glm::dvec3 first_ray = exact::ray_through(lens, 400.0, 100.0);
            lens.projection = b;
            const exact::Instance second = exact::instance_of(lens, p);
            const glm::dvec3 second_ray = exact::ray_through(lens, 400.0, 100.0);
            EXPECT_GT(std::hypot(first.x_px - second.x_px, first.y_px - second.y_px), 1e-3)
                << name(a) << " is drawn as " << name(b);
            EXPECT_GT(glm::length(glm::normalize(first_ray) - glm::normalize(second_ray)), 1e-5)
                << name(a) << " has the rays of " << name(b);
        }
}

}  // namespace
}  // namespace astrosplat
