// Built-in shapes, and how pictures lie on them.
#include "source/textured_mesh.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Built-in shapes by closed form: areas, volumes (which turn negative with faces that look inward), texture
// coordinates without jumps, no face without area.

using real::pi;

// Of a closed mesh whose faces look outward.
double volume(const Mesh& mesh) {
    double sum = 0.0;
    for (const Mesh::Triangle& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.position[0]]), b(mesh.positions[t.position[1]]),
            c(mesh.positions[t.position[2]]);
        sum += glm::dot(a, glm::cross(b, c)) / 6.0;
    }
    return sum;
}

#define EXPECT_WITHIN(value, expected, share) EXPECT_NEAR(value, expected, (share)*std::fabs(expected))

TEST(Shapes, RingHasTheAreaAndVolumeOfATorus) {
    ShapeParams shape;
    shape.tube = 0.2;
    const Mesh ring = turned_shape("ring", shape);
    EXPECT_WITHIN(surface_area(ring), 4.0 * pi * pi * 4.0 * 1.0, 2e-3);
    EXPECT_WITHIN(volume(ring), 2.0 * pi * pi * 4.0 * 1.0, 3e-3);
    EXPECT_NEAR(bounds(ring).hi.x, 5.0, 1e-5);
    EXPECT_NEAR(bounds(ring).hi.y, 1.0, 1e-5);
    shape.tube = 0.5;  // closes over the axis
    EXPECT_WITHIN(surface_area(turned_shape("ring", shape)), 4.0 * pi * pi * 2.5 * 2.5, 2e-3);
}

TEST(Shapes, SpheroidsAreFlattenedAndNested) {
    ShapeParams shape;
    shape.flattening = 0.5;
    const double e = std::sqrt(0.75);
    const Mesh oblate = turned_shape("spheroid", shape);
    EXPECT_WITHIN(surface_area(oblate), 2.0 * pi * 25.0 * (1.0 + 0.25 / e * std::atanh(e)), 2e-3);
    EXPECT_WITHIN(volume(oblate), 4.0 / 3.0 * pi * 125.0 * 0.5, 2e-3);
    shape.flattening = 0.0;
    shape.shells = 4;
    shape.concentration = 0.0;  // at 1/4, 2/4, 3/4 and the whole
    const double even = 4.0 * pi * 25.0 * (1 + 4 + 9 + 16) / 16.0;
    EXPECT_WITHIN(surface_area(turned_shape("spheroid", shape)), even, 2e-3);
    shape.concentration = 2.0;
    double area = 0.0;
    for (int i = 1; i <= 4; ++i) {
        const double r = -std::log(1.0 - i / 4.0 * (1.0 - std::exp(-2.0))) / 2.0;
        area += 4.0 * pi * 25.0 * r * r;
    }
    EXPECT_WITHIN(surface_area(turned_shape("spheroid", shape)), area, 2e-3);
}

TEST(Shapes, ShellsHaveTwoWallsThatLookAwayFromWhatIsBetween) {
    ShapeParams shape;
    shape.thickness = 0.4;
    const Mesh shell = turned_shape("shell", shape);
    EXPECT_WITHIN(surface_area(shell), 4.0 * pi * 25.0 * (1.0 + 0.36), 2e-3);
    EXPECT_WITHIN(volume(shell), 4.0 / 3.0 * pi * 125.0 * (1.0 - 0.216), 3e-3);
}

TEST(Shapes, BubblesAreOpenAtTheTop) {
    ShapeParams shape;
    for (const double opening : {0.0, 60.0, 90.0, 150.0}) {
        shape.opening = opening;
        const Mesh bubble = turned_shape("bubble", shape);
        EXPECT_WITHIN(surface_area(bubble), 2.0 * pi * 25.0 * (1.0 + std::cos(real::radians(opening))), 3e-3)
            << opening;
        EXPECT_NEAR(bounds(bubble).hi.y, 5.0 * std::cos(real::radians(opening)), 1e-5);
        EXPECT_NEAR(bounds(bubble).lo.y, -5.0, 1e-5);
    }
}

