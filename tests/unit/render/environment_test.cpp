// Environments: lookup, the backdrop, and cube maps in one file.
#include "render/environment.h"

#include "camera/camera.h"
#include "render/render.h"
#include "support/cube_map.h"
#include "support/printing.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Environment lookup with colour-coded pictures: every direction has one right answer.

/// A folder for this test's pictures, removed afterwards.
class EnvironmentTest : public testing::Test {
  protected:
    // A picture of 32-bit floats as a minimal TIFF: little-endian, one uncompressed strip.
    fs::path write(const std::string& name, int width, int height,
                   const std::function<glm::vec3(int, int)>& color);

    TempFolder folder_;
};

void append(std::string& bytes, std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i) bytes += char(value >> (8 * i));
}

fs::path EnvironmentTest::write(const std::string& name, int width, int height,
                                const std::function<glm::vec3(int, int)>& color) {
    const auto w = std::uint32_t(width), h = std::uint32_t(height);
    constexpr std::uint32_t tags = 11, pixels_at = 8 + 2 + tags * 12 + 4 + 12;
    const std::uint32_t shorts_at = 8 + 2 + tags * 12 + 4;
    const std::uint32_t table[tags][4] = {{256, 4, 1, w},
                                          {257, 4, 1, h},
                                          {258, 3, 3, shorts_at},
                                          {259, 3, 1, 1},
                                          {262, 3, 1, 2},
                                          {273, 4, 1, pixels_at},
                                          {277, 3, 1, 3},
                                          {278, 4, 1, h},
                                          {279, 4, 1, w * h * 12},
                                          {284, 3, 1, 1},
                                          {339, 3, 3, shorts_at + 6}};
    std::string bytes = "II*";
    append(bytes, 0, 1);
    append(bytes, 8, 4);
    append(bytes, tags, 2);
    for (const auto& tag : table) {
        append(bytes, tag[0], 2);
        append(bytes, tag[1], 2);
        append(bytes, tag[2], 4);
        append(bytes, tag[3], 4);
    }
    append(bytes, 0, 4);
    for (int i = 0; i < 3; ++i) append(bytes, 32, 2);
    for (int i = 0; i < 3; ++i) append(bytes, 3, 2);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::vec3 c = color(x, y);
            bytes.append(reinterpret_cast<const char*>(&c[0]), 12);
        }
    const fs::path file = folder_ / name;
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
}

void expect_color(const glm::vec3& got, const glm::vec3& expected, float tolerance) {
    EXPECT_NEAR(glm::distance(got, expected), 0.0f, tolerance)
        << got.r << " " << got.g << " " << got.b << " instead of " << expected.r << " " << expected.g << " "
        << expected.b;
}

// A smooth colour that tells the direction.
glm::vec3 code(const glm::dvec3& d) { return glm::vec3(d * 0.5 + 0.5); }

// Directions spread evenly over the sphere (golden spiral).
std::vector<glm::dvec3> directions(int count) {
    std::vector<glm::dvec3> result;
    for (int i = 0; i < count; ++i) {
        double y = 1.0 - (i + 0.5) * 2.0 / count, r = std::sqrt(1.0 - y * y), angle = i * 2.399963229728653;
        result.emplace_back(r * std::cos(angle), y, r * std::sin(angle));
    }
    return result;
}

// OpenEXR's latlong, the other way round: longitude falls from +pi to -pi, latitude from +pi/2.
glm::dvec3 latlong_direction(int x, int y, int width, int height) {
    double longitude = real::pi * (1.0 - 2.0 * (x + 0.5) / width),
           latitude = real::pi * (0.5 - (y + 0.5) / height);
    return {std::sin(longitude) * std::cos(latitude), std::sin(latitude),
            std::cos(longitude) * std::cos(latitude)};
}

TEST_F(EnvironmentTest, LatlongShowsItsCentreTowardsPlusZAndItsRightTowardsMinusX) {
    // Nine fields as letters on a map: top, middle, bottom rows; left, centre, right columns.
    EnvironmentParams params;
    params.image = write("map.tif", 64, 32, [](int x, int y) { return glm::vec3(x / 64.0, y / 32.0, 0.25); });
    Environment environment = load_environment(params);
    auto at = [&](const glm::dvec3& d) { return sample_environment(environment, glm::normalize(d), 0.0); };
    const float half_x = 0.5f / 64, half_y = 0.5f / 32;  // texel centres
    expect_color(at({0, 0, 1}), {0.5f - half_x, 0.5f - half_y, 0.25f}, 1e-6f);
    expect_color(at({-1, 0, 0}), {0.75f - half_x, 0.5f - half_y, 0.25f}, 1e-6f);  // right of the centre
    expect_color(at({1, 0, 0}), {0.25f - half_x, 0.5f - half_y, 0.25f}, 1e-6f);
    EXPECT_LT(at({0, 0.9, 0.1}).y, 0.15f);  // the top row is up
    EXPECT_GT(at({0, -0.9, 0.1}).y, 0.85f);
}

