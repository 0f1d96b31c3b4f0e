// The camera and the table of projections.
#include "camera/camera.h"

#include <glm/matrix.hpp>

#include "camera/framing.h"
#include "camera/projection.h"
#include "core/rotation.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// The camera against geometry worked out by hand.

constexpr double tiny = 1e-14;

void expect_near(const glm::dvec3& got, const glm::dvec3& expected, double tolerance = tiny) {
    EXPECT_NEAR(got.x, expected.x, tolerance);
    EXPECT_NEAR(got.y, expected.y, tolerance);
    EXPECT_NEAR(got.z, expected.z, tolerance);
}

CameraParams at(const glm::dvec3& position) {
    CameraParams params;
    params.position = position;
    return params;
}

Camera made(const CameraParams& params) { return make_camera(params, 1920, 1080, {}); }

// Where a point appears, by the definition: x right, y up, looking along -z.
glm::dvec3 project(const Camera& camera, const glm::dvec3& point) {
    glm::dvec3 c = glm::transpose(camera.world_from_camera) * (point - camera.eye);
    double scale = camera.projection == Projection::orthographic ? camera.focal_px : camera.focal_px / -c.z;
    return {camera.center_x_px + c.x * scale, camera.center_y_px - c.y * scale, -c.z};
}

std::string error_of(const CameraParams& params) { return ERROR_OF(made(params)); }

TEST(Camera, LooksAlongMinusZByDefault) {
    Camera camera = made(at({0, 0, 10}));
    expect_near(camera.world_from_camera[0], {1, 0, 0});
    expect_near(camera.world_from_camera[1], {0, 1, 0});
    expect_near(camera.world_from_camera[2], {0, 0, 1});
}

TEST(Camera, PictureHasPlusXRightAndPlusYUp) {
    Camera camera = made(at({0, 0, 10}));
    EXPECT_GT(project(camera, {1, 0, 0}).x, 960.0);
    EXPECT_LT(project(camera, {0, 1, 0}).y, 540.0);
    EXPECT_DOUBLE_EQ(project(camera, {0, 0, 0}).z, 10.0);
}

TEST(Camera, VerticalFieldOfViewSpansTheHeight) {
    CameraParams params = at({0, 0, 1});
    params.fov = 90.0;
    Camera camera = made(params);
    EXPECT_NEAR(camera.focal_px, 540.0, 1e-9);
    EXPECT_NEAR(project(camera, {0, 1, 0}).y, 0.0, 1e-9);
}

TEST(Camera, FilmWidthSpansTheWidth) {
    CameraParams params = at({0, 0, 1});
    params.focal_length = 18.0;  // half the film's width: 45 degrees to each side
    Camera camera = made(params);
    EXPECT_NEAR(camera.focal_px, 960.0, 1e-9);
}

TEST(Camera, OrthographicHeightSpansTheHeight) {
    CameraParams params = at({0, 0, 10});
    params.projection = Projection::orthographic;
    params.height = 4.0;
    Camera camera = made(params);
    EXPECT_DOUBLE_EQ(camera.focal_px, 270.0);
    EXPECT_DOUBLE_EQ(project(camera, {0, 2, -7}).y, 0.0);
    EXPECT_DOUBLE_EQ(project(camera, {0, -2, 3}).y, 1080.0);
}

TEST(Camera, PositiveRollTurnsThePictureAnticlockwise) {
    CameraParams params = at({0, 0, 10});
    params.roll = 90.0;
    Camera camera = made(params);
    EXPECT_LT(project(camera, {1, 0, 0}).y, 540.0 - 1.0);  // what was on the right is on top
    EXPECT_LT(project(camera, {0, 1, 0}).x, 960.0 - 1.0);  // what was on top is on the left
}

TEST(Camera, AxesStayRightHandedAndOrthonormal) {
    CameraParams params = at({3, -2, 7});
    params.target = {-1, 4, 0.5};
    params.roll = 33.0;
    glm::dmat3 m = made(params).world_from_camera;
    EXPECT_NEAR(glm::determinant(m), 1.0, tiny);
    EXPECT_NEAR(glm::dot(m[0], m[1]), 0.0, tiny);
    EXPECT_NEAR(glm::length(m[0]), 1.0, tiny);
    expect_near(-m[2], glm::normalize(params.target - *params.position));
}

TEST(Camera, LookingStraightDownHasMinusZUp) {
    Camera camera = made(at({0, 10, 0}));
    expect_near(camera.world_from_camera[1], {0, 0, -1});
    expect_near(camera.world_from_camera[0], {1, 0, 0});
}

TEST(Camera, LookingAlongUpAndMinusZHasPlusXUp) {
    CameraParams params = at({0, 0, 10});
    params.up = {0, 0, 1};
    expect_near(made(params).world_from_camera[1], {1, 0, 0});
}

