// The sort and the fold of a single tile: the total order, and stopping in the middle of the work.
#include "render/fold.h"

#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "render/screen_splat.h"
#include "support/printing.h"

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

}  // namespace
}  // namespace astrosplat
