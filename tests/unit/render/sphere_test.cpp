// Projections onto the sphere through the whole renderer: light at every place and size, pixels against the
// falloff over angles by brute force, no seams and no poles, the same bits for every tile size, number of
// threads, region and instruction set.
#include "support/printing.h"
#include "support/test.h"
#include "unit/render/sphere_scenes.h"

namespace astrosplat {
namespace {

using namespace astrosplat::test;

/// A splat of alpha 1/2 in a direction, so wide that its radius is radius_px in the middle of the frame. Many
/// of one falloff have a cache for its tables.
Image one_splat(const Camera& camera, const glm::dvec3& toward, double radius_px, const Falloff& falloff,
                RenderCache* tables = nullptr) {
    constexpr double distance = 7.0;
    const ShadedSplats splats =
        make_splats({{glm::vec3(distance * toward), float(radius_px / camera.focal_px * distance), 0.5f}});
    RenderLayer layer = layer_of("splat", splats);
    layer.render.falloff = falloff;
    return render({&layer, 1}, camera, nullptr, settings_of(wide_px, high_px), {}, tables).beauty;
}

class SphereLight : public ::testing::TestWithParam<SphereCase> {};

TEST_P(SphereLight, IsConservedAtEveryPlaceAndSize) {
    const Camera camera = camera_of(GetParam().projection);
    const Falloff falloff{GetParam().shape, 0.5f, 4.5f};
    const std::vector<double> angles = solid_angles(camera);
    RenderCache tables;
    double worst = 0.0;
    for (const double radius_px : {0.02, 0.4, 1.3, 3.7, 11.0, 40.0})
        for (const double latitude : {0.0, -33.3, 61.7, 87.1, -89.3, 89.74, 90.0})
            for (const double longitude : {0.1, -120.9, 180.0}) {
                if (radius_px > 0.99 * camera.focal_px) continue;  // the eye would be inside, and it fade
                const double angle = 2.0 * real::degrees(radius_px / camera.focal_px);
                if (!fits(camera, latitude, angle)) continue;
                const glm::dvec3 toward = direction(longitude, latitude);
                const double wanted = 0.5 * falloff_integral(falloff) * radius_px * radius_px;
                const double error =
                    light_on_sphere(one_splat(camera, toward, radius_px, falloff, &tables), angles, 3) /
                        wanted -
                    1.0;
                worst = std::max(worst, std::fabs(error));
                EXPECT_NEAR(error, 0.0, 0.005) << "radius " << radius_px << " px at longitude " << longitude
                                               << ", latitude " << latitude;
            }
    RecordProperty("worst", std::to_string(worst));
}

INSTANTIATE_TEST_SUITE_P(All, SphereLight, ::testing::ValuesIn(sphere_cases()));

// So wide that the pixel filter does not matter: each pixel is the falloff of the chord to the splat, also
// round the seam, over the poles and behind a fisheye.
TEST(Sphere, PixelsAreTheFalloffOfTheChord) {
    const Falloff falloff{Falloff::Shape::gaussian, 0.5f, 4.5f};
    for (const Projection projection : projections) {
        const Camera camera = camera_of(projection);
        const double radius_px = 0.6 * camera.focal_px;
        for (const glm::dvec3& toward :
             {direction(0.0, 0.0), direction(175.0, 12.0), direction(-60.0, 80.0), direction(100.0, -90.0)}) {
            const Image picture = one_splat(camera, toward, radius_px, falloff);
            double worst = 0.0;
            for (std::int64_t y = 0; y < high_px; ++y)
                for (std::int64_t x = 0; x < wide_px; ++x) {
                    const double x_px = double(x) + 0.5, y_px = double(y) + 0.5;
                    const double chord =
                        glm::length(ray_direction(camera, x_px, y_px) - toward) * camera.focal_px;
                    const double wanted =
                        shows(camera, x_px, y_px) ? 0.5 * falloff_value(falloff, chord / radius_px) : 0.0;
                    worst = std::max(worst, std::fabs(double(picture.at(x, y)[3]) - wanted));
                }
            EXPECT_LT(worst, 0.005) << name_of(projection) << ", " << toward.x << " " << toward.y << " "
                                    << toward.z;
        }
    }
}

constexpr Random random_share{11};

/// A cloud all around the eye: many sizes, some splats across every seam and pole.
ShadedSplats cloud_around(std::uint32_t count) {
    std::vector<OneSplat> splats;
    for (std::uint32_t n = 0; n < count; ++n) {
        const double height = 2.0 * random_share(n, 1) - 1.0, turn = 360.0 * random_share(n, 2);
        const float size = random_share(n, 3);
        OneSplat s;
        s.position = glm::vec3(direction(turn, real::degrees(real::asin(height)))) *
                     (2.0f + std::floor(random_share(n, 4) * 8.0f));
        s.radius = 0.01f + 1.5f * size * size * size * size * size;
        s.alpha = random_share(n, 5);
        s.color = {random_share(n, 6) * 1.5f, random_share(n, 7), random_share(n, 8)};
        splats.push_back(s);
    }
    return make_splats(splats);
}

class SphereCloud : public ::testing::TestWithParam<Projection> {
  protected:
    SphereCloud() {
        for (const Blend blend : {Blend::over, Blend::add, Blend::screen, Blend::absorb, Blend::lighten}) {
            RenderLayer layer = layer_of("layer", splats, blend, all_shapes[layers.size()]);
            layer.render.opacity = 0.3f;
            if (blend == Blend::add) layer.render.lod = {30.0f, 64, 0.0f};
            layers.push_back(layer);
        }
    }
    Image picture(const RenderSettings& settings = settings_of(wide_px, high_px)) const {
        return render(layers, camera, nullptr, settings).beauty;
    }

