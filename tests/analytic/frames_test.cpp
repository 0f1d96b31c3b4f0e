// Frames over time: a track changes the picture as its values say, and frame k is the same to the last bit
// alone, in a sequence, backwards, and twice.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "analytic/support.h"
#include "output/write.h"

namespace astrosplat {
namespace {

using namespace astrosplat::analytic;

std::string moving_scene(const char* blend, const char* animation) {
    return fmt::format(R"(astrosplat = 1
[output]
resolution = [80, 60]
[camera]
position = [2, 8, 9]
[[layer]]
name = "cloud"
[layer.source]
meshes = [ {{ mesh = "plane", texture = "cloud.tif" }} ]
count = 20000
[layer.render]
blend = "{}"
[animation]
{}
)",
                       blend, animation);
}

constexpr const char* everything_moves = R"(
"camera.position" = { keys = [[1, [2, 8, 9]], [5, [-1, 2, 4]], [9, [-3, 1, 0.5]]], interpolation = "smooth" }
"layer.cloud.look.pdf.shape" = { keys = [[1, "constant"], [5, "gaussian"]] }
"layer.cloud.look.noise.jitter" = { keys = [[1, 0.0], [9, 0.5]] }
"layer.cloud.look.alpha.power" = { keys = [[1, 1.0], [4, 3.0], [6, 3.0]] }
"layer.cloud.render.falloff" = { keys = [[1, "trapezoid"], [7, "gaussian"]] }
"layer.cloud.render.core" = { keys = [[1, 1.0], [6, 0.5]] }
"layer.cloud.render.lod.max_px" = { keys = [[1, 300.0], [9, 600.0]] }
)";

void write_cloud(const TempFolder& folder) {
    write_float_tiff(folder / "cloud.tif", 16, 16, [](int x, int y) {
        return glm::vec4(0.2 + x / 20.0, 0.9 - y / 20.0, 0.5, 0.1 + (x * 7 + y * 5) % 11 / 14.0);
    });
}

TEST(Frames, OpacityTrackFadesTheLightAsItSays) {
    const TempFolder folder;
    write_cloud(folder);
    Pipeline pipeline(scene_of(
        folder, moving_scene("add", R"("layer.cloud.render.opacity" = { keys = [[1, 1.0], [9, 0.0]] })")));
    const Image full = render_frame(pipeline, 1.0).beauty;
    EXPECT_GT(mean(full).r, 0.05);
    const Image half = render_frame(pipeline, 5.0).beauty;  // opacity 1/2: every product is exactly halved
    const Image gone = render_frame(pipeline, 9.0).beauty;
    for (std::size_t i = 0; i < full.pixels.size(); ++i) {
        if (i % 4 == 3) continue;  // alpha is held at 1
        ASSERT_EQ(half.pixels[i], 0.5f * full.pixels[i]) << i;
        ASSERT_EQ(gone.pixels[i], 0.0f) << i;
    }
}

TEST(Frames, GradeTracksChangeTheColourAsTheySay) {
    const TempFolder folder;
    write_cloud(folder);
    Pipeline pipeline(scene_of(
        folder, moving_scene("over", R"("layer.cloud.look.grade.gain" = { keys = [[1, 1.0], [3, 4.0]] }
"layer.cloud.look.grade.tint" = { keys = [[1, [1, 1, 1]], [3, [1, 0.5, 0]]] }
"layer.cloud.visible" = { keys = [[1, true], [4, false]] })")));
    const glm::dvec4 first = mean(render_frame(pipeline, 1.0).beauty);
    const glm::dvec4 second = mean(render_frame(pipeline, 2.0).beauty);  // gain 2.5, tint (1, 0.75, 0.5)
    EXPECT_NEAR(second.r / first.r, 2.5, 1e-4);
    EXPECT_NEAR(second.g / first.g, 1.875, 1e-4);
    EXPECT_NEAR(second.b / first.b, 1.25, 1e-4);
    EXPECT_NEAR(second.a / first.a, 1.0, 1e-4);
    EXPECT_EQ(mean(render_frame(pipeline, 4.0).beauty), glm::dvec4(0.0));
}

TEST(Frames, AloneInASequenceBackwardsAndTwiceAreTheSameBits) {
    const TempFolder folder;
    write_cloud(folder);
    const Scene scene = scene_of(folder, moving_scene("over", everything_moves));
    std::vector<std::string> alone;
    for (int frame = 1; frame <= 9; ++frame) {
        Pipeline fresh(scene);
        alone.push_back(pixel_hash(render_frame(fresh, frame).beauty));
    }
    for (std::size_t i = 1; i < alone.size(); ++i) EXPECT_NE(alone[i], alone[i - 1]);
    Pipeline pipeline(scene);
    for (int frame = 1; frame <= 9; ++frame)
        EXPECT_EQ(pixel_hash(render_frame(pipeline, frame).beauty), alone.at(frame - 1));
    for (int frame = 9; frame >= 1; frame -= 2)
        for (int again = 0; again < 2; ++again)
            EXPECT_EQ(pixel_hash(render_frame(pipeline, frame).beauty), alone.at(frame - 1)) << frame;
}

}  // namespace
}  // namespace astrosplat
