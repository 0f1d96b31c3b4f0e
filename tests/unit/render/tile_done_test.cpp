// Who watches a frame being rendered sees every pixel once, the middle first, and can stop it at any tile.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <mutex>

#include "core/error.h"
#include "core/parallel.h"
#include "unit/render/scenes.h"

namespace astrosplat {
namespace {

using namespace astrosplat::test;

constexpr int frame_width_px = 211, frame_height_px = 133;

/// A row of splats so dense that a small memory limit asks for bands.
ShadedSplats dense_splats() {
    std::vector<OneSplat> splats;
    for (int i = 0; i < 4000; ++i) {
        const auto x = static_cast<float>(i % 100), y = static_cast<float>(i / 100);
        splats.push_back({{2.0f * x - 100.0f, 3.0f * y - 60.0f, 0.1f * x}, 3.0f, 0.5f, {1.0f, 0.5f, 0.25f}});
    }
    return make_splats(splats);
}

/// A rendering of dense_splats, watched by `tile_done`.
RenderedFrame watch(const RenderSettings& settings, const TileDone& tile_done,
                    const Progress& progress = {}) {
    const ShadedSplats splats = dense_splats();
    const RenderLayer layer = layer_of("dense", splats);
    return render({&layer, 1}, pixel_camera(frame_width_px, frame_height_px), nullptr, settings, progress,
                  nullptr, tile_done);
}

class TileDoneTest : public ::testing::TestWithParam<std::int64_t> {  // memory limit in bytes
  protected:
    RenderSettings settings() const {
        RenderSettings s = settings_of(frame_width_px, frame_height_px);
        s.region = {10, 5, 150, 120};
        s.memory_limit_bytes = GetParam();
        return s;
    }
};

TEST_P(TileDoneTest, ReportsEachPixelOnceAndFinal) {
    const Region region = settings().region;
    Image reported = make_image(region.width, region.height, 4);
    std::vector<int> times(static_cast<std::size_t>(region.width * region.height), 0);
    std::mutex mutex;
    const RenderedFrame frame = watch(settings(), [&](const Region& tile, const RenderedFrame& so_far) {
        const std::lock_guard lock(mutex);
        for (std::int64_t y = tile.y - region.y; y < tile.y - region.y + tile.height; ++y)
            for (std::int64_t x = tile.x - region.x; x < tile.x - region.x + tile.width; ++x) {
                ++times[static_cast<std::size_t>(y * region.width + x)];
                for (int k = 0; k < 4; ++k) reported.at(x, y)[k] = so_far.beauty.at(x, y)[k];
            }
    });
    EXPECT_EQ(times, std::vector<int>(times.size(), 1));
    EXPECT_EQ(reported.pixels, frame.beauty.pixels);
    EXPECT_EQ(frame.beauty.pixels, watch(settings(), {}).beauty.pixels);
}

TEST_P(TileDoneTest, StopsWhenCancelledFromATile) {
    std::atomic<bool> cancelled = false;
    std::atomic<int> tiles = 0;
    Progress progress;
    progress.cancelled = &cancelled;
    EXPECT_THROW(watch(
                     settings(),
                     [&](const Region&, const RenderedFrame&) {
                         if (++tiles == 3) cancelled = true;
                     },
                     progress),
                 Cancelled);
    EXPECT_LT(tiles, 3 + thread_count());
}

INSTANTIATE_TEST_SUITE_P(WholeAndInBands, TileDoneTest, ::testing::Values(0, 100000));

TEST(TileDone, TheMiddleComesFirst) {
    const int before = thread_count();
    set_thread_count(1);
    std::vector<std::int64_t> distances;  // of the tiles' centres from the picture's, squared and times four
    RenderSettings settings = settings_of(frame_width_px, frame_height_px);
    settings.tile_px = 32;
    watch(settings, [&](const Region& t, const RenderedFrame&) {
        const std::int64_t x = 2 * t.x + t.width - frame_width_px, y = 2 * t.y + t.height - frame_height_px;
        distances.push_back(x * x + y * y);
    });
    set_thread_count(before);
    EXPECT_EQ(distances.size(), 7u * 5u);
    EXPECT_TRUE(std::is_sorted(distances.begin(), distances.end()));
}

/// Its first tiles do not wait for splats far from them, and later ones use their memory again.
TEST(TileDone, ManySplatsComeInBandsFromTheMiddle) {
    constexpr int wide_px = 128, high_px = 256, rows = high_px / 32;
    std::vector<OneSplat> splats(2'000'000);
    for (std::size_t i = 0; i < splats.size(); ++i) {
        const auto x = static_cast<float>(i % 2000), y = static_cast<float>(i / 2000);
        splats[i] = {{0.064f * x - 64.0f, 0.256f * y - 128.0f, 0.01f * x}, 0.3f, 0.01f, {1.0f, 0.5f, 0.25f}};
    }
    const ShadedSplats set = make_splats(splats);
    const RenderLayer layer = layer_of("many", set);
    RenderSettings settings = settings_of(wide_px, high_px);
    settings.tile_px = 32;
    const int before = thread_count();
    set_thread_count(1);
    std::vector<std::int64_t> order;  // rows of tiles, as they come
    const auto picture = [&](const TileDone& tile_done) {
        return render({&layer, 1}, pixel_camera(wide_px, high_px), nullptr, settings, {}, nullptr, tile_done);
    };
    const RenderedFrame watched =
        picture([&](const Region& t, const RenderedFrame&) { order.push_back(t.y / settings.tile_px); });
    const RenderedFrame whole = picture({});
    set_thread_count(before);
    const std::size_t columns = wide_px / 32;
    EXPECT_EQ(order.size(), columns * rows);
    for (std::size_t i = 0; i < columns; ++i) EXPECT_EQ(order[i], order[0]) << "a band of one row";
    EXPECT_NEAR(static_cast<double>(order[0]), 0.5 * (rows - 1), 0.5);
    EXPECT_EQ(watched.beauty.pixels, whole.beauty.pixels);
    EXPECT_EQ(watched.statistics.splats_drawn, whole.statistics.splats_drawn);
}

}  // namespace
}  // namespace astrosplat
