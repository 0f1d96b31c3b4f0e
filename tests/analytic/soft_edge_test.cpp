// Pictures with soft edges keep their colour on the whole way: no dark rims from filtering, dividing or
// blending.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analytic/support.h"
#include "core/color.h"
#include "core/real.h"
#include "sets/load_source.h"

namespace astrosplat {
namespace {

using namespace astrosplat::analytic;

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
