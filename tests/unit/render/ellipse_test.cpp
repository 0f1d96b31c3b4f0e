// Splats that are not round, through the whole renderer: on the plane and onto the sphere.
#include <glm/matrix.hpp>

#include "core/rotation.h"
#include "render/footprint.h"
#include "render/shape.h"
#include "render/sphere_shape.h"
#include "support/printing.h"
#include "support/test.h"
#include "unit/render/scenes.h"
#include "unit/render/sphere_scenes.h"

namespace astrosplat {
namespace {

// Splats that are not round, through the whole renderer: light at every size, place and orientation, the
// profile against a convolution done by brute force, and the same bits for every tile size and
// number of threads.

using namespace astrosplat::test;

/// Columns: the unit ball's axes. Radii along x, y and z, turned by `degrees` about z.
glm::mat3 ellipsoid(double larger, double smaller, double degrees) {
    const double c = real::cos(real::radians(degrees)), s = real::sin(real::radians(degrees));
    return glm::mat3(glm::dmat3(c * larger, s * larger, 0.0, -s * smaller, c * smaller, 0.0, 0.0, 0.0, 1.0));
}

struct EllipseCase {
    double larger_px, smaller_px, degrees;
    glm::dvec2 offset_px;
};
void PrintTo(const EllipseCase& e, std::ostream* out) {
    *out << e.larger_px << " x " << e.smaller_px << " px at " << e.degrees << " degrees, offset "
         << e.offset_px.x << ", " << e.offset_px.y;
}

/// One ellipse of alpha 1/2 in an orthographic picture of one unit a pixel. Many of one falloff have a cache
/// for its tables.
Image ellipse_picture(const EllipseCase& e, const Falloff& falloff, std::int64_t size_px, int tile_px = 0,
                      RenderCache* tables = nullptr) {
    ShadedSplats splats = make_splats({{glm::vec3(e.offset_px.x, e.offset_px.y, 0.0f), 1.0f, 0.5f}});
    splats.stretch.push_back(ellipsoid(e.larger_px, e.smaller_px, e.degrees));
    RenderLayer layer = layer_of("ellipse", splats);
    layer.render.falloff = falloff;
    RenderSettings settings = settings_of(size_px, size_px);
    settings.tile_px = tile_px;
    const auto size = double(size_px);
    return render({&layer, 1}, pixel_camera(size, size), nullptr, settings, {}, tables).beauty;
}

class EllipseLight : public ::testing::TestWithParam<Falloff::Shape> {};

TEST_P(EllipseLight, IsConservedAtEverySizePlaceAndOrientation) {
    const Falloff falloff{GetParam(), 0.5f, 4.5f};
    const double integral = falloff_integral(falloff);
    RenderCache tables;
    double worst = 0.0;
    for (const auto& [larger, smaller] : std::vector<std::pair<double, double>>{{0.02, 0.004},
                                                                                {0.3, 0.02},
                                                                                {0.7, 0.7},
                                                                                {1.0, 0.3},
                                                                                {2.2, 1.1},
                                                                                {3.0, 0.05},
                                                                                {6.0, 2.3},
                                                                                {9.0, 0.6},
                                                                                {24.0, 20.0},
                                                                                {40.0, 0.01},
                                                                                {40.0, 3.0},
                                                                                {230.0, 0.5},
                                                                                {230.0, 90.0}}) {
        const auto size = std::int64_t(4.6 * larger) + 32;
        for (const double degrees : {0.0, 3.0, 45.0, 117.0})
            for (const glm::dvec2 offset : {glm::dvec2(0.0), glm::dvec2(0.29, 0.77)}) {
                if (larger > 100.0 && degrees != 3.0) continue;
                const EllipseCase e{larger, smaller, degrees, offset};
                const double wanted = 0.5 * integral * larger * smaller;
                const double error = total(ellipse_picture(e, falloff, size, 0, &tables), 3) / wanted - 1.0;
                worst = std::max(worst, std::fabs(error));
                EXPECT_NEAR(error, 0.0, 0.005) << ::testing::PrintToString(e);
            }
    }
    RecordProperty("worst", std::to_string(worst));
}

INSTANTIATE_TEST_SUITE_P(AllFalloffs, EllipseLight, ::testing::ValuesIn(all_shapes));

/// The falloff over an ellipse convolved with the Gaussian pixel filter, at (x, y) px from its centre.
double convolved(const Falloff& falloff, const EllipseCase& e, double sigma, double x, double y) {
    constexpr int steps = 120;
    const glm::dmat2 to_disc =
        glm::inverse(glm::dmat2(glm::mat2(ellipsoid(e.larger_px, e.smaller_px, e.degrees))));
    double sum = 0.0, mass = 0.0;
    for (int j = 0; j < steps; ++j)
        for (int i = 0; i < steps; ++i) {
            const glm::dvec2 u((i + 0.5) * 8.0 / steps - 4.0, (j + 0.5) * 8.0 / steps - 4.0);
            const double g = std::exp(-0.5 * (u.x * u.x + u.y * u.y));
            const glm::dvec2 p = to_disc * (glm::dvec2(x, y) + sigma * u);
            sum += g * falloff_value(falloff, std::sqrt(p.x * p.x + p.y * p.y));
            mass += g;
        }
    return sum / mass;
}

/// Largest difference of a picture's alpha from half the convolution, over every third pixel.
double largest_difference(const EllipseCase& e, const Falloff& falloff) {
    constexpr std::int64_t size = 48;
    const Image picture = ellipse_picture(e, falloff, size);
    double worst = 0.0;
    for (std::int64_t y = 0; y < size; y += 3)
        for (std::int64_t x = 0; x < size; x += 3) {
            const double dx = double(x) + 0.5 - 24.0 - e.offset_px.x,
                         dy = 24.0 + -double(y) - 0.5 - e.offset_px.y;
            const double wanted = 0.5 * convolved(falloff, e, 0.5, dx, dy);
            worst = std::max(worst, std::fabs(double(picture.at(x, y)[3]) - wanted));
        }
    return worst;
}

// A flat core stays 1 and the edge makes up for the light. Without one, scaling the edge could take more
// light from it than it has.
TEST(Ellipse, IsScaledAtItsEdgeOrWithoutAFlatCoreAsAWhole) {
    const Falloff constant{Falloff::Shape::constant, 0.5f, 4.5f};
    int as_a_whole = 0, narrowed = 0;
    for (float smaller = 0.3f; smaller < 4.0f; smaller *= 1.05f)
        for (const float ratio : {1.0f, 1.5f, 3.0f, 10.0f}) {
            const Shape shape{smaller * ratio, 0.0f, 0.0f, smaller};
            FootprintTable table = begin_footprint_table(constant, 0.5f);
            const NodeRange nodes = node_range(shape);
            make_footprint_nodes(table, nodes.least_px, nodes.largest_px);
            const ShapedFootprint f = shaped_footprint_at(table, shape, 0.25f, 0.5f);
            if (f.round.amplitude < 1.0f) ++as_a_whole;
            if (f.round.edge_gain < 0.0f) ++narrowed;
            EXPECT_TRUE(f.round.lo == 0.0f || f.round.amplitude == 1.0f) << smaller << " x " << ratio;
            EXPECT_TRUE(f.round.lo > 0.0f || f.round.edge_gain >= 0.0f) << smaller << " x " << ratio;
        }
    EXPECT_GT(as_a_whole, 0);
    EXPECT_GT(narrowed, 0);
}

// A gaussian stays one under the filter; the profile of the others is softer at the tips.
TEST(Ellipse, IsTheConvolution) {
    const Falloff gaussian{Falloff::Shape::gaussian, 0.5f, 4.5f}, linear{Falloff::Shape::linear, 0.5f, 4.5f};
    for (const EllipseCase& e :
         {EllipseCase{15.0, 5.0, 30.0, {0.25, 0.5}}, EllipseCase{12.0, 1.0, 72.0, {0.0, 0.3}},
          EllipseCase{8.0, 0.4, 0.0, {0.4, 0.4}}, EllipseCase{3.0, 2.0, 140.0, {0.0, 0.0}}}) {
        EXPECT_LT(largest_difference(e, gaussian), 0.01) << ::testing::PrintToString(e);
        EXPECT_LT(largest_difference(e, linear), 0.04) << ::testing::PrintToString(e);
    }
}

TEST(Ellipse, ABallIsADiscAlsoOffTheAxis) {
    Camera camera;
    camera.focal_px = 60.0;
    camera.center_x_px = camera.center_y_px = 32.0;
    ShadedSplats round = make_splats({{{3.0f, 2.0f, -10.0f}, 1.5f, 0.5f}});
    RenderLayer layer = layer_of("ball", round, Blend::over, Falloff::Shape::gaussian);
    const Image disc = render({&layer, 1}, camera, nullptr, settings_of(64, 64)).beauty;
    round.stretch.push_back(glm::mat3(rotation_from_degrees({20.0, 50.0, 70.0})));
    const Image ball = render({&layer, 1}, camera, nullptr, settings_of(64, 64)).beauty;
    for (std::size_t i = 0; i < disc.pixels.size(); ++i)
        EXPECT_NEAR(disc.pixels[i], ball.pixels[i], 2e-4) << i;
}

constexpr Random drawn{11};

/// Two layers seen in perspective: round splats and ellipsoids of all sizes.
struct EllipseScene {
    ShadedSplats round, stretched;
    std::vector<RenderLayer> layers;
    Camera camera;

