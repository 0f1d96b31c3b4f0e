// Where a picture lies in the world, and a reference over the frame.
#include "scene/front_frame.h"
#include "core/rotation.h"
#include "scene/reference_place.h"
#include "source/textured_mesh.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Every texel differs from its neighbours; opaque.
Texture numbered_texture(std::int64_t width, std::int64_t height) {
    Texture texture;
    texture.wrap = TextureSettings::Wrap::clamp;
    texture.image = make_image(width, height, 4, 1.0f);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x) {
            texture.image.at(x, y)[0] = float(x);
            texture.image.at(x, y)[1] = float(y);
            texture.image.at(x, y)[2] = 0.5f;
        }
    return texture;
}

std::vector<TexturedMesh> builtin(const std::string& name, std::int64_t width, std::int64_t height) {
    std::vector<TexturedMesh> meshes(1);
    meshes[0].mesh = builtin_mesh(name, double(width) / double(height));
    meshes[0].textures.push_back(numbered_texture(width, height));
    return meshes;
}

// Moves every vertex.
template <class Move>
std::vector<TexturedMesh> moved(std::vector<TexturedMesh> meshes, const Move& move) {
    for (TexturedMesh& m : meshes)
        for (glm::vec3& p : m.mesh.positions) p = move(p);
    return meshes;
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_LT(glm::distance(a, b), 1e-6) << a.x << " " << a.y << " " << a.z;
}

void expect_frame(const FrontFrame& frame, const glm::dvec3& right, const glm::dvec3& up, double width,
                  double height) {
    expect_near(frame.right, right);
    expect_near(frame.up, up);
    expect_near(frame.toward, glm::cross(right, up));
    EXPECT_NEAR(frame.width, width, 1e-6);
    EXPECT_NEAR(frame.height, height, 1e-6);
}

constexpr glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);

TEST(FrontFrame, OfThePlaneIsSeenFromAbove) {
    expect_frame(front_frame(builtin("plane", 32, 16)), x, -z, 10.0, 5.0);
    expect_frame(front_frame(builtin("plane", 16, 32)), x, -z, 5.0, 10.0);
    expect_frame(front_frame(builtin("disk", 32, 16)), x, -z, 10.0, 10.0);
}

TEST(FrontFrame, PicturesReadRightWhicheverWayTheyStand) {
    const std::vector<TexturedMesh> plane = builtin("plane", 32, 16);
    const auto turned = [&](const auto& move) { return front_frame(moved(plane, move)); };
    expect_frame(turned([](const glm::vec3& p) { return glm::vec3(p.x, -p.z, 0.0f); }), x, y, 10.0, 5.0);
    expect_frame(turned([](const glm::vec3& p) { return glm::vec3(0.0f, -p.z, -p.x); }), -z, y, 10.0, 5.0);
    expect_frame(turned([](const glm::vec3& p) { return glm::vec3(p.z, 0.0f, p.x); }), z, -x, 10.0, 5.0);
    expect_frame(turned([](const glm::vec3& p) { return glm::vec3(-p.x, 0.0f, p.z); }), -x, -z, 10.0, 5.0);
    expect_near(turned([](const glm::vec3& p) { return p + glm::vec3(1, 2, 3); }).center,
                glm::dvec3(1, 2, 3));
}

TEST(FrontFrame, FollowsTheLayersTransform) {
    RenderLayer layer;
    layer.world_from_layer = rotation_from_degrees({90.0, 0.0, 0.0});
    layer.scale = 2.0;
    layer.translate = {0.0, 0.0, 7.0};
    const FrontFrame frame = in_world(front_frame(builtin("plane", 32, 16)), layer);
    expect_frame(frame, x, y, 20.0, 10.0);
    expect_near(frame.center, glm::dvec3(0, 0, 7));
}

TEST(FrontFrame, CamerasStandInFrontAtSixtyDegreesAndInThePlane) {
    const FrontFrame frame = front_frame(builtin("plane", 32, 16));
    const CameraParams front = judging_camera(frame, JudgingView::front, 2.0);
    const CameraParams side = judging_camera(frame, JudgingView::side, 1280.0 / 720.0);
    const CameraParams edge = judging_camera(frame, JudgingView::edge, 3.2);
    expect_near(*front.position, glm::dvec3(0, 20, 0));
    expect_near(front.up, -z);
    EXPECT_NEAR(front.height, 5.0, 1e-12);
    expect_near(*side.position, glm::dvec3(0, 10, 20.0 * std::sqrt(0.75)));
    expect_near(side.up, y);
    EXPECT_NEAR(side.height, 5.625, 1e-12);
    expect_near(*edge.position, glm::dvec3(0, 0, 20));
    EXPECT_NEAR(edge.height, 3.125, 1e-12);
}