TEST_F(EnvironmentTest, LatlongGivesEveryDirectionItsColour) {
    EnvironmentParams params;
    params.image =
        write("map.tif", 256, 128, [](int x, int y) { return code(latlong_direction(x, y, 256, 128)); });
    Environment environment = load_environment(params);
    // The bilinear error of a sine over a step h is h^2/8.
    for (const glm::dvec3& d : directions(2000))
        expect_color(sample_environment(environment, d, 0.0), code(d), 3e-4f);
}

TEST_F(EnvironmentTest, LatlongHasNoSeamAndNoPole) {
    EnvironmentParams params;
    params.image =
        write("map.tif", 256, 128, [](int x, int y) { return code(latlong_direction(x, y, 256, 128)); });
    Environment environment = load_environment(params);
    for (double spread : {0.0, 0.05, 0.3}) {
        for (int i = 0; i < 64; ++i) {
            double latitude = (i - 31.5) / 32.0 * 1.55;
            glm::dvec3 left(1e-7, std::sin(latitude), -std::cos(latitude)), right(-1e-7, left.y, left.z);
            expect_color(sample_environment(environment, left, spread),
                         sample_environment(environment, right, spread), 1e-5f);
        }
        for (double pole : {1.0, -1.0})
            for (int i = 0; i < 16; ++i) {
                double a = i * 0.3927, r = 1e-6;
                glm::dvec3 one(r * std::cos(a), pole, r * std::sin(a)), other(-one.x, pole, -one.z);
                expect_color(sample_environment(environment, one, spread),
                             sample_environment(environment, other, spread), 1e-5f);
            }
    }
}

// The view from the origin with the camera turned to a face; +y and -y by tilting from -z.
struct Face {
    glm::dvec3 forward, up;
};
const std::array<Face, 6> faces = {{{{1, 0, 0}, {0, 1, 0}},
                                    {{-1, 0, 0}, {0, 1, 0}},
                                    {{0, 1, 0}, {0, 0, 1}},
                                    {{0, -1, 0}, {0, 0, -1}},
                                    {{0, 0, 1}, {0, 1, 0}},
                                    {{0, 0, -1}, {0, 1, 0}}}};

Camera face_camera(std::size_t face, int size) {
    CameraParams params;
    params.position = glm::dvec3(0.0);
    params.target = faces[face].forward;
    params.up = faces[face].up;
    params.fov = 90.0;
    return make_camera(params, size, size, {});
}

class CubeTest : public EnvironmentTest {
  protected:
    // Six pictures that a 90 degree camera at the origin takes of `color`.
    EnvironmentParams cube(int size,
                           const std::function<glm::vec3(std::size_t face, const glm::dvec3&)>& color) {
        EnvironmentParams params;
        for (std::size_t face = 0; face < 6; ++face) {
            Camera camera = face_camera(face, size);
            params.cube.push_back(write(fmt::format("{}.tif", face), size, size, [&](int x, int y) {
                return color(face, ray_direction(camera, x + 0.5, y + 0.5));
            }));
        }
        return params;
    }
};

TEST_F(CubeTest, EachFaceShowsItsPictureTheRightWayRound) {
    // Red grows to the right, green downwards, blue counts the faces.
    EnvironmentParams params;
    for (int face = 0; face < 6; ++face)
        params.cube.push_back(write(fmt::format("{}.tif", face), 16, 16, [face](int x, int y) {
            return glm::vec3((x + 0.5) / 16, (y + 0.5) / 16, face / 8.0);
        }));
    Environment environment = load_environment(params);
    for (std::size_t face = 0; face < 6; ++face) {
        Camera camera = face_camera(face, 16);
        for (double x : {2.0, 8.0, 13.7})
            for (double y : {1.5, 7.0, 14.0})
                expect_color(sample_environment(environment, ray_direction(camera, x, y), 0.0),
                             {x / 16, y / 16, float(face) / 8.0f}, 1e-5f);
    }
}

