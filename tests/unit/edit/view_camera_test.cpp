// Views and navigation, by closed forms: what is under the mouse stays under it.
#include "edit/view_camera.h"

#include "edit/edits.h"
#include "scene/animate.h"
#include "scenes.h"
#include "support/test.h"

namespace astrosplat {
namespace {

const glm::dvec2 viewport(1600.0, 900.0);
const Bounds volume{{-4.0, -1.0, -3.0}, {6.0, 1.0, 5.0}};
const double aspect = viewport.x / viewport.y;

/// Where the engine's camera sees a point, px.
glm::dvec2 project(const CameraParams& params, const glm::dvec3& point, const Bounds& framed = {}) {
    const Camera c = make_camera(params, viewport.x, viewport.y, framed);
    const glm::dvec3 p = glm::transpose(c.world_from_camera) * (point - c.eye);
    const double scale = c.projection == Projection::orthographic ? c.focal_px : c.focal_px / -p.z;
    return {c.center_x_px + p.x * scale, c.center_y_px - p.y * scale};
}
glm::dvec2 project(const FreeCamera& camera, const glm::dvec3& point) {
    return project(camera_params(camera), point);
}

double distance(const FreeCamera& camera) { return glm::length(camera.position - camera.pivot); }

/// Upright, from below, from exactly above, tilted up vector, orthographic.
std::vector<FreeCamera> cameras() {
    std::vector<FreeCamera> all(5);
    all[0].position = {3.0, 4.0, 10.0};
    all[0].pivot = {1.0, 0.5, -2.0};
    all[1].position = {-7.0, -3.0, 0.5};
    all[2].position = {0.0, 8.0, 0.0};
    all[3].position = {5.0, 1.0, 2.0};
    all[3].up = {0.3, 2.0, -0.5};
    all[3].fov_deg = 20.0;
    all[4] = all[0];
    all[4].projection = Projection::orthographic;
    all[4].height = 7.0;
    return all;
}

TEST(Navigation, PointsAreWhereTheEngineSeesThem) {
    for (const FreeCamera& camera : cameras()) {
        expect_near(project(camera, camera.pivot), viewport * 0.5, 1e-9);
        for (const glm::dvec2& px : {glm::dvec2(0, 0), glm::dvec2(1234.5, 77.25), glm::dvec2(1600, 900)}) {
            expect_near(project(camera, point_under(camera, px, viewport)), px, 1e-8);
            const glm::dvec3 far = point_at_depth(camera, px, viewport, 42.0);
            expect_near(project(camera, far), px, 1e-8);
            EXPECT_NEAR(glm::dot(far - camera.position, view_axes(camera).forward), 42.0, 1e-9);
        }
    }
}

TEST(Navigation, ACameraThatCannotBeMadeIsNone) {
    CameraParams params;
    params.position = glm::dvec3(0.0, 3.0, 4.0);
    const std::optional<FreeCamera> seen = try_free_camera(params, {}, 1.0);
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->pivot, params.target);
    EXPECT_EQ(seen->position, *params.position);
    params.target = *params.position;
    EXPECT_FALSE(try_free_camera(params, {}, 1.0));
}

TEST(Navigation, OrbitKeepsTheDistanceAndThePivot) {
    for (const FreeCamera& camera : cameras()) {
        FreeCamera turned = camera;
        for (int i = 0; i < 50; ++i) turned = orbit(turned, {13.7 * i, 5.3 * (i % 7) - 9.0}, viewport.y);
        EXPECT_NEAR(distance(turned), distance(camera), 1e-12 * distance(camera) * 50);
        EXPECT_EQ(turned.pivot, camera.pivot);
    }
}

TEST(Navigation, OrbitByAViewportHeightIsHalfATurn) {
    FreeCamera camera;
    camera.position = {0.0, 0.0, 10.0};
    expect_near(orbit(camera, {450.0, 0.0}, 900.0).position, {-10.0, 0.0, 0.0}, 1e-12);  // object turns right
    expect_near(orbit(camera, {900.0, 0.0}, 900.0).position, {0.0, 0.0, -10.0}, 1e-12);
    const double h = 10.0 * std::sqrt(0.5);
    expect_near(orbit(camera, {0.0, 225.0}, 900.0).position, {0.0, h, h}, 1e-12);  // pulled down: from above
}

TEST(Navigation, WhatLiesInFrontOfThePivotFollowsTheMouse) {
    for (const FreeCamera& camera : cameras()) {
        const glm::dvec3 front = camera.pivot - view_axes(camera).forward * (0.1 * distance(camera));
        const glm::dvec2 before = project(camera, front);
        EXPECT_GT(project(orbit(camera, {0.0, 5.0}, viewport.y), front).y, before.y - 1e-9);
        if (camera.position.x == 0.0 && camera.position.z == 0.0) continue;  // from above it only turns
        EXPECT_GT(project(orbit(camera, {5.0, 0.0}, viewport.y), front).x, before.x);
        EXPECT_GT(project(orbit(camera, {0.0, 5.0}, viewport.y), front).y, before.y);
    }
}

TEST(Navigation, OrbitDoesNotFlipAtThePoles) {
    for (const double way : {1.0, -1.0}) {
        FreeCamera camera;
        camera.position = {0.0, 0.0, 10.0};
        glm::dvec3 right = view_axes(camera).right;
        for (int i = 0; i < 200; ++i) {
            camera = orbit(camera, {0.0, 10.0 * way}, 900.0);
            EXPECT_GT(glm::dot(view_axes(camera).right, right), 0.999999) << i;
            right = view_axes(camera).right;
        }
        EXPECT_NEAR(camera.position.y, 10.0 * way, 1e-4);
        const FreeCamera back = orbit(camera, {0.0, -450.0 * way}, 900.0);
        EXPECT_NEAR(back.position.z, 10.0, 0.1);
    }
}

TEST(Navigation, OrbitFromExactlyAboveKeepsThePictureUpright) {
    FreeCamera camera;
    camera.position = {0.0, 8.0, 0.0};  // -z is up
    const FreeCamera tilted = orbit(camera, {0.0, -1.0}, 900.0);
    EXPECT_GT(glm::dot(view_axes(tilted).up, view_axes(camera).up), 0.99999);
    const FreeCamera turned = orbit(camera, {450.0, -1.0}, 900.0);
    EXPECT_NEAR(glm::dot(view_axes(turned).up, view_axes(camera).right), 1.0, 1e-4);
}

TEST(Navigation, PanMovesThePivotsPlaneByThePixels) {
    for (const FreeCamera& camera : cameras()) {
        const glm::dvec2 from(700.0, 300.0), delta(123.0, -45.5);
        const glm::dvec3 point = point_under(camera, from, viewport);
        const FreeCamera moved = pan(camera, delta, viewport.y);
        expect_near(project(moved, point), from + delta, 1e-8);
        expect_near(view_axes(moved).forward, view_axes(camera).forward, 1e-12);
        EXPECT_NEAR(distance(moved), distance(camera), 1e-12 * distance(camera));
    }
}

TEST(Navigation, ZoomKeepsThePointUnderTheCursor) {
    for (const FreeCamera& camera : cameras())
        for (const double steps : {1.0, -3.0, 10.0}) {
            const glm::dvec2 px(1300.0, 200.0);
            const glm::dvec3 point = point_under(camera, px, viewport);
            const FreeCamera zoomed = zoom_to(camera, steps, px, viewport);
            expect_near(project(zoomed, point), px, 1e-7);
            EXPECT_NEAR(scene_units_per_px(zoomed, 900.0),
                        scene_units_per_px(camera, 900.0) * std::pow(1.15, -steps), 1e-12);
            expect_near(view_axes(zoomed).forward, view_axes(camera).forward, 1e-9);
        }
}

TEST(Navigation, ZoomInAndOutIsNoMove) {
    for (const FreeCamera& camera : cameras()) {
        const glm::dvec2 px(100.0, 850.0);
        const FreeCamera back = zoom_to(zoom_to(camera, 4.0, px, viewport), -4.0, px, viewport);
        expect_near(back.position, camera.position, 1e-9);
        expect_near(back.pivot, camera.pivot, 1e-9);
    }
}

TEST(Navigation, ZoomNeverReachesThePivot) {
    FreeCamera camera;
    for (int i = 0; i < 1000; ++i) camera = zoom_to(camera, 1.0, viewport * 0.5, viewport);
    EXPECT_GT(distance(camera), 0.0);
    EXPECT_NO_THROW(view_axes(camera));
}

TEST(Navigation, DollyByAViewportHeightIsSixteenTimesNearer) {
    for (const FreeCamera& camera : cameras()) {
        const FreeCamera near = dolly(camera, {0.0, -900.0}, 900.0);  // dragged up
        EXPECT_NEAR(scene_units_per_px(near, 900.0), scene_units_per_px(camera, 900.0) / 16.0, 1e-12);
        EXPECT_EQ(near.pivot, camera.pivot);
        EXPECT_NEAR(scene_units_per_px(dolly(near, {-900.0, 0.0}, 900.0), 900.0),
                    scene_units_per_px(camera, 900.0), 1e-12);
    }
}

TEST(Navigation, LookingAroundStandsStill) {
    for (const FreeCamera& camera : cameras()) {
        const FreeCamera turned = look_around(camera, {120.0, 60.0}, viewport.y);
        EXPECT_EQ(turned.position, camera.position);
        EXPECT_NEAR(distance(turned), distance(camera), 1e-12 * distance(camera));
        if (camera.position.x == 0.0 && camera.position.z == 0.0) continue;  // straight down it only turns
        EXPECT_GT(project(camera, turned.pivot).x, viewport.x * 0.5);
    }
    FreeCamera level;
    const FreeCamera right = look_around(level, {900.0, 0.0}, 900.0);  // one field of view
    expect_near(view_axes(right).forward, {std::sqrt(0.5), 0.0, -std::sqrt(0.5)}, 1e-12);
    const FreeCamera down = look_around(level, {0.0, 900.0}, 900.0);
    expect_near(view_axes(down).forward, {0.0, -std::sqrt(0.5), -std::sqrt(0.5)}, 1e-12);
    FreeCamera up = level;
    for (int i = 0; i < 100; ++i) up = look_around(up, {0.0, -90.0}, 900.0);
    EXPECT_GT(view_axes(up).forward.y, 0.99999);
    EXPECT_GT(view_axes(up).right.x, 0.99999);  // not over the pole
}

TEST(Navigation, FlyingMovesAlongThePicturesAxes) {
    for (const FreeCamera& camera : cameras()) {
        const ViewAxes axes = view_axes(camera);
        const FreeCamera flown = fly(camera, {1.0, -2.0, 3.0});
        const glm::dvec3 way = axes.right - 2.0 * axes.up + 3.0 * axes.forward;
        expect_near(flown.position - camera.position, way, 1e-12);
        expect_near(flown.pivot - camera.pivot, way, 1e-12);
    }
}

/// Every corner in the picture, one of them at 90 % of its half width or height.
TEST(Navigation, FramingFillsThePicture) {
    for (const FreeCamera& camera : cameras()) {
        const FreeCamera result = framed(camera, volume, aspect);
        expect_near(view_axes(result).forward, view_axes(camera).forward, 1e-9);
        expect_near(result.pivot, volume.center(), 1e-12);
        double fill = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 p(corner & 1 ? volume.hi.x : volume.lo.x, corner & 2 ? volume.hi.y : volume.lo.y,
                               corner & 4 ? volume.hi.z : volume.lo.z);
            const glm::dvec2 off = glm::abs(project(result, p) - viewport * 0.5) / (viewport * 0.5);
            fill = std::fmax(fill, std::fmax(off.x, off.y));
            EXPECT_GT(glm::dot(p - result.position, view_axes(result).forward), 0.0);
        }
        EXPECT_NEAR(fill, 0.9, 1e-9);
    }
    EXPECT_NO_THROW(view_axes(framed({}, {}, aspect)));
    Bounds point;
    point.add({1.0, 2.0, 3.0});
    expect_near(framed({}, point, aspect).pivot, {1.0, 2.0, 3.0}, 1e-12);
}

