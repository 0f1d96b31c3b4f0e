// The sort and the fold of a single tile: the total order, and stopping in the middle of the work.
#include "render/fold.h"

#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <span>
#include <vector>

#include "core/error.h"
#include "render/splat_sorter.h"

namespace astrosplat {
namespace {

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

}  // namespace
}  // namespace astrosplat