TEST_F(CubeTest, TopPictureHasItsTopTowardsPlusZ) {
    Environment environment =
        load_environment(cube(16, [](std::size_t, const glm::dvec3& d) { return code(d); }));
    expect_color(sample_environment(environment, glm::normalize(glm::dvec3(0.1, 1, 0.4)), 0.0),
                 code(glm::normalize(glm::dvec3(0.1, 1, 0.4))), 2e-3f);
}

TEST_F(CubeTest, GivesEveryDirectionItsColour) {
    Environment environment =
        load_environment(cube(128, [](std::size_t, const glm::dvec3& d) { return code(d); }));
    // A border texel lies half a texel aside of where its neighbour's centre is: 0.5/128 of a face at most.
    for (const glm::dvec3& d : directions(5000))
        expect_color(sample_environment(environment, d, 0.0), code(d), 4e-3f);
}

TEST_F(CubeTest, HasNoEdgesEvenBetweenPlainColours) {
    // A different colour on every face: the hardest case for a seam.
    Environment environment = load_environment(cube(8, [](std::size_t face, const glm::dvec3&) {
        return glm::vec3(face & 1 ? 1.0f : 0.0f, face & 2 ? 1.0f : 0.0f, face & 4 ? 1.0f : 0.0f);
    }));
    for (double spread : {0.0, 0.4})
        for (int i = -99; i <= 99; i += 3) {
            double t = i / 100.0, e = 1e-7;
            const glm::dvec3 pairs[][2] = {
                {{1, t, 1 - e}, {1 - e, t, 1}},   {{1, 1 - e, t}, {1 - e, 1, t}},
                {{t, -1, 1 - e}, {t, -1 + e, 1}}, {{-1, t, -1 + e}, {-1 + e, t, -1}},
                {{t, 1, -1 + e}, {t, 1 - e, -1}}, {{-1, -1 + e, t}, {-1 + e, -1, t}}};
            for (const auto& pair : pairs)
                expect_color(sample_environment(environment, glm::normalize(pair[0]), spread),
                             sample_environment(environment, glm::normalize(pair[1]), spread), 1e-5f);
        }
}

TEST_F(EnvironmentTest, WideSpreadGivesTheMean) {
    EnvironmentParams params;
    params.image =
        write("map.tif", 30, 14, [](int x, int) { return glm::vec3(x % 2 ? 1.0f : 0.0f, 0.5f, 0.0f); });
    Environment environment = load_environment(params);
    expect_color(sample_environment(environment, {0, 0, 1}, 10.0), {0.5f, 0.5f, 0.0f}, 1e-6f);
}

TEST_F(EnvironmentTest, SpreadBlendsBetweenLevels) {
    EnvironmentParams params;
    params.image = write("map.tif", 64, 32, [](int x, int) { return glm::vec3(x == 32 ? 1.0f : 0.0f); });
    Environment environment = load_environment(params);
    glm::dvec3 d = latlong_direction(32, 15, 64, 32);
    d.y = 0.0;
    double texel = 2.0 * real::pi / 64;
    auto at = [&](double spread) { return sample_environment(environment, glm::normalize(d), spread).r; };
    EXPECT_EQ(at(0.3 * texel), 1.0f);
    EXPECT_NEAR(at(std::sqrt(2.0) * texel), 0.5 * (at(texel) + at(2.0 * texel)), 1e-6);
    EXPECT_LT(at(2.0 * texel), 0.7f);
}

TEST_F(EnvironmentTest, RotationTurnsTheSkyGainScalesIt) {
    EnvironmentParams params;
    params.image =
        write("map.tif", 256, 128, [](int x, int y) { return code(latlong_direction(x, y, 256, 128)); });
    params.rotation = {0, 90, 0};
    params.gain = 2.0f;
    Environment environment = load_environment(params);
    // Turned by +90 degrees about y, what was towards +z is seen towards +x.
    expect_color(sample_environment(environment, {1, 0, 0}, 0.0), code({0, 0, 1}) * 2.0f, 1e-3f);
    EXPECT_NEAR(environment.largest, 2.0f, 1e-3f);
    params.rotation = {0, 0, 0};
    params.gain = 0.5f;
    set_environment_params(environment, params);
    expect_color(sample_environment(environment, {1, 0, 0}, 0.0), code({1, 0, 0}) * 0.5f, 1e-3f);
    EXPECT_NEAR(environment.largest, 0.5f, 1e-3f);
}