TEST(Shapes, HourglassGoesFromTwoLobesToASpheroid) {
    ShapeParams shape;
    shape.width = 1.0;
    shape.waist = 1.0;
    EXPECT_WITHIN(surface_area(turned_shape("hourglass", shape)), 4.0 * pi * 25.0, 2e-3);
    shape.width = 0.6;
    for (const double w : {0.01, 0.3, 0.8}) {
        shape.waist = w;
        const Mesh lobes = turned_shape("hourglass", shape);
        const double v = 4.0 / 3.0 * w * w + 2.0 * w * (1.0 - w) + 16.0 / 15.0 * (1.0 - w) * (1.0 - w);
        EXPECT_WITHIN(volume(lobes), 125.0 * pi * 0.36 * v, 3e-3) << w;
        EXPECT_NEAR(bounds(lobes).hi.y, 5.0, 1e-5);
    }
}

TEST(Shapes, RevolutionOfAnOutlineFromEitherEnd) {
    ShapeParams shape;
    shape.outline = {{0.0f, -1.0f}, {2.0f, 0.0f}, {0.0f, 3.0f}};
    const Mesh cones = turned_shape("revolution", shape);
    EXPECT_WITHIN(surface_area(cones), 2.0 * pi * (std::sqrt(5.0) + std::sqrt(13.0)), 2e-3);
    EXPECT_WITHIN(volume(cones), pi * 4.0 * 4.0 / 3.0, 2e-3);
    std::ranges::reverse(shape.outline);
    EXPECT_EQ(turned_shape("revolution", shape).positions, cones.positions);
    shape.outline = {{1.0f, 0.0f}, {1.0f, 4.0f}};
    EXPECT_WITHIN(surface_area(turned_shape("revolution", shape)), 8.0 * pi, 2e-3);
    shape.outline = {};
    EXPECT_EQ(ERROR_OF(turned_shape("revolution", shape)),
              "revolution: expected an outline of at least 2 points [r, y], found 0");
}

TEST(Shapes, VRunsByLengthAlongAnOutline) {
    ShapeParams shape;
    shape.outline = {{0.0f, 0.0f}, {3.0f, 0.0f}, {3.0f, 1.0f}};  // a plate and its rim
    const Mesh mesh = turned_shape("revolution", shape);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (mesh.positions[i].y == 0.0f) {
            const double r = glm::length(glm::dvec3(mesh.positions[i]));
            ASSERT_NEAR(mesh.uvs[i].y, r / 4.0, 1e-5);
        }
}

// Every face small in uv and not without area; the same place has the same uv but for whole turns.
TEST(Shapes, TextureCoordinatesAreContinuousAndNoFaceIsDegenerate) {
    ShapeParams shape;
    shape.shells = 2;
    shape.outline = {{0.5f, -2.0f}, {2.0f, 0.0f}, {1.0f, 0.5f}, {0.0f, 3.0f}};
    for (const char* name : {"revolution", "hourglass", "shell", "bubble", "spheroid", "ring"}) {
        const Mesh mesh = turned_shape(name, shape);
        for (const Mesh::Triangle& t : mesh.triangles) {
            const glm::dvec3 a(mesh.positions[t.position[0]]), b(mesh.positions[t.position[1]]),
                c(mesh.positions[t.position[2]]);
            ASSERT_GT(glm::length(glm::cross(b - a, c - a)), 1e-9) << name;
            const glm::vec2 p = mesh.uvs[t.uv[0]], q = mesh.uvs[t.uv[1]], r = mesh.uvs[t.uv[2]];
            const glm::vec2 spread = glm::max(glm::abs(q - p), glm::abs(r - p));
            ASSERT_LT(std::max(spread.x, spread.y), 0.04f) << name;
            ASSERT_GT(std::fabs((q - p).x * (r - p).y - (q - p).y * (r - p).x), 1e-7f) << name;
        }
    }
    std::map<std::array<float, 3>, glm::vec2> seen;
    const Mesh mesh = turned_shape("hourglass", shape);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3 p = mesh.positions[i];
        if (p.x == 0.0f && p.z == 0.0f) continue;  // the poles have every u
        const auto [found, is_new] = seen.try_emplace({p.x, p.y, p.z}, mesh.uvs[i]);
        if (is_new) continue;
        EXPECT_EQ(found->second.y, mesh.uvs[i].y);
        EXPECT_EQ(std::fabs(found->second.x - mesh.uvs[i].x), 1.0f);
    }
    EXPECT_EQ(mesh.positions.size() - seen.size(), 127u + 2u * 129u)
        << "the seam and the poles, nothing else";
}

