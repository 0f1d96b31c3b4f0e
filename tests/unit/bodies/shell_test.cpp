// Shells: their walls, what lies on them and fills them, and flights near them.
#include "bodies/bodies.h"
#include "bodies/fields.h"
#include "bodies/placement.h"
#include "camera/camera.h"
#include "image/channels.h"
#include "render/render.h"
#include "support/painted_picture.h"
#include "support/test.h"
#include "unit/bodies/bodies_support.h"

namespace astrosplat {
namespace {

constexpr double middle_x = 320.0, middle_y = 200.0;

// Evenly bright inside of an ellipse in the middle, dark outside.
Image ellipse(double half_width, double half_height) {
    Image image = make_image(640, 400, 1);
    for (std::int64_t y = 0; y < image.height; ++y)
        for (std::int64_t x = 0; x < image.width; ++x)
            *image.at(x, y) = std::hypot((double(x) + 0.5 - middle_x) / half_width,
                                         (double(y) + 0.5 - middle_y) / half_height) < 1.0
                                  ? 0.5f
                                  : 0.0f;
    return image;
}

Image shell_of(const Image& brightest, double depth, double steepest) {
    return shell_field(brightest, balloon_of(brightest), depth, steepest);
}

TEST(Shell, OverAnEllipseIsAnEllipsoid) {
    for (const auto& [width, height] : {std::array{160.0, 160.0}, {240.0, 120.0}}) {
        const Image field = shell_of(ellipse(width, height), 60.0, 10.0);
        const double outline =
            width + 9.0;  // an eleventh of the light is left there after the blur of 6.7 px
        const auto at = [&](double share) {
            return double(bilinear(field, 0, float(middle_x + share * width), float(middle_y)));
        };
        for (const double share : {0.0, 0.3, 0.6, 0.8})
            EXPECT_NEAR(at(share),
                        60.0 * std::sqrt(1.0 - share * share * width * width / (outline * outline)), 3.0)
                << width << ' ' << share;
        EXPECT_LT(at(1.3), 6.0);
    }
}

TEST(Shell, IsNowhereTooSteepAndNothingOverNothing) {
    for (const double steepest : {0.8, 0.2}) {
        const Image field = shell_of(ellipse(100.0, 100.0), 90.0, steepest);
        float slope = 0.0f;
        for (std::int64_t y = 0; y < field.height; ++y)
            for (std::int64_t x = 0; x + 1 < field.width; ++x)
                slope = std::max(slope, std::fabs(*field.at(x + 1, y) - *field.at(x, y)));
        EXPECT_LE(slope, 1.03 * steepest);
        EXPECT_GT(slope, 0.5 * steepest);
    }
    const Image nothing = shell_of(make_image(320, 200, 1), 60.0, 0.8);
    EXPECT_EQ(*std::max_element(nothing.pixels.begin(), nothing.pixels.end()), 0.0f);
}

struct RemnantPlacement {
    Image brightest = brightest_channel(painted::remnant(640, 400));
    Placement placement;
    explicit RemnantPlacement(double clumps = 1.0) {
        StructureParams params = of_kind(StructureKind::walls);
        params.depth = 0.26;
        params.clumps = clumps;
        placement = make_placement(brightest, params, 64.0, true, 9u);
        placement.knots = {};
    }
};

// One would look through it into a hollow.
TEST(Shell, NoPartOfAWallIsBare) {
    const RemnantPlacement remnant;
    const BandSplats splats = band_splats(make_bands(640)[1], false, remnant.placement)[0];
    ASSERT_FALSE(splats.glow);
    for (std::uint32_t i = 0; i < 25; ++i) {
        const glm::vec2 about(220 + 50 * (i % 5), 120 + 40 * (i / 5));
        PlacedBlock block = splats_about(about, glm::vec2(8.0f), i);
        place(remnant.placement, splats, block);
        int in_front = 0;
        for (int k = 0; k < block.count; ++k) in_front += block.z[k] > 0.0f;
        EXPECT_GT(in_front, block.count / 12) << i;
        EXPECT_LT(in_front, block.count * 11 / 12) << i;
    }
}

TEST(Shell, GlowFillsItEvenly) {
    const RemnantPlacement remnant(0.0);  // without clouds
    const std::vector<Band> bands = make_bands(640);
    const BandSplats splats = band_splats(bands.back(), true, remnant.placement)[0];
    ASSERT_TRUE(splats.glow);
    std::array<int, 8> eighths{};
    for (std::uint32_t i = 0; i < 128; ++i) {
        PlacedBlock block = splats_about({320.0f, 200.0f}, glm::vec2(4.0f), i);
        place(remnant.placement, splats, block);
        for (int k = 0; k < block.count; ++k) {
            const float out = block.z[k] / remnant.placement.relief_at(block.x[k], block.y[k]);
            ASSERT_LT(std::fabs(out), 1.0f);
            ++eighths[std::size_t(4.0f * (out + 1.0f))];
        }
    }
    for (const int count : eighths) EXPECT_NEAR(count, 4096, 640);
}

// A piece nearly as wide as long is a ball at one place of one wall; a piece of a filament lies along the
// wall, or filaments would be strings of beads.
TEST(Shell, OnlyBallsAreKnots) {
    RemnantPlacement remnant;
    Placement& placement = remnant.placement;
    placement.knots = {640, 400, {{320.0f, 200.0f, 2.0f, 1.0f, 1.0f}}, {}, {}};
    placement.knots.owner.resize(640 * 400, 0);
    placement.knots.weight.resize(640 * 400, 1.0f);
    placement.knot_z = {0.0f};
    for (std::int64_t y = 0; y < placement.relief.height; ++y)
        for (std::int64_t x = 0; x < placement.relief.width; ++x)
            *placement.relief.at(x, y) = 40.0f + 0.5f * float(x - placement.relief.width / 2);
    const BandSplats splats = band_splats(make_bands(640)[0], false, placement)[0];
    for (const float ballness : {0.0f, 1.0f}) {
        placement.knots.knots[0].ballness = ballness;
        PlacedBlock block = splats_about({320.0f, 200.0f}, glm::vec2(12.0f), 1u);
        place(placement, splats, block);
        const auto [low, high] = std::minmax_element(block.z, block.z + block.count);
        if (ballness > 0.5f) {
            EXPECT_LT(*high - *low, 12.0f);
        } else {
            EXPECT_GT(*high - *low, 50.0f);  // on both walls
        }
    }
}

// Flights near the walls of a shell: no frame changes more than its neighbours do.

constexpr int frames = 12, flight_width = 96, flight_height = 60;

ShadedSplats remnant_bodies() {
    StructureParams params = of_kind(StructureKind::walls);
    params.depth = 0.26;
    SplatSet set = make_bodies({on_plane(painted::remnant(320, 200))}, params, 9u, "shell");
    ShadedSplats splats;
    splats.position = std::move(set.position);
    splats.color = std::move(set.color);
    splats.alpha = std::move(set.alpha);
    splats.radius = std::move(set.radius);
    splats.id = std::move(set.id);
    return splats;
}

/// Sum of |f_t - f_(t-1)| of every frame but the first, the eye going from `from` by `step` a frame.
std::vector<double> changes(const ShadedSplats& splats, const glm::dvec3& from, const glm::dvec3& step) {
    RenderLayer layer;
    layer.name = "shell";
    layer.splats = &splats;
    layer.render.lod.max_px = 250.0f;
    layer.render.lod.noise = 0.75f;
    RenderSettings settings;
    settings.width = flight_width;
    settings.height = flight_height;
    RenderCache cache;
    std::vector<double> found;
    Image before;
    for (int t = 0; t < frames; ++t) {
        CameraParams params;
        params.position = from + double(t) * step;
        params.target = *params.position + glm::dvec3(0.2, -1.0, -0.8);
        params.fov = 40.0;
        Image now = render({&layer, 1}, make_camera(params, flight_width, flight_height, {}), nullptr,
                           settings, {}, &cache)
                        .beauty;
        double sum = 0.0;
        for (std::size_t i = 0; t > 0 && i < now.pixels.size(); ++i)
            sum += std::fabs(double(now.pixels[i]) - double(before.pixels[i]));
        if (t > 0) found.push_back(sum);
        before = std::move(now);
    }
    return found;
}

TEST(ShellFlight, HasNeitherFlickerNorPops) {
    const ShadedSplats splats = remnant_bodies();
    for (const glm::dvec3& step : {glm::dvec3(0.01, -0.05, -0.04), glm::dvec3(0.05, 0.0, 0.0)}) {
        const std::vector<double> change = changes(splats, {0.0, 2.4, 1.9}, step);
        for (std::size_t t = 1; t + 1 < change.size(); ++t)
            EXPECT_LE(change[t], 1.05 * 0.5 * (change[t - 1] + change[t + 1])) << "frame " << t + 1;
    }
}

}  // namespace
}  // namespace astrosplat