    EllipseScene(Blend blend, Falloff::Shape shape) {
        for (ShadedSplats* set : {&round, &stretched}) {
            std::vector<OneSplat> splats;
            for (std::uint32_t i = 0; i < 600; ++i) {
                const std::uint32_t n = i + (set == &round ? 0u : 5000u);
                const float size = drawn(n, 5);
                splats.push_back({{drawn(n, 1) * 8.0f - 4.0f, drawn(n, 2) * 6.0f - 3.0f, drawn(n, 3) * 6.0f},
                                  0.01f + 1.5f * size * size * size * size,
                                  drawn(n, 4),
                                  {drawn(n, 6), drawn(n, 7), drawn(n, 8)}});
            }
            *set = make_splats(splats);
        }
        for (std::uint32_t i = 0; i < 600; ++i)
            stretched.stretch.push_back(
                glm::mat3(rotation_from_degrees({360.0 * drawn(i, 20), 360.0 * drawn(i, 21), 0.0})) *
                ellipsoid(1.0, 0.02 + drawn(i, 22), 30.0));
        layers = {layer_of("round", round, Blend::over, Falloff::Shape::gaussian),
                  layer_of("stretched", stretched, blend, shape)};
        camera.eye = {0.0, 0.0, 9.0};
        camera.focal_px = 130.0;
        camera.center_x_px = 90.5;
        camera.center_y_px = 60.5;
    }
    Image picture(RenderSettings settings = settings_of(181, 121)) const {
        return render(layers, camera, nullptr, settings).beauty;
    }
};

class EllipseBits : public ::testing::TestWithParam<std::pair<Blend, Falloff::Shape>> {};

TEST_P(EllipseBits, AreTheSameHoweverThePictureIsMade) {
    const EllipseScene scene(GetParam().first, GetParam().second);
    expect_same_picture([&](const RenderSettings& settings) { return scene.picture(settings); },
                        settings_of(181, 121), 60000, {{37, 21, 90, 71}});
}

INSTANTIATE_TEST_SUITE_P(SomeBlends, EllipseBits,
                         ::testing::Values(std::pair{Blend::over, Falloff::Shape::gaussian},
                                           std::pair{Blend::add, Falloff::Shape::constant},
                                           std::pair{Blend::screen, Falloff::Shape::linear},
                                           std::pair{Blend::lighten, Falloff::Shape::trapezoid}));

// The light of round splats among black ones that are not, too faint to hide anything.
TEST(Ellipse, RoundSplatsKeepTheirBitsAmongOthers) {
    for (const Falloff::Shape shape : all_shapes)
        for (const Blend blend : {Blend::over, Blend::add, Blend::screen}) {
            EllipseScene scene(blend, Falloff::Shape::gaussian);
            scene.layers[0].render.falloff.shape = shape;
            scene.layers[0].render.blend = blend;
            scene.layers[1].render.opacity = 1e-30f;
            for (glm::vec3& color : scene.stretched.color) color = glm::vec3(0.0f);
            const Image both = scene.picture();
            scene.layers.pop_back();
            const Image alone = scene.picture();
            for (std::size_t i = 0; i < alone.pixels.size(); i += 4)
                for (std::size_t k = i; k < i + 3; ++k) ASSERT_EQ(both.pixels[k], alone.pixels[k]) << k;
        }
}

// Splats that are not round, onto the sphere, through the whole renderer: light, second moments and pixels
// against sums over the sphere by brute force, at poles, seams and rims as anywhere.

constexpr double distance = 7.0;

/// An ellipse in a direction: its radii in px of the middle of the frame, and by how much the larger one is
/// turned from the east to the north.
struct SphereEllipse {
    double larger_px, smaller_px, degrees, longitude, latitude;
};
void PrintTo(const SphereEllipse& e, std::ostream* out) {
    *out << e.larger_px << " x " << e.smaller_px << " px at " << e.degrees << " degrees, longitude "
         << e.longitude << ", latitude " << e.latitude;
}

/// The directions of both radii.
struct Axes {
    glm::dvec3 toward, larger, smaller;
};
Axes axes_of(const SphereEllipse& e) {
    const glm::dvec3 toward = direction(e.longitude, e.latitude), east = direction(e.longitude + 90.0, 0.0),
                     north = direction(e.longitude, e.latitude + 90.0);
    const double c = real::cos(real::radians(e.degrees)), s = real::sin(real::radians(e.degrees));
    return {toward, c * east + s * north, c * north - s * east};
}

/// One of alpha 1/2, whose depth along the line of sight must not matter.
ShadedSplats ellipse_splats(const Camera& camera, const SphereEllipse& e) {
    const Axes axes = axes_of(e);
    const double per_px = distance / camera.focal_px;
    ShadedSplats splats = make_splats({{glm::vec3(distance * axes.toward), 1.0f, 0.5f}});
    splats.stretch.push_back(
        glm::mat3(glm::dmat3(e.larger_px * per_px * axes.larger, 0.3 * e.smaller_px * per_px * axes.toward,
                             e.smaller_px * per_px * axes.smaller)));
    return splats;
}

/// Many of one falloff have a cache for its tables.
Image ellipse_picture(const Camera& camera, const SphereEllipse& e, const Falloff& falloff,
                      RenderCache* tables = nullptr) {
    const ShadedSplats splats = ellipse_splats(camera, e);
    RenderLayer layer = layer_of("ellipse", splats);
    layer.render.falloff = falloff;
    return render({&layer, 1}, camera, nullptr, settings_of(wide_px, high_px), {}, tables).beauty;
}

/// Where a direction is on Lambert's equal-area map around the ellipse, along both radii, px.
glm::dvec2 on_map(const Camera& camera, const Axes& axes, const glm::dvec3& ray) {
    const double half_cosine = std::sqrt(std::fmax(0.5 * (1.0 + glm::dot(ray, axes.toward)), 1e-12));
    return camera.focal_px / half_cosine *
           glm::dvec2(glm::dot(ray, axes.larger), glm::dot(ray, axes.smaller));
}

bool ellipse_fits(const Camera& camera, const SphereEllipse& e) {
    return fits(camera, e.latitude, 2.0 * real::degrees(e.larger_px / camera.focal_px));
}

class SphereEllipseLight : public ::testing::TestWithParam<SphereCase> {};

// Also of needles that follow a row or column of pixels for a while, where those of a plane's lattice add up.
TEST_P(SphereEllipseLight, IsConservedAtEveryPlaceSizeAndOrientation) {
    const Camera camera = camera_of(GetParam().projection);
    const Falloff falloff{GetParam().shape, 0.5f, 4.5f};
    const double integral = falloff_integral(falloff);
    const std::vector<double> angles = solid_angles(camera);
    RenderCache tables;
    double worst = 0.0;
    for (const auto& [larger, smaller] :
         {std::pair{30.0, 0.5}, {3.0, 0.05}, {9.0, 2.0}, {1.3, 0.8}, {40.0, 12.0}})
        for (const glm::dvec3& place : {glm::dvec3(0.0, 0.1, 20.0),
                                        {0.0, -120.9, 90.0},
                                        {-33.3, 180.0, 0.0},
                                        {61.7, 180.0, 0.0},
                                        {61.7, -120.9, 90.0},
                                        {87.1, 180.0, 0.0},
                                        {87.1, -120.9, 90.0},
                                        {-89.3, 180.0, 0.0},
                                        {90.0, 0.1, 20.0}}) {
            const SphereEllipse e{larger, smaller, place.z, place.y, place.x};
            if (larger > 0.9 * camera.focal_px || !ellipse_fits(camera, e)) continue;
            const double wanted = 0.5 * integral * larger * smaller;
            const double error =
                light_on_sphere(ellipse_picture(camera, e, falloff, &tables), angles, 3) / wanted - 1.0;
            worst = std::max(worst, std::fabs(error));
            EXPECT_NEAR(error, 0.0, 0.005) << ::testing::PrintToString(e);
        }
    RecordProperty("worst", std::to_string(worst));
}

INSTANTIATE_TEST_SUITE_P(All, SphereEllipseLight, ::testing::ValuesIn(sphere_cases()));

// Anywhere, of any size and direction, also around poles and rims.
TEST(SphereEllipseNightly, LightIsRightOfManyAtRandom) {
    const auto share = [](std::uint32_t n, std::uint32_t purpose) { return double(Random{29}(n, purpose)); };
    for (const Projection projection : projections) {
        const Camera camera = camera_of(projection);
        const std::vector<double> angles = solid_angles(camera);
        RenderCache tables;
        double worst = 0.0;
        for (std::uint32_t n = 0; n < 1500; ++n) {
            const double larger = 40.0 * std::exp(-5.0 * share(n, 1));
            SphereEllipse e{larger, larger * std::exp(-5.0 * share(n, 2)), 180.0 * share(n, 3),
                            360.0 * share(n, 4) - 180.0, real::degrees(real::asin(2.0 * share(n, 5) - 1.0))};
            if (n % 3 == 0) e.latitude = 90.0 - 8.0 * share(n, 5) * share(n, 5);
            if (n % 3 == 1) e.degrees = 90.0 * std::floor(4.0 * share(n, 3));
            if (larger > 0.7 * camera.focal_px || !ellipse_fits(camera, e)) continue;
            const Falloff falloff{all_shapes[n % all_shapes.size()], 0.5f, 4.5f};
            const double wanted = 0.5 * falloff_integral(falloff) * e.larger_px * e.smaller_px;
            const double error =
                light_on_sphere(ellipse_picture(camera, e, falloff, &tables), angles, 3) / wanted - 1.0;
            worst = std::max(worst, std::fabs(error));
            EXPECT_NEAR(error, 0.0, 0.005) << name_of(projection) << ", " << ::testing::PrintToString(e)
                                           << ", " << name_of(falloff.shape);
        }
        RecordProperty(std::string(name_of(projection)), std::to_string(worst));
    }
}

// Its own and the pixel filter's together, over solid angles.
TEST(SphereEllipse, HasItsSecondMomentsOnTheEqualAreaMap) {
    const Falloff falloff{Falloff::Shape::gaussian, 0.5f, 4.5f};
    const double variance = begin_footprint_table(falloff, 0.5f).variance, filter = 0.25;
    double worst = 0.0;
    for (const Projection projection : projections) {
        const Camera camera = camera_of(projection);
        const std::vector<double> angles = solid_angles(camera);
        RenderCache tables;
        for (const auto& [larger, smaller] :
             {std::pair{12.0, 3.0}, std::pair{6.0, 0.2}, std::pair{25.0, 6.0}, std::pair{1.5, 1.0}})
            for (const double latitude : {0.0, 25.0, -71.0, 88.0, -90.0})
                for (const auto& [longitude, degrees] : {std::pair{10.3, 35.0}, std::pair{-179.8, 110.0}}) {
                    const SphereEllipse e{larger, smaller, degrees, longitude, latitude};
                    if (larger > 0.6 * camera.focal_px || !ellipse_fits(camera, e)) continue;
                    // A pole's few rows show how much light, not how wide.
                    if (smaller < 3.0 && std::fabs(latitude) > 80.0) continue;
                    const Axes axes = axes_of(e);
                    const Image picture = ellipse_picture(camera, e, falloff, &tables);
                    glm::dvec3 sum(0.0);  // xx, xy, yy
                    double light = 0.0;
                    for (std::int64_t y = 0; y < high_px; ++y)
                        for (std::int64_t x = 0; x < wide_px; ++x) {
                            const double alpha = picture.at(x, y)[3];
                            if (!(alpha > 0.0)) continue;
                            const double share = alpha * angles[std::size_t(y * wide_px + x)];
                            const glm::dvec2 at =
                                on_map(camera, axes, ray_direction(camera, double(x) + 0.5, double(y) + 0.5));
                            sum += share * glm::dvec3(at.x * at.x, at.x * at.y, at.y * at.y);
                            light += share;
                        }
                    sum /= light;
                    const double xx = variance * larger * larger + filter,
                                 yy = variance * smaller * smaller + filter;
                    const double error = std::max({std::fabs(sum.x / xx - 1.0), std::fabs(sum.z / yy - 1.0),
                                                   std::fabs(sum.y) / std::sqrt(xx * yy)});
                    worst = std::max(worst, error);
                    EXPECT_LT(error, 0.015) << name_of(projection) << ", " << ::testing::PrintToString(e);
                }
    }
    RecordProperty("worst", std::to_string(worst));
}

// So wide that the pixel filter does not matter: each pixel is the falloff of its place on the map, also
// round the seam, over the poles and behind a fisheye.
TEST(SphereEllipse, PixelsAreTheFalloffOnTheEqualAreaMap) {
    const Falloff falloff{Falloff::Shape::gaussian, 0.5f, 4.5f};
    for (const Projection projection : projections) {
        const Camera camera = camera_of(projection);
        for (const SphereEllipse& e : {SphereEllipse{0.9, 0.3, 30.0, 0.0, 0.0},
                                       {0.6, 0.4, 80.0, 179.0, 20.0},
                                       {0.8, 0.3, 0.0, -60.0, 80.0},
                                       {0.9, 0.5, 50.0, 100.0, -90.0}}) {
            SphereEllipse wide = e;
            wide.larger_px *= camera.focal_px;
            wide.smaller_px *= camera.focal_px;
            if (projection == Projection::cylindrical && std::fabs(e.latitude) > 85.0) continue;
            const Axes axes = axes_of(wide);
            const Image picture = ellipse_picture(camera, wide, falloff);
            double worst = 0.0;
            for (std::int64_t y = 0; y < high_px; ++y)
                for (std::int64_t x = 0; x < wide_px; ++x) {
                    const double x_px = double(x) + 0.5, y_px = double(y) + 0.5;
                    glm::dvec2 at = on_map(camera, axes, ray_direction(camera, x_px, y_px));
                    at /= glm::dvec2(wide.larger_px, wide.smaller_px);
                    const double wanted = shows(camera, x_px, y_px)
                                              ? 0.5 * falloff_value(falloff, std::sqrt(glm::dot(at, at)))
                                              : 0.0;
                    worst = std::max(worst, std::fabs(double(picture.at(x, y)[3]) - wanted));
                }
            EXPECT_LT(worst, 0.005) << name_of(projection) << ", " << ::testing::PrintToString(wide);
        }
    }
}

TEST(SphereEllipse, ABallIsADisc) {
    const Falloff falloff{Falloff::Shape::gaussian, 0.5f, 4.5f};
    for (const Projection projection : projections) {
        const Camera camera = camera_of(projection);
        for (const double latitude : {10.0, -35.0, 89.0}) {
            const double radius = 0.1 * distance;
            ShadedSplats splats =
                make_splats({{glm::vec3(distance * direction(170.0, latitude)), float(radius), 0.5f}});
            RenderLayer layer = layer_of("ball", splats);
            layer.render.falloff = falloff;
            const Image disc = render({&layer, 1}, camera, nullptr, settings_of(wide_px, high_px)).beauty;
            splats.stretch.push_back(glm::mat3(rotation_from_degrees({20.0, 50.0, 70.0})));
            const Image ball = render({&layer, 1}, camera, nullptr, settings_of(wide_px, high_px)).beauty;
            for (std::size_t i = 0; i < disc.pixels.size(); ++i)
                ASSERT_NEAR(disc.pixels[i], ball.pixels[i], 3e-4) << name_of(projection) << " " << i;
        }
    }
}

// Points, threads as long as the sky and what is wider than it, also at poles and rims.
TEST(SphereEllipse, OddOnesAreFinite) {
    const Falloff falloff{Falloff::Shape::gaussian, 0.5f, 4.5f};
    for (const Projection projection : projections)
        for (const auto& [larger, smaller] :
             {std::pair{0.0, 0.0}, {1e-9, 1e-12}, {1e7, 0.0}, {1e7, 1e-9}, {300.0, 200.0}, {1e12, 1e12}})
            for (const double latitude : {0.0, 90.0, -89.999}) {
                const SphereEllipse e{larger, smaller, 40.0, 180.0, latitude};
                const Image picture = ellipse_picture(camera_of(projection), e, falloff);
                for (const float value : picture.pixels)
                    ASSERT_TRUE(value >= 0.0f && value <= 1.0f)
                        << name_of(projection) << ", " << ::testing::PrintToString(e);
                if (larger < 1e-6) {
                    EXPECT_LT(total(picture, 3), 1e-6) << name_of(projection) << " " << latitude;
                }
            }
}

// An eye off the middle sees it elsewhere, but no other way.
TEST(SphereEllipse, StereoPanoramasOnlyMoveIt) {
    const Falloff falloff{Falloff::Shape::gaussian, 0.5f, 4.5f};
    Camera camera = camera_of(Projection::equirectangular);
    const SphereEllipse e{20.0, 3.0, 35.0, 40.0, 50.0};
    const Image middle = ellipse_picture(camera, e, falloff);
    constexpr std::int64_t moved_px = 24;
    camera.parallax = distance * real::sin(double(moved_px) / camera.focal_px);
    const Image aside = ellipse_picture(camera, e, falloff);
    EXPECT_GT(total(middle, 3), 10.0);
    for (std::int64_t y = 0; y < high_px; ++y)
        for (std::int64_t x = 0; x < wide_px; ++x)
            ASSERT_NEAR(aside.at((x + moved_px) % wide_px, y)[3], middle.at(x, y)[3], 0.003)
                << x << ", " << y;
}

TEST(SphereEllipse, ANarrowFisheyeIsPerspective) {
    glm::mat3 stretch = glm::mat3(rotation_from_degrees({20.0, 50.0, 70.0}));
    stretch[1] *= 0.1f;
    expect_narrow_fisheye_is_flat(stretch, 0.004);
}

// A projection without formulas of its own has these differences, so they must be right where
// there are formulas.
TEST(SphereAxes, DifferencesAreTheFormulas) {
    for (const Projection projection : projections) {
        const Lens lens = make_lens(camera_of(projection));
        for (const glm::dvec2& place : {glm::dvec2(300.0, 128.0), {200.5, 90.0}, {280.0, 180.25}}) {
            const SphereAxes exact = sphere_axes(lens, place.x, place.y),
                             differences = sphere_axes_by_differences(lens, place.x, place.y);
            // Both pairs of axes span one plane; the formulas', turned onto the other pair.
            const double c = glm::dot(exact.first, differences.first),
                         s = glm::dot(exact.second, differences.first);
            EXPECT_NEAR(c * c + s * s, 1.0, 1e-6);
            const auto expect_near = [&](const glm::dvec2& a, const glm::dvec2& b) {
                EXPECT_NEAR(a.x, b.x, 1e-5) << name_of(projection) << " at " << place.x << ", " << place.y;
                EXPECT_NEAR(a.y, b.y, 1e-5) << name_of(projection) << " at " << place.x << ", " << place.y;
            };
            expect_near(c * exact.first_px + s * exact.second_px, differences.first_px);
            expect_near(c * exact.second_px - s * exact.first_px, differences.second_px);
            const auto along = [&](const glm::dvec3& bend, double x, double y) {
                return x * x * bend[0] + 2.0 * x * y * bend[1] + y * y * bend[2];
            };
            for (const double t : {0.0, 0.7, 2.0}) {
                const double x = real::cos(t), y = real::sin(t);
                expect_near({along(exact.bend_x, c * x - s * y, s * x + c * y),
                             along(exact.bend_y, c * x - s * y, s * x + c * y)},
                            {along(differences.bend_x, x, y), along(differences.bend_y, x, y)});
            }
        }
    }
}

}  // namespace
}  // namespace astrosplat