TEST(Camera, QuaternionReplacesTargetUpAndRoll) {
    CameraParams params = at({0, 0, 10});
    params.rotation =
        glm::dvec4(0, 2.0 * std::sqrt(0.5), 0, 2.0 * std::sqrt(0.5));  // 90 degrees about y, not unit
    params.target = {5, 5, 5};
    params.roll = 12.0;
    Camera camera = made(params);
    expect_near(-camera.world_from_camera[2], {-1, 0, 0});
    expect_near(camera.world_from_camera[0], {0, 0, -1});
}

TEST(Camera, QuaternionsAndDegreesAgree) {
    double h = real::radians(15.0);  // half of 30 degrees
    struct {
        glm::dvec4 q;
        glm::dvec3 degrees;
    } cases[] = {{{real::sin(h), 0, 0, real::cos(h)}, {30, 0, 0}},
                 {{0, real::sin(h), 0, real::cos(h)}, {0, 30, 0}},
                 {{0, 0, real::sin(h), real::cos(h)}, {0, 0, 30}}};
    for (const auto& c : cases) {
        glm::dmat3 a = rotation_from_quaternion(c.q), b = rotation_from_degrees(c.degrees);
        for (int i = 0; i < 3; ++i) expect_near(a[i], b[i]);
    }
}

TEST(Camera, DegreesTurnAboutXThenYThenZ) {
    // x: +y to +z; y: +z to +x; z: +x to +y.
    expect_near(rotation_from_degrees({90, 90, 90}) * glm::dvec3(0, 1, 0), {0, 1, 0});
    expect_near(rotation_from_degrees({90, 0, 90}) * glm::dvec3(1, 0, 0), {0, 1, 0});
}

TEST(Camera, RayThroughAPixelHitsThePointSeenThere) {
    CameraParams params = at({3, -2, 7});
    params.target = {-1, 4, 0.5};
    params.roll = 33.0;
    Camera camera = made(params);
    glm::dvec3 point(0.3, 1.2, 1.9);
    glm::dvec3 seen = project(camera, point);
    expect_near(ray_direction(camera, seen.x, seen.y), glm::normalize(point - camera.eye));
    params.projection = Projection::orthographic;
    expect_near(ray_direction(made(params), 12.0, 800.0), glm::normalize(params.target - *params.position));
}

// The share of half the picture that the corners of a box reach, as seen by the framing camera.
double fill_of(const CameraParams& params, const Bounds& box, double width, double height) {
    Camera camera = make_camera(params, width, height, box);
    double fill = 0.0;
    for (int k = 0; k < 8; ++k) {
        glm::dvec3 seen = project(
            camera, {k & 1 ? box.hi.x : box.lo.x, k & 2 ? box.hi.y : box.lo.y, k & 4 ? box.hi.z : box.lo.z});
        EXPECT_GT(seen.z, 0.0);
        fill = std::fmax(fill, std::fabs(seen.x - width / 2) / (width / 2));
        fill = std::fmax(fill, std::fabs(seen.y - height / 2) / (height / 2));
    }
    return fill;
}

TEST(Framing, FillsNineTenthsOfWideTallAndDeepPictures) {
    Bounds boxes[] = {
        {{-5, -0.1, -3}, {5, 0.1, 3}}, {{10, 20, 30}, {10.5, 28, 31}}, {{-1, -1, -40}, {1, 1, 40}}};
    for (const Bounds& box : boxes)
        for (Projection projection : {Projection::perspective, Projection::orthographic}) {
            CameraParams params;
            params.projection = projection;
            EXPECT_NEAR(fill_of(params, box, 1920, 1080), 0.9, 1e-9);
            EXPECT_NEAR(fill_of(params, box, 600, 1000), 0.9, 1e-9);
        }
}

TEST(Framing, LooksFrom35DegreesAboveZ) {
    Bounds box{{-1, -1, -1}, {3, 1, 1}};
    Camera camera = make_camera({}, 100, 100, box);
    glm::dvec3 back = glm::normalize(camera.eye - box.center());
    expect_near(back, {0.0, std::sin(35.0 * real::pi / 180.0), std::cos(35.0 * real::pi / 180.0)}, 1e-12);
    expect_near(camera.world_from_camera[2], back, 1e-12);
    expect_near(frame_box(box, 45.0, 1.0).position, camera.eye, 1e-12);
}

TEST(Framing, ScalesWithTheBox) {
    const Bounds box{{-1, -0.5, -2}, {1, 0.5, 2}};
    const glm::dvec3 back = frame_box(box, 40.0, 1.5).position;
    for (const double scale : {1e-9, 1e9})
        expect_near(frame_box({box.lo * scale, box.hi * scale}, 40.0, 1.5).position / scale, back, 1e-9);
}