TEST_F(EnvironmentTest, NoPictureIsBlack) {
    Environment environment = load_environment({});
    expect_color(sample_environment(environment, {0, 0, 1}, 0.01), glm::vec3(0.0f), 0.0f);
    EXPECT_EQ(environment.largest, 0.0f);
}

std::string error_of(const EnvironmentParams& params) { return ERROR_OF(load_environment(params)); }

TEST_F(EnvironmentTest, ErrorsNameWhatIsWrong) {
    EnvironmentParams params;
    params.cube = {"a.tif", "b.tif"};
    EXPECT_EQ(
        error_of(params),
        "environment.cube: expected six pictures of the faces of a cube, in the order +x -x +y -y +z -z, "
        "found 2");
    const fs::path small = write("small.tif", 4, 4, [](int, int) { return glm::vec3(0.0f); });
    const fs::path wide = write("wide.tif", 8, 4, [](int, int) { return glm::vec3(0.0f); });
    params.cube = {small, small, small, wide, small, small};
    EXPECT_EQ(error_of(params),
              wide.string() +
                  ":environment.cube: expected 4 x 4 pixels, as the first picture's width, found 8 x 4");
    params.image = small;
    EXPECT_EQ(error_of(params), "environment: expected image, cube or tile, found several of them");
    EnvironmentParams missing;
    missing.image = folder_ / "missing.exr";
    EXPECT_HAS(error_of(missing), "missing.exr");
}