// The sides of a galaxy are those of its disk, not of its picture.
TEST(FrontFrame, TurnsAlongAGalaxy) {
    const FrontFrame frame;
    EXPECT_EQ(along_galaxy(frame, {}).toward, frame.toward) << "of which nothing is said";
    const FrontFrame along = along_galaxy(frame, {60.0, 0.0, glm::dvec2(0.75, 0.5), 90.0, {}});
    // The upper part of the picture is nearer: the disk's normal points down there.
    EXPECT_LT(glm::length(along.toward - glm::dvec3(0.0, 0.5, std::sqrt(0.75))), 1e-9);
    EXPECT_LT(glm::length(along.up - glm::dvec3(0.0, std::sqrt(0.75), -0.5)), 1e-9);
    EXPECT_LT(glm::length(along.right - frame.right), 1e-9);
    EXPECT_LT(glm::length(along.center - glm::dvec3(2.5, 0.0, 0.0)), 1e-9);
}

// The line of sight is upright in the view, and what is nearer to the viewer is above.
TEST(FrontFrame, TheLineOfSightIsUprightFromAbove) {
    const FrontFrame frame;
    for (const double near_side : {0.0, 58.0, 238.0}) {
        const FrontFrame seen = along_sight(frame, {60.0, 0.0, glm::dvec2(0.5, 0.5), near_side, {}});
        EXPECT_NEAR(glm::dot(seen.right, frame.toward), 0.0, 1e-12) << near_side;
        EXPECT_NEAR(glm::dot(seen.up, frame.toward), std::sqrt(0.75), 1e-12) << near_side;
        EXPECT_NEAR(glm::length(glm::cross(seen.right, seen.up) - seen.toward), 0.0, 1e-12) << near_side;
    }
}

TEST(FrontFrame, AMeshWithoutAreaIsRefused) {
    const std::vector<TexturedMesh> line =
        moved(builtin("plane", 4, 4), [](const glm::vec3& p) { return glm::vec3(p.x, 0.0f, 0.0f); });
    EXPECT_HAS(ERROR_OF(front_frame(line)), "a line or a point");
    EXPECT_HAS(ERROR_OF(front_frame({})), "vertices");
}

void expect_numbered(const Image& picture, std::int64_t width, std::int64_t height, float tolerance) {
    ASSERT_EQ(picture.width, width);
    ASSERT_EQ(picture.height, height);
    for (std::int64_t j = 0; j < height; ++j)
        for (std::int64_t i = 0; i < width; ++i) {
            ASSERT_NEAR(picture.at(i, j)[0], float(i), tolerance) << i << " " << j;
            ASSERT_NEAR(picture.at(i, j)[1], float(j), tolerance) << i << " " << j;
        }
}

TEST(FrontPicture, OfAPlaneIsItsPicture) {
    for (const auto& [width, height] : {std::pair{37, 23}, {64, 200}, {1, 1}}) {
        const std::vector<TexturedMesh> plane = builtin("plane", width, height);
        expect_numbered(front_picture(plane, front_frame(plane)), width, height, 1e-3f);
    }
}

// A camera sees its picture wherever it stands and whatever the mesh that it is projected onto.
TEST(FrontPicture, ThroughItsCameraIsThePicture) {
    for (const double height : {0.0, 3.0}) {
        std::vector<TexturedMesh> plane = builtin("plane", 40, 20);
        UvCamera params;
        params.position = glm::dvec3(0.0, 6.0, 2.5);
        params.fov = 25.0;
        params.height = height;
        plane[0].camera = picture_camera(params, 2.0);
        apply_camera_uv(plane[0].mesh, *plane[0].camera);
        const FrontFrame frame = front_frame(plane);
        EXPECT_NEAR(frame.height, 0.5 * frame.width, 1e-9);
        expect_numbered(front_picture(plane, frame), 40, 20, 2e-3f);
    }
}

