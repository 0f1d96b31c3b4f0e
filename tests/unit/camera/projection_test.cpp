// The table of projections and its functions in GLSL, and stereo pairs against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "camera/camera.h"
#include "camera/projection.h"
#include "core/error.h"
#include "core/real.h"

namespace astrosplat {
namespace {

// The table of projections: each has lines of its own in every function of shaders/shared/projection.glsl
// that needs them, and the functions agree about where a point appears. A new projection is tested as soon as
// it has a name.

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

// Stereo pairs against closed forms: how far apart both eyes see a point, where they see the same, and that
// nothing is lost at the poles or culled that one of them sees.

constexpr double width_px = 1000.0, height_px = 500.0, separation = 0.4;

CameraParams params_of(Projection projection, Eye eye, double convergence = 0.0) {
    CameraParams params;
    params.projection = projection;
    params.position = {1.0, 2.0, 3.0};
    params.target = {1.0, 2.0, -5.0};
    params.eye = eye;
    params.eye_separation = separation;
    params.convergence = convergence;
    return params;
}

/// Where an eye sees a point that lies at `offset` from the middle between the eyes, px.
glm::dvec2 seen(const CameraParams& params, const glm::dvec3& offset) {
    const Camera camera = make_camera(params, width_px, height_px, {});
    const glm::dvec3 p = glm::transpose(camera.world_from_camera) * (*params.position + offset - camera.eye);
    const exact::Instance at = exact::instance_of(make_exact_lens(camera), p);
    return {at.x_px, at.y_px};
}

glm::dvec2 disparity(Projection projection, const glm::dvec3& offset, double convergence = 0.0) {
    return seen(params_of(projection, Eye::left, convergence), offset) -
           seen(params_of(projection, Eye::right, convergence), offset);
}

TEST(Stereo, FlatPairsAreShiftedAsOneOverTheDepth) {
    const double focal_px = 0.5 * height_px / real::tan(real::radians(22.5));
    for (const double depth : {0.5, 2.0, 8.0, 1000.0})
        for (const double convergence : {0.0, 3.0}) {
            const double meeting = convergence > 0.0 ? convergence : 8.0;
            const glm::dvec2 found =
                disparity(Projection::perspective, {0.3 * depth, -0.1 * depth, -depth}, convergence);
            EXPECT_NEAR(found.x, focal_px * separation * (1.0 / depth - 1.0 / meeting), 1e-9) << depth;
            EXPECT_NEAR(found.y, 0.0, 1e-9);
        }
}

TEST(Stereo, PanoramasAreTurnedByTheDistanceAlone) {
    for (const Projection projection : {Projection::equirectangular, Projection::cylindrical})
        for (const double latitude : {-80.0, 0.0, 45.0})
            for (const double distance : {0.3, 2.0, 8.0, 1e6}) {
                const double b = real::radians(latitude), l = real::radians(70.0);
                const glm::dvec3 offset =
                    distance * glm::dvec3(std::cos(b) * std::sin(l), std::sin(b), -std::cos(b) * std::cos(l));
                const double angle =
                    2.0 * (std::asin(0.5 * separation / distance) - std::asin(0.5 * separation / 8.0));
                const glm::dvec2 found = disparity(projection, offset);
                EXPECT_NEAR(found.x, angle * width_px / (2.0 * real::pi), 1e-6)
                    << latitude << " " << distance;
                EXPECT_NEAR(found.y, 0.0, 1e-9);
            }
}

TEST(Stereo, WhatIsNearerThanTheEyesIsTurnedAQuarter) {
    const double quarters =
        disparity(Projection::equirectangular, {0.0, 0.0, -0.1}, 1e12).x / (width_px / 4.0);
    EXPECT_NEAR(quarters, 2.0, 1e-6);
}

TEST(Stereo, TheMiddleIsBetweenTheEyesAndOtherLensesHaveOne) {
    const glm::dvec3 offset(0.7, 0.2, -5.0);
    for (const Projection projection : {Projection::perspective, Projection::equirectangular}) {
        const glm::dvec2 middle = seen(params_of(projection, Eye::centre), offset);
        const glm::dvec2 mean = 0.5 * (seen(params_of(projection, Eye::left), offset) +
                                       seen(params_of(projection, Eye::right), offset));
        EXPECT_NEAR(middle.x, mean.x, 1e-9);
    }
    for (const Projection projection : {Projection::fisheye, Projection::orthographic})
        EXPECT_EQ(disparity(projection, offset), glm::dvec2(0.0));
}

TEST(Stereo, PointsAreFoundAgainAtTheirDepth) {
    const Camera camera =
        make_camera(params_of(Projection::equirectangular, Eye::left), width_px, height_px, {});
    const glm::dvec3 p(0.4, 0.3, -0.8);
    const ExactLens lens = make_exact_lens(camera);
    const exact::Instance at = exact::instance_of(lens, p);
    EXPECT_LT(glm::length(exact::point_at_depth(lens, at.x_px, at.y_px, at.depth) - p), 1e-12);
}

// A ball that is culled by its reach is nowhere on the frame.
TEST(Stereo, TheReachOfABallHoldsAllOfIt) {
    const Lens lens =
        make_lens(make_camera(params_of(Projection::equirectangular, Eye::left), width_px, height_px, {}));
    const glm::vec3 middle(0.2f, 0.5f, -0.9f);
    const shared::Instance at = shared::instance_of(lens, middle);
    for (const float radius : {0.1f, 0.4f, 0.8f}) {
        const float reach = shared::reach_px(lens, middle, radius, 0.0f);
        for (int i = 0; i < 400; ++i) {
            const float z = 1.0f - 2.0f * (float(i) + 0.5f) / 400.0f, turn = 2.4f * float(i);
            const glm::vec3 away(std::sqrt(1.0f - z * z) * std::cos(turn),
                                 std::sqrt(1.0f - z * z) * std::sin(turn), z);
            const shared::Instance edge = shared::instance_of(lens, middle + radius * away);
            const float period = shared::period_px(lens);
            const float x = std::remainder(edge.x_px - at.x_px, period);
            EXPECT_LE(std::fabs(x), reach) << radius;
            EXPECT_LE(std::fabs(edge.y_px - at.y_px), reach) << radius;
        }
    }
}

TEST(Stereo, WrongNumbersAreTold) {
    CameraParams params = params_of(Projection::perspective, Eye::left);
    params.eye_separation = -1.0;
    EXPECT_THROW(make_camera(params, width_px, height_px, {}), InputError);
    params = params_of(Projection::perspective, Eye::left, -2.0);
    EXPECT_THROW(make_camera(params, width_px, height_px, {}), InputError);
}

}  // namespace
}  // namespace astrosplat