// On a sphere of radius 4 about the origin: what rays from its inside meet.
TEST(EnvironmentBehind, IsSeenFromWhereTheEyeIs) {
    Environment environment;
    const glm::dvec3 ray = glm::normalize(glm::dvec3(1.0, 2.0, -2.0));
    EXPECT_EQ(seen_place(environment, {3.0, 0.0, 0.0}, ray).direction, ray) << "infinitely far";
    EXPECT_EQ(seen_place(environment, {3.0, 0.0, 0.0}, ray).distance, 1.0);
    environment.behind = 4.0;
    EXPECT_LT(glm::distance(seen_place(environment, {0.0, 0.0, 0.0}, ray).direction, ray), 1e-15);
    const SeenPlace ahead = seen_place(environment, {2.0, 0.0, 0.0}, {1.0, 0.0, 0.0});
    EXPECT_EQ(ahead.direction, glm::dvec3(1.0, 0.0, 0.0));
    EXPECT_EQ(ahead.distance, 0.5);
    EXPECT_EQ(seen_place(environment, {2.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}).distance, 1.5);
    const SeenPlace aside = seen_place(environment, {2.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
    EXPECT_LT(glm::distance(aside.direction, glm::dvec3(0.5, std::sqrt(0.75), 0.0)), 1e-15);
    EXPECT_NEAR(aside.distance, std::sqrt(0.75), 1e-15);
    const SeenPlace outside = seen_place(environment, {40.0, 0.0, 0.0}, {1.0, 0.0, 0.0});
    EXPECT_NEAR(outside.distance, 0.01, 1e-12) << "taken to be just inside";
}

TEST_F(EnvironmentTest, OneTiledPictureFillsTheSky) {
    EnvironmentParams params;
    params.tile = write("tile.tif", 64, 48, [](int x, int y) {
        return glm::vec3(0.1f + 0.01f * float((x * 7 + y * 3) % 11), 0.2f, 0.05f);
    });
    params.tiling.face_px = 64;
    params.tiling.height_deg = 40.0;
    const Environment environment = load_environment(params);
    ASSERT_EQ(environment.faces->size(), 6u);
    for (const glm::dvec3& d : {glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0.3, 0.4, -0.5)})
        expect_color(sample_environment(environment, glm::normalize(d), 3.0), {0.15f, 0.2f, 0.05f}, 0.01f);
    params.image = params.tile;
    EXPECT_THROW(load_environment(params), InputError);
}

// The backdrop against the environment's own colours: smooth pictures must agree to interpolation, across the
// seam and over the poles, and a frame with a backdrop must treat it as the environment.

/// An equirectangular picture of one level whose colours say the direction, with the border that load makes.
Environment sky_of_directions(std::int64_t width) {
    const std::int64_t height = width / 2;
    Image level = make_image(width + 2, height + 2, 3);
    for (std::int64_t y = -1; y <= height; ++y)
        for (std::int64_t x = -1; x <= width; ++x) {
            const double longitude = (0.5 - (double(x) + 0.5) / double(width)) * 2.0 * real::pi;
            const double latitude = (0.5 - (double(y) + 0.5) / double(height)) * real::pi;
            const double ring = real::cos(latitude);
            const double d[3] = {ring * real::sin(longitude), real::sin(latitude),
                                 ring * real::cos(longitude)};
            for (int k = 0; k < 3; ++k) level.at(x + 1, y + 1)[k] = float(0.5 + 0.5 * d[k]);
        }
    Environment environment;
    environment.faces = std::make_shared<const EnvironmentFaces>(EnvironmentFaces{{level}});
    environment.gain = 1.5f;
    environment.largest_texel = 1.0f;
    environment.largest = 1.5f;
    return environment;
}

Camera looking(const glm::dvec3& target) {
    CameraParams params;
    params.position = {0.0, 0.0, 0.0};
    params.target = target;
    params.fov = 70.0;
    Bounds box;
    box.add({-1.0, -1.0, -1.0});
    box.add({1.0, 1.0, 1.0});
    return make_camera(params, 400.0, 240.0, box);
}

class Backdrop : public testing::TestWithParam<glm::dvec3> {};

TEST_P(Backdrop, IsWhatTheEnvironmentShows) {
    const Environment environment = sky_of_directions(512);
    const Camera camera = looking(GetParam());
    Image picture;
    draw_backdrop(environment, camera, 400, 240, picture);
    ASSERT_EQ(picture.channels, 4);
    for (std::int64_t y = 0; y < 240; ++y)
        for (std::int64_t x = 0; x < 400; ++x) {
            const glm::dvec3 ray = ray_direction(camera, double(x) + 0.5, double(y) + 0.5);
            const glm::vec3 exact = sample_environment(environment, ray, 0.0);
            for (int k = 0; k < 3; ++k)
                ASSERT_NEAR(picture.at(x, y)[k], exact[k], 3e-3f) << x << " " << y << " channel " << k;
        }
}

INSTANTIATE_TEST_SUITE_P(Directions, Backdrop,
                         testing::Values(glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(0.0, 0.0, -1.0),  // the seam
                                         glm::dvec3(0.1, 1.0, 0.0), glm::dvec3(0.1, -1.0, 0.2),  // poles
                                         glm::dvec3(1.0, 0.6, -1.0)));

TEST(BackdropFrame, StandsForTheEnvironment) {
    const Environment environment = sky_of_directions(256);
    const Camera camera = looking({0.3, 0.2, 1.0});
    RenderSettings settings;
    settings.width = 400;
    settings.height = 240;
    const RenderedFrame exact = render({}, camera, &environment, settings);
    Image picture;
    draw_backdrop(environment, camera, 400, 240, picture);
    settings.backdrop = &picture;
    const RenderedFrame frame = render({}, camera, nullptr, settings);
    for (std::size_t i = 0; i < frame.beauty.pixels.size(); ++i) {
        const float wanted = i % 4 == 3 ? 1.0f : picture.pixels[i];
        ASSERT_EQ(frame.beauty.pixels[i], wanted);
        ASSERT_NEAR(frame.beauty.pixels[i], exact.beauty.pixels[i], 3e-3f);
    }
}

// A cube map in one file, from the file to the colour seen along a direction.

class CubeMapFile : public testing::Test {
  protected:
    void SetUp() override {
        params_.image = folder_ / "sky.exr";
        write_cube_map(params_.image, 8, [](int, int y) { return float(1 + y / 8) / 8.0f; });
    }
    TempFolder folder_;
    EnvironmentParams params_;
};

TEST_F(CubeMapFile, IsAnEnvironmentOfSixFaces) {
    const Environment environment = load_environment(params_);
    ASSERT_EQ(environment.faces->size(), 6u);
    const glm::dvec3 axes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int face = 0; face < 6; ++face)
        for (const double spread : {0.0, 0.1}) {
            const glm::vec3 color = sample_environment(environment, axes[face], spread);
            EXPECT_FLOAT_EQ(color.r, float(1 + face) / 8.0f) << face << " " << spread;
        }
}

TEST_F(CubeMapFile, IsNotOneFaceOfSix) {
    params_.cube.assign(6, params_.image);
    params_.image.clear();
    EXPECT_THROW(load_environment(params_), InputError);
}

TEST_F(CubeMapFile, LoadingCanBeCancelled) {
    const std::atomic<bool> cancelled{true};
    EXPECT_THROW(load_environment(params_, Progress{{}, &cancelled}), Cancelled);
}

}  // namespace
}  // namespace astrosplat
