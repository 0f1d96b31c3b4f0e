// The first picture: what `astrosplat new` writes around an image shows, from the front, the image's own
// light.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analytic/support.h"
#include "scene/load.h"
#include "scene/new_scene.h"

namespace astrosplat {
namespace {

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

}  // namespace
}  // namespace astrosplat