TEST(FrontFrame, ItsCameraFollowsTheLayersTransform) {
    std::vector<TexturedMesh> plane = builtin("plane", 32, 16);
    for (const double height : {0.0, 3.0}) {
        UvCamera params;
        params.position = glm::dvec3(2.0, 6.0, 3.0);
        params.height = height;
        plane[0].camera = picture_camera(params, 2.0);
        RenderLayer layer;
        layer.translate = {7.0, -3.0, 2.0};
        layer.scale = 3.0;
        layer.world_from_layer = rotation_from_degrees({20.0, 40.0, -70.0});
        const CameraParams front =
            judging_camera(in_world(front_frame(plane), layer), JudgingView::front, 2.0);
        const Camera in_world = make_camera(front, 2.0, 1.0, {});
        const glm::dvec3 point(1.0, 0.5, -1.0);
        const auto own = place_in_picture(*plane[0].camera, point),
                   world = place_in_picture(in_world,
                                            layer.world_from_layer * (layer.scale * point) + layer.translate);
        ASSERT_TRUE(own && world);
        EXPECT_LT(glm::distance(own->uv, world->uv), 1e-9);
    }
}

TEST(FrontPicture, TransparencyIsSeenOnBlack) {
    std::vector<TexturedMesh> plane = builtin("plane", 8, 8);
    for (std::int64_t i = 0; i < 64; ++i) plane[0].textures[0].image.pixels[std::size_t(4 * i + 3)] = 0.75f;
    const Image picture = front_picture(plane, front_frame(plane));  // the texture is premultiplied already
    EXPECT_NEAR(picture.at(4, 4)[2], 0.5f, 1e-6f);
    EXPECT_NEAR(picture.at(6, 2)[0], 6.0f, 1e-3f);
}

TEST(FrontPicture, OfADiskIsBlackAroundIt) {
    const std::vector<TexturedMesh> disk = builtin("disk", 64, 64);
    const Image picture = front_picture(disk, front_frame(disk));
    ASSERT_EQ(picture.width, 64);
    ASSERT_EQ(picture.height, 64);
    for (std::int64_t j = 0; j < 64; ++j)
        for (std::int64_t i = 0; i < 64; ++i) {
            const double r = std::hypot(double(i) - 31.5, double(j) - 31.5);
            if (std::fabs(r - 32.0) > 0.6) {
                EXPECT_EQ(picture.at(i, j)[2], r < 32.0 ? 0.5f : 0.0f) << i << " " << j;
            }
            if (r < 31.0) {
                EXPECT_NEAR(picture.at(i, j)[0], float(i), 1e-3f);
            }
        }
}

TEST(FrontPicture, TheNearestFaceIsSeen) {
    std::vector<TexturedMesh> meshes = builtin("plane", 16, 16);
    meshes.push_back(moved(builtin("plane", 16, 16),
                           [](const glm::vec3& p) { return glm::vec3(0.5f * p.x, 1.0f, 0.5f * p.z); })[0]);
    for (float& value : meshes[1].textures[0].image.pixels) value = 1.0f;
    FrontFrame frame = front_frame(meshes);
    for (const bool above : {true, false}) {
        const Image picture = front_picture(meshes, frame);
        EXPECT_EQ(picture.at(picture.width / 2, picture.height / 2)[2], above ? 1.0f : 0.5f);
        EXPECT_EQ(picture.at(1, 1)[2], 0.5f);
        for (glm::vec3& p : meshes[1].mesh.positions) p.y = -1.0f;
    }
}

TEST(FrontPicture, WithoutTextureCoordinatesIsRefused) {
    std::vector<TexturedMesh> plane = builtin("plane", 4, 4);
    for (Mesh::Triangle& face : plane[0].mesh.triangles) face.uv.fill(Mesh::no_uv);
    EXPECT_HAS(ERROR_OF(front_picture(plane, front_frame(plane))), "found none");
}

// References over a frame of 400 px height whose middle is at (300, 200).

const FrameOnScreen frame{{300.0, 200.0}, 400.0};

void expect_near(glm::dvec2 found, glm::dvec2 expected) {
    EXPECT_LT(glm::distance(found, expected), 1e-9) << found.x << ", " << found.y;
}

TEST(ReferencePlace, AtFirstItIsAsHighAsTheFrame) {
    const PicturePlace place = place_of({}, 1.5, frame);
    expect_near(place.corner, {0.0, 0.0});
    expect_near(place.right, {600.0, 0.0});
    expect_near(place.down, {0.0, 400.0});
}

