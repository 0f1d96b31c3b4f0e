// Pictures from the front keep their light and the colours of their edges.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analytic/support.h"
#include "core/color.h"
#include "core/real.h"
#include "scene/load.h"
#include "scene/new_scene.h"
#include "sets/load_source.h"

namespace astrosplat {
namespace {

// The first picture: what `astrosplat new` writes around an image shows, from the front, the image's own
// light.

using namespace astrosplat::analytic;

constexpr int galaxy_px = 128;

/// A two-armed spiral with a bright core and a bluish disc, linear light, without alpha of its own (1).
glm::vec4 galaxy(int x, int y) {
    const double dx = (x + 0.5) / galaxy_px - 0.5, dy = (y + 0.5) / galaxy_px - 0.5;
    const double r = std::sqrt(dx * dx + dy * dy), angle = std::atan2(dy, dx);
    const double arms = 0.5 + 0.5 * std::cos(2.0 * angle - 12.0 * std::sqrt(r));
    const double disc = 0.5 * std::exp(-r / 0.15) * arms, core = std::exp(-r * r / 0.003);
    return {std::min(1.0, 0.7 * disc + core), std::min(1.0, 0.8 * disc + 0.9 * core),
            std::min(1.0, disc + 0.7 * core), 1.0};
}

glm::dvec3 mean_light() {
    glm::dvec3 sum(0.0);
    for (int y = 0; y < galaxy_px; ++y)
        for (int x = 0; x < galaxy_px; ++x) sum += glm::dvec3(galaxy(x, y));
    return sum / static_cast<double>(galaxy_px * galaxy_px);
}

/// The scene as written, at a size for tests, with further assignments. The texture's alpha of 1 everywhere
/// is passed over for the brightness, as for a picture without alpha.
Scene first_scene(const TempFolder& folder, std::vector<Assignment> changes) {
    write_float_tiff(folder / "my galaxy.tif", galaxy_px, galaxy_px, galaxy);
    const std::string text = new_scene_text(folder / "my galaxy.tif", "plane", folder / "scene.toml");
    changes.push_back({"output.resolution", "[100, 100]"});
    changes.push_back({"layer.my_galaxy.source.count", "200000"});
    changes.push_back({"layer.my_galaxy.source.alpha", "max"});
    return parse_scene(text, folder / "scene.toml", changes);
}

TEST(FirstPicture, FrontViewHasTheLightOfTheImage) {
    const TempFolder folder;
    Pipeline pipeline(first_scene(
        folder,
        {{"camera.projection", "orthographic"}, {"camera.position", "[0, 20, 0]"}, {"camera.height", "10"}}));
    const glm::dvec4 seen = mean(render_frame(pipeline).beauty);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k] / mean_light()[k], 1.0, 0.05) << "channel " << k;
}

// Without a camera: the whole plane, nothing cut off, the core bright but not beyond the image's own white,
// and less light on the whole than the image, since the plane is seen from 35 degrees and fills the frame in
// part.
TEST(FirstPicture, FramesTheWholePlaneBrightEnoughToSee) {
    const TempFolder folder;
    Pipeline pipeline(first_scene(folder, {}));
    const Image image = render_frame(pipeline).beauty;
    const double core = std::max({image.at(49, 49)[0], image.at(50, 50)[0], image.at(49, 50)[0]});
    EXPECT_GT(core, 0.5);
    EXPECT_LE(core, 1.0);
    EXPECT_GT(mean(image).g, 0.15 * mean_light().g);
    EXPECT_LT(mean(image).g, mean_light().g);
    for (std::int64_t i = 0; i < 100; ++i) {  // nothing is cut off
        EXPECT_EQ(image.at(i, 0)[3], 0.0f);
        EXPECT_EQ(image.at(i, 99)[3], 0.0f);
        EXPECT_EQ(image.at(0, i)[3], 0.0f);
        EXPECT_EQ(image.at(99, i)[3], 0.0f);
    }
}

// Pictures with soft edges keep their colour on the whole way: no dark rims from filtering, dividing or
// blending.