Texture grey_texture(int width, int height) {
    Texture texture;
    texture.image = make_image(width, height, 4, 1.0f);
    return texture;
}

TEST(Sheet, HeightsAreTheDepthMapStretchedToTheDepth) {
    const TempFolder folder;
    std::string map = "P2 64 1 65535\n";  // 16 bit, a part of its range
    for (int x = 0; x < 64; ++x) map += std::to_string(20000 + 300 * x) + " ";
    ShapeParams shape;
    shape.depth_map = folder.file("depth.pgm", map);
    shape.depth = 0.3;
    shape.blur = 0.0;
    const Mesh sheet = sheet_mesh(grey_texture(40, 20), shape);
    const Bounds box = bounds(sheet);
    EXPECT_NEAR(box.lo.y, -1.5, 1e-6);
    EXPECT_NEAR(box.hi.y, 1.5, 1e-6);
    EXPECT_NEAR(box.hi.x, 5.0, 1e-6);
    EXPECT_NEAR(box.hi.z, 2.5, 1e-6);
    for (const glm::vec3& p : sheet.positions) {
        if (std::fabs(p.x) < 4.9f) {
            ASSERT_NEAR(p.y, 0.3f * p.x * 64.0f / 63.0f, 0.01f) << p.x;
        }
    }
    shape.depth_map = folder / "none.pgm";
    EXPECT_HAS(ERROR_OF(sheet_mesh(grey_texture(4, 4), shape)), "none.pgm");
}

TEST(Sheet, WithoutAMapItsHeightIsTheBlurredBrightness) {
    constexpr int side = 512;
    Texture texture = grey_texture(side, side);
    for (std::int64_t i = 0; i < side * side; ++i)
        std::fill_n(texture.image.pixels.data() + 4 * i, 3, i % side < side / 2 ? 0.0f : 1.0f);
    ShapeParams shape;
    shape.depth = 0.2;
    shape.blur = 0.05;
    const Mesh sheet = sheet_mesh(texture, shape);
    for (const glm::vec3& p : sheet.positions) {  // an edge blurred by 0.5 scene units: the error function
        if (std::fabs(p.z) < 0.1f) {
            ASSERT_NEAR(p.y, std::erf(double(p.x) / (0.5 * std::sqrt(2.0))), 0.03) << p.x;
        }
    }
    for (std::int64_t i = 0; i < side * side; ++i) std::fill_n(texture.image.pixels.data() + 4 * i, 3, 0.5f);
    EXPECT_NEAR(bounds(sheet_mesh(texture, shape)).extent().y, 0.0, 1e-3) << "even light is a plane";
}

// Where a picture is in a scene: its camera, its size, its back wall.

// Pictures in scene units and back walls: places worked out by hand, and what stays as it was.

// One vertex, in the middle of a large box.
glm::vec2 uv_at(const glm::vec3& p, const SourceParams& source, double aspect) {
    Mesh mesh;
    mesh.positions = {p, p, p};
    mesh.triangles = {{{0, 1, 2}, {0, 1, 2}, 0}};
    apply_source_uv(mesh, source, {glm::dvec3(-50.0), glm::dvec3(50.0)}, aspect);
    return mesh.uvs[0];
}

