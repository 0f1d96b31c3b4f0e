// Tiles: the order of their work, and who watches them.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "render/fold.h"
#include "render/screen_splat.h"
#include "support/printing.h"
#include "unit/render/scenes.h"

namespace astrosplat {
namespace {

// The sort and the fold of a single tile: the total order, and stopping in the middle of the work.

/// Splats whose depths repeat, in runs that are not in order.
std::vector<ScreenSplat> shuffled_splats(std::uint32_t count) {
    std::vector<ScreenSplat> splats;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t n = i * 7919u % count;
        ScreenSplat s{16.0f, 16.0f, 5.0f, 0.01f, {1.0f, 1.0f, 1.0f}, 0, n, 0, 0};
        s.depth = std::bit_cast<std::uint32_t>(static_cast<float>(n % 97u) + 1.0f);
        splats.push_back(s);
    }
    return splats;
}

TEST(SplatSorter, GivesTheTotalOrderAcrossRuns) {
    const std::vector<ScreenSplat> splats = shuffled_splats(1000);
    const std::span<const ScreenSplat> all(splats);
    const std::vector<std::span<const ScreenSplat>> runs = {
        all.subspan(600), all.first(250), {}, all.subspan(250, 350)};
    SplatSorter sorter;
    const std::span<const ScreenSplat* const> order = sorter.sort(runs, {});
    ASSERT_EQ(order.size(), splats.size());
    for (std::size_t i = 0; i + 1 < order.size(); ++i) EXPECT_TRUE(in_front_of(*order[i], *order[i + 1]));
}

TEST(Cancelling, StopsTheSortAndTheFold) {
    const std::vector<ScreenSplat> splats = shuffled_splats(1000);
    const std::vector<std::span<const ScreenSplat>> runs = {splats};
    SplatSorter sorter;
    const std::span<const ScreenSplat* const> order = sorter.sort(runs, {});
    const FootprintTable table = make_footprint_table({}, 0.5f);
    const FoldLayer layer{&table, Blend::over, false};
    FoldSettings settings;
    settings.kind = FoldKind::over;
    TilePlanes planes;
    planes.reset({0, 0, 32, 32}, settings, 1);
    const std::atomic<bool> cancelled = true;
    Progress progress;
    progress.cancelled = &cancelled;
    EXPECT_THROW(fold({order, {&layer, 1}, settings, progress}, planes), Cancelled);
    SplatSorter stopped;
    EXPECT_THROW(stopped.sort(runs, progress), Cancelled);
    EXPECT_THROW(make_footprint_table({}, 0.5f, progress), Cancelled);
    fold({order, {&layer, 1}, settings, {}}, planes);
    EXPECT_GT(planes.color[0][planes.at(16, 16)], 0.9f);
}

/// One splat of each radius, far from the others.
std::vector<ScreenSplat> splats_of(std::span<const float> radii_px) {
    std::vector<ScreenSplat> splats;
    for (std::size_t i = 0; i < radii_px.size(); ++i) {
        const float x = 8.0f + 16.0f * static_cast<float>(i % 8),
                    y = 8.0f + 16.0f * static_cast<float>(i / 8);
        ScreenSplat s{
            x + 3.0f / 256.0f, y - 9.0f / 256.0f, radii_px[i], 0.5f, {1.0f, 0.5f, 0.25f}, 0, 0, 0, 0};
        s.depth = std::bit_cast<std::uint32_t>(1.0f + static_cast<float>(i));
        splats.push_back(s);
    }
    return splats;
}

/// Radii around the ends of the table of footprints, on its nodes and between them.
std::vector<float> telling_radii() {
    const float least = shared::SMALLEST_RADIUS_PX, most = 1024.0f;
    return {0.0f,
            1e-30f,
            0.001f,
            std::nextafter(least, 0.0f),
            least,
            std::nextafter(least, 1.0f),
            1.0f,
            2.5f,
            4.0f + 4.0f / 32.0f,
            6.7f,
            most * 31.0f / 32.0f,
            std::nextafter(most, 0.0f),
            most,
            std::nextafter(most, 2000.0f),
            1030.0f,
            1e6f,
            1e30f};
}

class FootprintsOfAVector : public testing::TestWithParam<Falloff::Shape> {};

TEST_P(FootprintsOfAVector, AreThoseOfOneSplatAfterTheOther) {
    Falloff falloff;
    falloff.shape = GetParam();
    Falloff other;
    other.shape = GetParam() == Falloff::Shape::gaussian ? Falloff::Shape::linear : Falloff::Shape::gaussian;
    const FootprintTable table = make_footprint_table(falloff, 0.5f),
                         unused = make_footprint_table(other, 0.5f);
    // A second layer with another table makes the fold look at every splat by itself.
    const FoldLayer layers[] = {{&table, Blend::screen, false}, {&unused, Blend::screen, false}};
    const std::vector<float> radii = telling_radii();
    for (const std::string& target : vector_targets()) {
        SCOPED_TRACE(target);
        set_vector_target(target);
        for (const float radius_px : radii) {  // one by one: large ones cover all others
            const std::vector<ScreenSplat> splats = splats_of(std::vector<float>(5, radius_px));
            std::vector<const ScreenSplat*> order;
            for (const ScreenSplat& splat : splats) order.push_back(&splat);
            TilePlanes together, single;
            for (TilePlanes* planes : {&together, &single}) planes->reset({0, 0, 128, 32}, {}, 2);
            fold({order, {layers, 1}, {}, {}}, together);
            fold({order, {layers, 2}, {}, {}}, single);
            for (int k = 0; k < 3; ++k) EXPECT_EQ(together.color[k], single.color[k]) << radius_px;
            for (int k = 0; k < 4; ++k)
                EXPECT_EQ(together.transmittance[k], single.transmittance[k]) << radius_px;
            EXPECT_EQ(together.alpha, single.alpha) << radius_px;
        }
    }
    set_vector_target("best");
}

INSTANTIATE_TEST_SUITE_P(Shapes, FootprintsOfAVector,
                         testing::Values(Falloff::Shape::gaussian, Falloff::Shape::linear,
                                         Falloff::Shape::constant, Falloff::Shape::trapezoid,
                                         Falloff::Shape::exponential));

// Who watches a frame being rendered sees every pixel once, the middle first, and can stop it at any tile.

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