const glm::vec3 stored(1.0f, 0.6f, 0.2f);  // sRGB, multiples of 1/255
constexpr int disc_px = 32;

/// A bright disc that fades out over half its radius. Empty texels are black, as painting programs write
/// them.
glm::vec4 soft_disc(int x, int y) {
    const double dx = x - 15.5, dy = y - 15.5;
    const double alpha = std::clamp((14.0 - std::sqrt(dx * dx + dy * dy)) / 7.0, 0.0, 1.0);
    return alpha < 1.0 / 255.0 ? glm::vec4(0.0f) : glm::vec4(stored, alpha);
}

glm::vec3 linear_color() {
    return {real::srgb_to_linear(stored.r), real::srgb_to_linear(stored.g), real::srgb_to_linear(stored.b)};
}

std::string disc_scene(const char* filter, const char* blend, const std::string& output = "") {
    return fmt::format(R"(astrosplat = 1
[output]
resolution = [64, 64]
frames = "1"
{}
[camera]
projection = "orthographic"
position = [0, 20, 0]
height = 10.0
[[layer]]
name = "disc"
[layer.source]
meshes = [ {{ mesh = "plane", texture = "disc.png" }} ]
count = 100000
filter = "{}"
[layer.render]
blend = "{}"
)",
                       output, filter, blend);
}

TEST(SoftEdge, EverySplatHasTheColourOfThePicture) {
    const TempFolder folder;
    write_png(folder / "disc.png", disc_px, disc_px, soft_disc);
    for (const char* filter : {"nearest", "bilinear", "area"}) {
        const Scene scene = scene_of(folder, disc_scene(filter, "over"));
        const SplatSet set = load_source(scene.layers[0].source, "disc");
        ASSERT_GT(set.size(), 30000) << filter;
        EXPECT_GT(set.zero_alpha, 10000) << filter;
        float faintest = 1.0f, error = 0.0f;
        for (std::int64_t i = 0; i < set.size(); ++i) {
            faintest = std::min(faintest, set.alpha[i]);
            for (int k = 0; k < 3; ++k)
                error = std::max(error, std::fabs(set.color[i][k] / linear_color()[k] - 1.0f));
        }
        EXPECT_GT(faintest, 0.0f) << filter;
        EXPECT_LT(faintest, 0.02f) << filter;
        EXPECT_LT(error, 2e-6f) << filter;
    }
}

TEST(SoftEdge, RenderedPictureKeepsTheHue) {
    const TempFolder folder;
    write_png(folder / "disc.png", disc_px, disc_px, soft_disc);
    const Image over = render_text(folder, disc_scene("bilinear", "over")).beauty;
    int soft = 0;
    for (std::int64_t y = 0; y < 64; ++y) {
        for (std::int64_t x = 0; x < 64; ++x) {
            const float* p = over.at(x, y);
            if (!(p[3] > 1e-4f)) continue;
            soft += p[3] < 0.9f;
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(p[k] / p[3], linear_color()[k], 1e-4f) << x << " " << y;
        }
    }
    EXPECT_GT(soft, 500);
}

TEST(SoftEdge, StraightPngKeepsTheStoredColour) {
    const TempFolder folder;
    write_png(folder / "disc.png", disc_px, disc_px, soft_disc);
    const StoredFile file = read_stored_file(
        write_text(folder, disc_scene("bilinear", "over", "path = \"out.png\"\nalpha = \"straight\"")));
    int soft = 0;
    for (std::int64_t y = 0; y < 64; ++y) {
        for (std::int64_t x = 0; x < 64; ++x) {
            const float alpha = file.at("A", x, y);
            if (alpha < 0.02f) continue;
            soft += alpha < 0.9f;
            EXPECT_NEAR(file.at("R", x, y), stored.r, 1.01f / 255.0f) << x << " " << y;
            EXPECT_NEAR(file.at("G", x, y), stored.g, 1.01f / 255.0f) << x << " " << y;
            EXPECT_NEAR(file.at("B", x, y), stored.b, 1.01f / 255.0f) << x << " " << y;
        }
    }
    EXPECT_GT(soft, 500);
}

}  // namespace
}  // namespace astrosplat