SourceParams planar(UvMode mode, double width) {
    SourceParams source;
    source.uv = mode;
    source.uv_width = width;
    return source;
}

TEST(PlanarUv, AWidthInSceneUnitsDoesNotDependOnTheMesh) {
    // A picture 8 wide and 4 high.
    EXPECT_EQ(uv_at({2, 1, 7}, planar(UvMode::planar_xy, 8.0), 2.0), glm::vec2(0.75f, 0.75f));
    EXPECT_EQ(uv_at({2, 7, 1}, planar(UvMode::planar_xz, 8.0), 2.0), glm::vec2(0.75f, 0.25f));
    EXPECT_EQ(uv_at({7, 1, 2}, planar(UvMode::planar_yz, 8.0), 2.0), glm::vec2(0.25f, 0.75f));
    SourceParams moved = planar(UvMode::planar_xy, 8.0);
    moved.uv_center = {2.0, 1.0, 0.0};
    EXPECT_EQ(uv_at({2, 1, 7}, moved, 2.0), glm::vec2(0.5f, 0.5f));
    EXPECT_EQ(uv_at({6, 3, 7}, moved, 2.0), glm::vec2(1.0f, 1.0f));
}

TEST(PlanarUv, WithoutAWidthThePictureIsStretchedOverTheBox) {
    EXPECT_EQ(uv_at({25, -50, 7}, planar(UvMode::planar_xy, 0.0), 2.0), glm::vec2(0.75f, 0.0f));
}

Mesh ball(BackWall back) {
    Mesh mesh = builtin_mesh("sphere", 1.0);
    SourceParams source = planar(UvMode::planar_xy, 0.0);
    source.back = back;
    apply_source_uv(mesh, source, bounds(mesh), 1.0);
    return mesh;
}

TEST(PlanarUv, AMirroredBackReadsRightFromBehind) {
    const Mesh mesh = ball(BackWall::mirrored);
    int behind = 0;
    for (const Mesh::Triangle& t : mesh.triangles) {
        float z = 0.0f;
        for (const std::uint32_t corner : t.position) z += mesh.positions[corner].z;
        behind += z < 0.0f;
        for (int k = 0; k < 3; ++k) {
            const glm::vec3 p = mesh.positions[t.position[k]];
            const glm::vec2 uv = mesh.uvs[t.uv[k]];
            ASSERT_NEAR(uv.x, 0.5f + (z < 0.0f ? -0.1f : 0.1f) * p.x, 1e-5f);
            ASSERT_NEAR(uv.y, 0.5f + 0.1f * p.y, 1e-5f);
        }
    }
    EXPECT_EQ(behind, int(mesh.triangles.size() / 2));
}

TEST(PlanarUv, AVariedBackLeavesTheFrontAndHasNoJump) {
    const Mesh same = ball(BackWall::same), varied = ball(BackWall::varied);
    double sum = 0.0, most = 0.0;
    int behind = 0;
    for (std::size_t i = 0; i < same.positions.size(); ++i) {
        const auto off = double(glm::length(varied.uvs[i] - same.uvs[i]));
        if (same.positions[i].z >= 0.0f) {
            ASSERT_EQ(off, 0.0);
        } else if (same.positions[i].z < -2.5f) {
            sum += off, ++behind;
        }
        most = std::max(most, off);
    }
    EXPECT_GT(sum / behind, 0.04);
    EXPECT_LT(most, 0.45);
    for (const Mesh::Triangle& t : varied.triangles)
        for (int k = 0; k < 3; ++k)
            ASSERT_LT(glm::length(varied.uvs[t.uv[k]] - varied.uvs[t.uv[(k + 1) % 3]]), 0.1f);
}

// The camera that took a picture: places worked out by hand.

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