TEST(Framing, EmptyBoxesAndPointsAreSeenToo) {
    Bounds point;
    point.add(glm::dvec3(1, 2, 3));
    for (const Bounds& box : {Bounds{}, point}) {
        Camera camera = make_camera({}, 100, 100, box);
        EXPECT_TRUE(std::isfinite(camera.eye.x + camera.eye.y + camera.eye.z));
        EXPECT_GT(glm::length(camera.eye - (box.empty() ? glm::dvec3(0.0) : box.center())), 0.5);
    }
}

// p * M with OpenEXR's row vectors, divided by w.
glm::dvec3 transformed(const float* m, const glm::dvec3& p) {
    double out[4];
    for (int c = 0; c < 4; ++c) out[c] = p.x * m[c] + p.y * m[4 + c] + p.z * m[8 + c] + m[12 + c];
    return glm::dvec3(out[0], out[1], out[2]) / out[3];
}

TEST(ExrMatrices, CameraSpaceIsLeftHandedWithZForward) {
    ExrMatrices m = exr_matrices(made(at({0, 0, 10})), 1920, 1080);
    expect_near(transformed(m.world_to_camera, {1, 2, 3}), {1, 2, 7}, 1e-6);
}

TEST(ExrMatrices, NdcRunsFromTheUpperLeftToTheLowerRightCorner) {
    for (Projection projection : {Projection::perspective, Projection::orthographic}) {
        CameraParams params = at({3, -2, 7});
        params.projection = projection;
        params.target = {-1, 4, 0.5};
        params.roll = 20.0;
        params.far = 100.0;
        Camera camera = made(params);
        ExrMatrices m = exr_matrices(camera, 1920, 1080);
        glm::dvec3 point(0.3, 1.2, 1.9);
        glm::dvec3 seen = project(camera, point), ndc = transformed(m.world_to_ndc, point);
        EXPECT_NEAR(ndc.x, seen.x / 1920.0, 1e-6);
        EXPECT_NEAR(ndc.y, seen.y / 1080.0, 1e-6);
        glm::dvec3 forward = -camera.world_from_camera[2];
        EXPECT_NEAR(transformed(m.world_to_ndc, camera.eye + forward * camera.far).z, 1.0, 1e-5);
    }
}

TEST(CameraErrors, EachSaysKeyExpectationAndFinding) {
    auto with = [](auto change) {
        CameraParams params = at({0, 0, 10});
        change(params);
        return error_of(params);
    };
    EXPECT_EQ(with([](CameraParams& p) {
                  p.projection = Projection::fisheye;
                  p.fisheye_fov = 361.0;
              }),
              "camera.fisheye_fov: expected degrees above 0, at most 360, found 361");
    EXPECT_EQ(with([](CameraParams& p) {
                  p.projection = Projection::equirectangular;
                  p.panorama_fov = 0.0;
              }),
              "camera.panorama_fov: expected degrees above 0, at most 360, found 0");
    EXPECT_EQ(with([](CameraParams& p) { p.target = *p.position; }),
              "camera.target: expected a point other than camera.position, found [0, 0, 10]");
    EXPECT_EQ(with([](CameraParams& p) {
                  p.up = {0, 0, 0};
              }),
              "camera.up: expected a direction, found [0, 0, 0]");
    EXPECT_EQ(with([](CameraParams& p) { p.rotation = glm::dvec4(0.0); }),
              "camera.rotation: expected a quaternion x y z w that is not zero, found [0, 0, 0, 0]");
    EXPECT_EQ(with([](CameraParams& p) { p.fov = 180.0; }),
              "camera.fov: expected degrees between 0 and 180, found 180");
    EXPECT_EQ(with([](CameraParams& p) { p.fov = NAN; }),
              "camera.fov: expected degrees between 0 and 180, found nan");
    EXPECT_EQ(with([](CameraParams& p) { p.near = 0.0; }),
              "camera.near: expected more than 0 scene units, found 0");
    EXPECT_EQ(with([](CameraParams& p) { p.far = 0.005; }),
              "camera.far: expected 0, or more than camera.near, found 0.005");
    EXPECT_EQ(with([](CameraParams& p) { p.focal_length = -1.0; }),
              "camera.focal_length: expected 0 or more mm, found -1");
    EXPECT_EQ(with([](CameraParams& p) { p.film_width = 0.0; }),
              "camera.film_width: expected more than 0 mm, found 0");
    EXPECT_EQ(with([](CameraParams& p) {
                  p.projection = Projection::orthographic;
                  p.height = 0.0;
              }),
              "camera.height: expected more than 0 scene units, found 0");
}

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

TEST(Stereo, WrongNumbersAreReported) {
    CameraParams params = params_of(Projection::perspective, Eye::left);
    params.eye_separation = -1.0;
    EXPECT_THROW(make_camera(params, width_px, height_px, {}), InputError);
    params = params_of(Projection::perspective, Eye::left, -2.0);
    EXPECT_THROW(make_camera(params, width_px, height_px, {}), InputError);
}

}  // namespace
}  // namespace astrosplat
