// Splats that are not round, through the whole renderer: light at every size, place and orientation, the
// profile against a convolution done by brute force, and the same bits for every tile size and number of
// threads.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/matrix.hpp>
#include <ostream>

#include "core/real.h"
#include "core/rotation.h"
#include "core/shared_maths.h"
#include "render/shape.h"
#include "support/printing.h"
#include "unit/render/scenes.h"

namespace astrosplat {
namespace {

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
    const auto size = static_cast<double>(size_px);
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
        const auto size = static_cast<std::int64_t>(4.6 * larger) + 32;
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

TEST(Ellipse, ABallIsADiscAlsoBesideTheAxis) {
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

float drawn(std::uint32_t n, std::uint32_t purpose) {
    return shared::as_uniform(shared::as_hash(11u, n, 0u, purpose));
}

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

// The light of round splats beside black ones that are not, too faint to hide anything.
TEST(Ellipse, RoundSplatsKeepTheirBitsBesideOthers) {
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

}  // namespace
}  // namespace astrosplat
