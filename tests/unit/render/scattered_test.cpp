// The memory of projected splats, estimated from a part of them as from all, whatever tiles the part alone
// would choose.
#include <gtest/gtest.h>

#include "render/screen_splat.h"
#include "unit/render/scenes.h"

namespace astrosplat {
namespace {

using namespace astrosplat::test;

/// Every `step`-th dot of a frame of 640x480 px that is full of small ones and has some wide ones.
ShadedSplats dots(int step) {
    constexpr int count = 400000;
    std::vector<OneSplat> all;
    std::uint32_t state = 5;
    const auto next = [&state] {
        state = state * 1664525u + 1013904223u;
        return static_cast<float>(state >> 8) / 16777216.0f;
    };
    for (int i = 0; i < count; ++i) {
        OneSplat dot{
            {640.0f * next() - 320.0f, 480.0f * next() - 240.0f, next()}, 1.0f + 2.0f * next(), 0.1f};
        if (i % 400 == 0) dot.radius = 60.0f;
        if (i % step == 0 || (i % 400 == 0 && (i / 400) % step == 0)) all.push_back(dot);
    }
    return make_splats(all);
}

std::int64_t bytes_of(const ShadedSplats& splats, double each, int tile_px = 0, float max_px = 0.0f) {
    RenderLayer layer = layer_of("a", splats);
    layer.render.lod.max_px = max_px;
    RenderSettings settings = settings_of(640, 480);
    settings.splats_each = each;
    settings.tile_px = tile_px;
    RenderCache cache;
    return scattered_bytes({&layer, 1}, pixel_camera(640, 480), settings, cache);
}

TEST(ScatteredBytes, APartTellsWhatAllTake) {
    const ShadedSplats all = dots(1), part = dots(9);
    const double each = static_cast<double>(all.size()) / static_cast<double>(part.size());
    for (const float max_px : {0.0f, 40.0f}) {
        const auto whole = static_cast<double>(bytes_of(all, 1.0, 0, max_px));
        EXPECT_NEAR(static_cast<double>(bytes_of(part, each, 0, max_px)), whole, 0.04 * whole);
        EXPECT_GT(whole, static_cast<double>(all.size()) * sizeof(ScreenSplat));
    }
}

// Few splats would choose the wider ones.
TEST(ScatteredBytes, TilesAreThoseOfAllSplats) {
    const ShadedSplats part = dots(9);
    EXPECT_EQ(bytes_of(part, 1.0), bytes_of(part, 1.0, 64));
    EXPECT_EQ(bytes_of(part, 1000.0), bytes_of(part, 1000.0, 32));
    EXPECT_GT(bytes_of(part, 1000.0), 1000 * bytes_of(part, 1.0));
}

}  // namespace
}  // namespace astrosplat
