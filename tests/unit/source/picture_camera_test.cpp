// The camera that took a picture: places worked out by hand.
#include "source/textured_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace astrosplat {
namespace {

// Ten units before the origin on z; 90 degrees, so that at depth d the picture is 2 d high.
UvCamera wide() {
    UvCamera camera;
    camera.position = glm::dvec3(0.0, 0.0, 10.0);
    camera.fov = 90.0;
    return camera;
}

glm::dvec2 uv_of(const Camera& camera, const glm::dvec3& point) {
    const auto place = place_in_picture(camera, point);
    EXPECT_TRUE(place);
    return place ? place->uv : glm::dvec2(-1.0);
}

void expect_near(const glm::dvec2& a, const glm::dvec2& b) {
    EXPECT_LT(glm::distance(a, b), 1e-12) << a.x << " " << a.y;
}

TEST(PictureCamera, PlacesShrinkWithTheirDistance) {
    const Camera camera = picture_camera(wide(), 2.0);  // at the origin 40 wide and 20 high
    expect_near(uv_of(camera, {0, 0, 0}), {0.5, 0.5});
    expect_near(uv_of(camera, {20, 10, 0}), {1.0, 1.0});
    expect_near(uv_of(camera, {10, -5, 5}), {1.0, 0.0});
    expect_near(uv_of(camera, {10, 5, -10}), {0.625, 0.625});
    EXPECT_NEAR(place_in_picture(camera, {3, 4, -2})->depth, 12.0, 1e-12);
    EXPECT_NEAR(picture_height_at(camera, 12.0), 24.0, 1e-12);
}

TEST(PictureCamera, ParallelRaysKeepTheirDistance) {
    UvCamera params = wide();
    params.height = 8.0;  // and no field of view
    const Camera camera = picture_camera(params, 0.5);
    for (const double z : {9.0, 0.0, -50.0}) expect_near(uv_of(camera, {1, 2, z}), {0.75, 0.75});
    EXPECT_NEAR(picture_height_at(camera, 60.0), 8.0, 1e-12);
}

TEST(PictureCamera, FollowsTargetAndUp) {
    UvCamera params;
    params.position = glm::dvec3(5.0, 3.0, 0.0);
    params.target = glm::dvec3(5.0, 0.0, 0.0);
    params.up = glm::dvec3(1.0, 0.0, 0.0);
    params.height = 4.0;
    expect_near(uv_of(picture_camera(params, 1.0), {6, 0, 0}), {0.5, 0.75});
    expect_near(uv_of(picture_camera(params, 1.0), {5, 0, 1}), {0.75, 0.5});
}

TEST(PictureCamera, ShowsNothingBehindItself) {
    const Camera camera = picture_camera(wide(), 1.0);
    EXPECT_FALSE(place_in_picture(camera, {0, 0, 10}));
    EXPECT_FALSE(place_in_picture(camera, {0, 0, 11}));
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 20}};
    mesh.triangles = {{{0, 1, 2}, {0, 0, 0}, 0}, {{0, 1, 3}, {0, 0, 0}, 0}};
    apply_camera_uv(mesh, camera);
    ASSERT_EQ(mesh.triangles[0].uv, mesh.triangles[0].position);
    EXPECT_EQ(mesh.uvs[1], glm::vec2(0.55f, 0.5f));
    EXPECT_EQ(mesh.triangles[1].uv[0], Mesh::no_uv);
}

TEST(PictureCamera, IsTheSameAsParameters) {
    for (const double height : {0.0, 7.0}) {
        UvCamera params = wide();
        params.position = glm::dvec3(3.0, 5.0, 10.0);
        params.height = height;
        const Camera camera = picture_camera(params, 1.5);
        const Camera again = make_camera(params_of(camera), 1.5, 1.0, {});
        for (const glm::dvec3& point : {glm::dvec3(1, 2, 3), glm::dvec3(-4, 0, -7)})
            expect_near(uv_of(camera, point), uv_of(again, point));
    }
}

}  // namespace
}  // namespace astrosplat