TEST(Navigation, APivotComesToTheMiddle) {
    for (const FreeCamera& camera : cameras()) {
        const glm::dvec3 point = point_at_depth(camera, {300.0, 800.0}, viewport, 6.5);
        const FreeCamera moved = with_pivot(camera, point);
        EXPECT_EQ(moved.pivot, point);
        expect_near(project(moved, point), viewport * 0.5, 1e-8);
        EXPECT_NEAR(distance(moved), 6.5, 1e-9);
        expect_near(view_axes(moved).forward, view_axes(camera).forward, 1e-9);
        EXPECT_EQ(with_pivot(camera, camera.position - view_axes(camera).forward), camera);  // behind
    }
}

TEST(Views, FrontTopAndSideReadRight) {
    const Scene scene = parse_scene(test::edit_scene, "/scene.toml");
    ViewState view;
    const auto off = [&](ViewKind kind, const glm::dvec3& direction) {
        view.view = kind;
        const CameraParams camera = view_camera(scene, view, volume, aspect);
        EXPECT_EQ(camera.projection, Projection::orthographic);
        const glm::dvec2 delta = project(camera, volume.center() + direction) - viewport * 0.5;
        return glm::dvec2(std::round(delta.x / glm::length(delta)),
                          std::round(-delta.y / glm::length(delta)));
    };
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    const glm::dvec2 right(1, 0), up(0, 1);
    EXPECT_EQ(off(ViewKind::front, x), right);
    EXPECT_EQ(off(ViewKind::front, y), up);
    EXPECT_EQ(off(ViewKind::top, x), right);
    EXPECT_EQ(off(ViewKind::top, -z), up);
    EXPECT_EQ(off(ViewKind::side, -z), right);
    EXPECT_EQ(off(ViewKind::side, y), up);
}

