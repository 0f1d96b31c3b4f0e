// Means of renderings by hand: light, depth by opacity, and layers that only some of them show.
#include "frame/frame_scene.h"

#include <gtest/gtest.h>

#include <array>

namespace astrosplat {
namespace {

/// Of one pixel: everything `light`, at `depth`, before an environment.
RenderedFrame rendering(float light, float opacity, float depth, std::size_t layers) {
    RenderedFrame frame;
    frame.beauty = make_image(1, 1, 4, light);
    frame.depth = make_image(1, 1, 1, depth);
    frame.opacity = make_image(1, 1, 1, opacity);
    frame.layers.assign(layers, make_image(1, 1, 4, light));
    frame.statistics = {100, 10, 2.0, 0.5};
    return frame;
}

TEST(MeanFrame, LightIsTheMeanAndDepthIsWeightedByOpacity) {
    RenderedFrame sum;
    add_rendering(sum, rendering(1.0f, 0.75f, 2.0f, 0), {});
    add_rendering(sum, rendering(0.5f, 0.25f, 10.0f, 0), {});
    divide_sum(sum, 2, 0);
    EXPECT_EQ(sum.beauty.pixels[0], 0.75f);
    EXPECT_EQ(sum.depth.pixels[0], 4.0f);
    EXPECT_TRUE(sum.layers.empty());
    EXPECT_EQ(sum.statistics.splats_in, 100);
    EXPECT_EQ(sum.statistics.splats_drawn, 10);
    EXPECT_EQ(sum.statistics.mean_overlap, 2.0);
    EXPECT_EQ(sum.statistics.seconds, 1.0);
}

TEST(MeanFrame, DepthIsNothingWhereNothingIsSeen) {
    RenderedFrame sum;
    for (int i = 0; i < 2; ++i) add_rendering(sum, rendering(1.0f, 0.0f, 0.0f, 0), {});
    divide_sum(sum, 2, 0);
    EXPECT_EQ(sum.depth.pixels[0], 0.0f);
}

TEST(MeanFrame, ALayerThatOneRenderingShowsHasItsShareInItsPlace) {
    RenderedFrame sum;
    const std::array<std::size_t, 1> third = {2}, first = {0};
    add_rendering(sum, rendering(1.0f, 1.0f, 1.0f, 1), third);
    add_rendering(sum, rendering(0.5f, 1.0f, 1.0f, 1), first);
    add_rendering(sum, rendering(0.0f, 1.0f, 1.0f, 0), {});
    add_rendering(sum, rendering(1.0f, 1.0f, 1.0f, 1), third);
    divide_sum(sum, 4, 4);
    ASSERT_EQ(sum.layers.size(), 4u);
    for (const auto& [layer, light] : {std::pair{0, 0.125f}, {1, 0.0f}, {2, 0.5f}, {3, 0.0f}})
        EXPECT_EQ(sum.layers[static_cast<std::size_t>(layer)].pixels[0], light) << layer;
}

}  // namespace
}  // namespace astrosplat