TEST(ReferencePlace, PositionIsUpAndRotationCounterClockwise) {
    ReferenceParams reference;
    reference.position = {0.25, 0.5};
    reference.scale = 0.5;
    reference.rotate = 90.0;
    const PicturePlace place = place_of(reference, 2.0, frame);
    expect_near(place.right, {0.0, -400.0});
    expect_near(place.down, {200.0, 0.0});
    expect_near(place.corner, {300.0, 200.0});
}

TEST(ReferencePlace, MirroredItsLeftIsAtTheRight) {
    ReferenceParams reference;
    reference.mirrored = true;
    const PicturePlace place = place_of(reference, 1.0, frame);
    expect_near(place.corner, {500.0, 0.0});
    expect_near(place.right, {-400.0, 0.0});
}

TEST(ReferencePlace, AGripIsACornerTheInsideOrTheRest) {
    const PicturePlace place = place_of({}, 1.0, frame);
    EXPECT_EQ(grip_at(place, {105.0, 5.0}, 10.0), PlaceGrip::scale);
    EXPECT_EQ(grip_at(place, {115.0, 5.0}, 10.0), PlaceGrip::move);
    EXPECT_EQ(grip_at(place, {85.0, 5.0}, 10.0), PlaceGrip::turn);
    EXPECT_EQ(grip_at(place, {300.0, 410.0}, 10.0), PlaceGrip::turn);
}

TEST(ReferencePlace, TurnsStayWithinHalfATurn) {
    ReferenceParams reference;
    reference.rotate = 170.0;
    reference = dragged(reference, PlaceGrip::turn, {400.0, 200.0}, {300.0, 100.0}, frame);
    EXPECT_NEAR(reference.rotate, -100.0, 1e-9);
}

TEST(ReferencePlace, ScalingKeepsWhatLiesUnderTheMouse) {
    ReferenceParams reference;
    reference.position = {0.1, -0.2};
    reference.rotate = 30.0;
    const auto place_in_picture = [&](glm::dvec2 px) {
        const PicturePlace place = place_of(reference, 1.5, frame);
        const glm::dvec2 from = px - place.corner;
        return glm::dvec2(glm::dot(from, place.right) / glm::dot(place.right, place.right),
                          glm::dot(from, place.down) / glm::dot(place.down, place.down));
    };
    const glm::dvec2 mouse{123.0, 310.0}, before = place_in_picture(mouse);
    reference = scaled_about(reference, 1.7, mouse, frame);
    EXPECT_NEAR(reference.scale, 1.7, 1e-12);
    expect_near(place_in_picture(mouse), before);
}

TEST(ReferencePlace, NoDragLeavesTheRangeOfScales) {
    const ReferenceParams huge = scaled_about({}, 1e9, frame.middle, frame);
    EXPECT_EQ(huge.scale, 1e3);
    const ReferenceParams none = dragged({}, PlaceGrip::scale, {400.0, 200.0}, frame.middle, frame);
    EXPECT_EQ(none.scale, 1e-3);
    const ReferenceParams held = dragged({}, PlaceGrip::scale, frame.middle, {0.0, 0.0}, frame);
    EXPECT_EQ(held.scale, 1.0);
}

TEST(FindReference, TheViewsOwnComesBeforeThatForAny) {
    using View = ReferenceParams::View;
    Scene scene;
    EXPECT_FALSE(find_reference(scene, View::top, 1.0));
    scene.references.resize(4);
    EXPECT_FALSE(find_reference(scene, View::top, 1.0)) << "without a file there is none";
    scene.references[1].file = "any.png";
    scene.references[2].file = "top.png";
    scene.references[2].view = View::top;
    scene.references[3].file = "later.png";
    scene.references[3].frames = "10-20";
    scene.references[3].view = View::camera;
    EXPECT_EQ(find_reference(scene, View::top, 1.0), 2u);
    EXPECT_EQ(find_reference(scene, View::side, 1.0), 1u);
    EXPECT_EQ(find_reference(scene, View::camera, 9.0), 1u);
    EXPECT_EQ(find_reference(scene, View::camera, 20.5), 3u);
    EXPECT_EQ(find_reference(scene, View::camera, 21.0), 1u);
}

}  // namespace
}  // namespace astrosplat