TEST(Views, TheSceneCameraIsTheOneAtTheFrame) {
    Scene scene = parse_scene(test::edit_scene, "/scene.toml");
    set_keyframe(scene, "camera.fov", 1.0, 40.0);
    set_keyframe(scene, "camera.fov", 3.0, 60.0);
    ViewState view;
    view.frame = 2.0;
    EXPECT_EQ(view_camera(scene, view, volume, aspect).fov, 50.0);
    view.view = ViewKind::free;
    view.free = cameras()[3];
    EXPECT_EQ(view_camera(scene, view, volume, aspect), camera_params(cameras()[3]));
}

/// A free copy of any camera shows the same picture, and written back it still does.
TEST(Views, AFreeCopyShowsTheSame) {
    std::vector<CameraParams> all(7);
    for (CameraParams& params : all) params.position = glm::dvec3(3.0, 4.0, 10.0);
    all[1].roll = 30.0;
    all[2].rotation = glm::dvec4(0.1, 0.2, 0.3, 0.9);
    all[3].focal_length = 35.0;
    all[4].projection = Projection::orthographic;
    all[5].position.reset();
    all[6].projection = Projection::orthographic;
    all[6].position.reset();
    for (const CameraParams& params : all) {
        const FreeCamera free = free_camera(params, volume, aspect);
        const CameraParams back = moved_camera(params, free, aspect);
        for (const glm::dvec3& p : {glm::dvec3(0, 0, 0), glm::dvec3(1, 2, -3), glm::dvec3(-4, 1, 0.5)}) {
            expect_near(project(free, p), project(params, p, volume), 1e-6);
            expect_near(project(back, p), project(params, p, volume), 1e-6);
        }
        EXPECT_EQ(back.near, params.near);
        EXPECT_EQ(back.focal_length, params.focal_length);  // the lens is as it was, to the bit
        EXPECT_EQ(back.fov, params.fov);
        EXPECT_TRUE(!params.position || back.height == params.height);
    }
    EXPECT_EQ(free_camera(all[0], volume, aspect).pivot, all[0].target);
}