    ShadedSplats splats = cloud_around(1000);
    std::vector<RenderLayer> layers;
    Camera camera = wide_camera(GetParam());
};

TEST_P(SphereCloud, HasTheSameBitsHoweverThePictureIsMade) {
    expect_same_picture([&](const RenderSettings& settings) { return picture(settings); },
                        settings_of(wide_px, high_px), 200000, {{0, 31, 77, 60}, {401, 0, 111, 256}});
}

/// Tiles are narrower than a cell there, and the last ones than the others.
TEST(Sphere, NarrowTilesTakeWhatReachesAcrossTheSeam) {
    const ShadedSplats splats = cloud_around(300);
    for (const Projection projection : {Projection::equirectangular, Projection::cylindrical}) {
        RenderLayer layer = layer_of("cloud", splats, Blend::over, Falloff::Shape::gaussian);
        const Camera camera = make_camera(params_of(projection), 88, 44, {});
        RenderSettings settings = settings_of(88, 44);
        const auto picture = [&](int tile_px) {
            settings.tile_px = tile_px;
            return render({&layer, 1}, camera, nullptr, settings).beauty.pixels;
        };
        const auto whole = picture(128);
        for (const int tile_px : {16, 32, 64}) EXPECT_EQ(picture(tile_px) == whole, true) << tile_px;
    }
}

TEST(Sphere, HasNoSeam) {
    const ShadedSplats splats = cloud_around(3000);
    const RenderLayer layer = layer_of("cloud", splats, Blend::over, Falloff::Shape::gaussian);
    expect_no_seam(
        [&](const Camera& camera) {
            return render({&layer, 1}, camera, nullptr, settings_of(wide_px, high_px)).beauty;
        },
        0.01);
}

INSTANTIATE_TEST_SUITE_P(All, SphereCloud, ::testing::ValuesIn(projections));

TEST(Sphere, ANarrowFisheyeIsPerspective) { expect_narrow_fisheye_is_flat(glm::mat3(0.0f), 0.003); }

// Beyond the rim of a fisheye nothing is shown, not even the environment: alpha is 0.
TEST(Sphere, AFisheyeIsRound) {
    CameraParams params = params_of(Projection::fisheye);
    params.fisheye_fov = 180.0;
    const Camera camera = make_camera(params, high_px, high_px, {});
    const ShadedSplats splats = make_splats({{{1.0f, 1.0f, 0.2f}, 0.5f}});
    RenderLayer layer = layer_of("splat", splats);
    EnvironmentFaces faces(1, {make_image(4, 3, 3)});
    std::ranges::fill(faces[0][0].pixels, 0.25f);
    Environment environment;
    environment.faces = std::make_shared<const EnvironmentFaces>(std::move(faces));
    const Image picture = render({&layer, 1}, camera, &environment, settings_of(high_px, high_px)).beauty;
    for (std::int64_t y = 0; y < high_px; ++y)
        for (std::int64_t x = 0; x < high_px; ++x) {
            const double r = std::hypot(double(x) + 0.5 - 128.0, double(y) + 0.5 - 128.0);
            EXPECT_EQ(picture.at(x, y)[3], r <= 128.0 ? 1.0f : 0.0f) << x << ", " << y;
            if (r > 128.0) {
                EXPECT_EQ(picture.at(x, y)[0], 0.0f) << x << ", " << y;
            } else if (x < 64 && y > 128) {
                EXPECT_NEAR(picture.at(x, y)[0], 0.25f, 1e-6);
            }
        }
}

// On a level dome the target lies on the lower rim, what is above the eye in the middle.
TEST(Sphere, TiltedFisheyesAreDomes) {
    CameraParams params = params_of(Projection::fisheye);
    params.fisheye_fov = 180.0;
    params.fisheye_tilt = 90.0;
    const Camera camera = make_camera(params, high_px, high_px, {});
    const auto expect_at = [&](const glm::dvec3& toward, double x_px, double y_px) {
        const glm::dvec3 ray = ray_direction(camera, x_px, y_px);
        EXPECT_LT(glm::length(ray - toward), 1e-6) << x_px << ", " << y_px;
    };
    expect_at({0.0, 0.0, -1.0}, 128.0, 256.0);
    expect_at({0.0, 1.0, 0.0}, 128.0, 128.0);
    expect_at({1.0, 0.0, 0.0}, 256.0, 128.0);
}

}  // namespace
}  // namespace astrosplat