/// From in front, the right and above at once, with the lens as it was and the whole box in the picture.
TEST(Views, ThreeQuarterIsDiagonalAndHoldsTheBox) {
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        FreeCamera before = cameras()[3];
        before.projection = projection;
        const FreeCamera camera = three_quarter_view(before, volume, aspect);
        EXPECT_EQ(camera.fov_deg, before.fov_deg);
        EXPECT_EQ(camera.projection, projection);
        expect_near(camera.pivot, volume.center(), 1e-12);
        expect_near(view_axes(camera).forward, -glm::normalize(glm::dvec3(1.0, 0.8, 1.0)), 1e-12);
        EXPECT_NEAR(view_axes(camera).right.y, 0.0, 1e-12);
        double fill = 0.0;
        for (const double x : {volume.lo.x, volume.hi.x})
            for (const double y : {volume.lo.y, volume.hi.y})
                for (const double z : {volume.lo.z, volume.hi.z}) {
                    const glm::dvec2 off = glm::abs(project(camera, {x, y, z}) - viewport * 0.5);
                    fill = std::fmax(fill, std::fmax(off.x / viewport.x, off.y / viewport.y));
                }
        EXPECT_NEAR(fill, 0.45, 1e-9);
    }
}

struct SeenCamera : testing::Test {
    Scene scene = parse_scene(test::edit_scene, "/scene.toml");  // 16:9, camera at (0, 4, 10)
    ViewState view;
    Status status;
    SeenCamera() {
        status.box = volume;
        status.viewport_aspect = aspect;
        view.frame = 6.8;
        view.free = cameras()[3];
    }
    CameraParams with_keyframe() const {
        Scene edited = scene;
        set_keyframe_of_seen_camera(edited, view, status);
        return scene_at(edited, 7.0).camera;
    }
};

/// The scene's camera, given a keyframe, shows every point where the window showed it.
TEST_F(SeenCamera, IsWhatIsKeyedInEveryView) {
    for (const bool animated : {false, true}) {
        if (animated) scene.camera.rotation = glm::dvec4(0.0, 0.6, 0.0, 0.8);
        for (const ViewKind kind :
             {ViewKind::camera, ViewKind::free, ViewKind::front, ViewKind::top, ViewKind::side})
            for (const FreeCamera& free : cameras()) {
                view.view = kind;
                view.free = free;
                const CameraParams shown = view_camera(scene, view, volume, aspect), now = with_keyframe();
                for (const glm::dvec3& p : {glm::dvec3(0, 0, 0), glm::dvec3(1, 0.2, -1)})
                    expect_near(project(now, p, volume), project(shown, p, volume), 1e-6);
            }
    }
}

TEST_F(SeenCamera, SetsNothingButPlaceAndDirectionOfACameraThatMoves) {
    set_keyframe(scene, "camera.position", 30.0, Value::List{0.0, 1.0, 5.0});
    view.view = ViewKind::free;
    Scene edited = scene;
    set_keyframe_of_seen_camera(edited, view, status);
    EXPECT_TRUE(has_keyframe_at(edited, "camera.position", 7.0));
    EXPECT_TRUE(has_keyframe_at(edited, "camera.target", 7.0));
    EXPECT_EQ(edited.animation.size(), scene.animation.size() + 1);
    EXPECT_EQ(edited.camera, scene.camera);
}

/// A view that was left a moment ago is as high as the viewport, the picture of the camera lower than that.
TEST_F(SeenCamera, KeepsTheLensWhereTheViewportIsNarrow) {
    status.viewport_aspect = 0.5 * aspect;
    view.view = ViewKind::free;
    view.free = free_camera(scene.camera, volume, aspect);
    view.free.fov_deg = 2.0 * real::degrees(real::atan(2.0 * real::tan(real::radians(20.0))));
    EXPECT_EQ(seen_camera(scene, view, status).fov, 40.0);
    expect_near(project(with_keyframe(), {1, 2, -3}), project(scene.camera, {1, 2, -3}), 1e-6);
}

TEST_F(SeenCamera, HasAPlaceWhereTheSceneCameraFramesItsLayers) {
    scene.camera.position.reset();
    for (const double focal_length : {0.0, 90.0}) {
        scene.camera.focal_length = focal_length;
        const CameraParams seen = seen_camera(scene, view, status);
        expect_near(project(seen, {1, 2, -3}), project(scene.camera, {1, 2, -3}, volume), 1e-9);
    }
    status.box = {};
    EXPECT_EQ(ERROR_OF(seen_camera(scene, view, status)),
              "camera.position: expected layers to frame, found none loaded yet");
}

}  // namespace
}  // namespace astrosplat
