// Orders and samples of a set's rows: Morton codes in closed form, ties, threads, and what rows bring along.
#include "splats/splat_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "core/shared_maths.h"
#include "splats/row_order.h"

namespace astrosplat {
namespace {

SplatSet set_of(const std::vector<glm::vec3>& positions) {
    SplatSet set;
    set.position.assign(positions.begin(), positions.end());
    const std::size_t n = positions.size();
    set.color.assign(n, glm::vec3(0.5f));
    set.alpha.assign(n, 0.5f);
    set.distance.assign(n, 0.0f);
    set.id.resize(n);
    std::iota(set.id.begin(), set.id.end(), std::uint64_t{0});
    return set;
}

float uniform(std::uint32_t i, std::uint32_t which) {
    return shared::as_uniform(shared::as_hash(5u, i, 0u, which));
}

SplatSet cloud(std::uint32_t count) {
    std::vector<glm::vec3> positions;
    for (std::uint32_t i = 0; i < count; ++i)
        positions.push_back({10.0f * uniform(i, 1), uniform(i, 2), 10.0f * uniform(i, 3)});
    return set_of(positions);
}

std::vector<std::int64_t> order_of(const SplatSet& set) {
    std::vector<std::int64_t> rows;
    for (const MortonRow& row : morton_order(set)) rows.push_back(row.row);
    return rows;
}

TEST(Morton, InterleavesTheBitsOfTheCoordinates) {
    EXPECT_EQ(morton_place(1, 0, 0), 1u);
    EXPECT_EQ(morton_place(0, 1, 0), 2u);
    EXPECT_EQ(morton_place(0, 0, 1), 4u);
    for (unsigned bit = 0; bit < morton_axis_bits; ++bit)
        EXPECT_EQ(spread_bits(std::uint64_t{1} << bit), std::uint64_t{1} << 3 * bit) << bit;
    const std::uint64_t most = (std::uint64_t{1} << morton_axis_bits) - 1;
    EXPECT_EQ(morton_place(most, most, most), (std::uint64_t{1} << 63) - 1);
}

TEST(MortonOrder, CornersOfACubeComeXFirst) {
    std::vector<glm::vec3> corners;
    for (int i = 7; i >= 0; --i) corners.push_back({float(i & 1), float(i >> 1 & 1), float(i >> 2)});
    EXPECT_EQ(order_of(set_of(corners)), (std::vector<std::int64_t>{7, 6, 5, 4, 3, 2, 1, 0}));
}

TEST(MortonOrder, EveryRowComesOnce) {
    const SplatSet set = cloud(200001);
    std::vector<std::int64_t> sorted = order_of(set);
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], std::int64_t(i));
    const Buffer<MortonRow> rows = morton_order(set);
    EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end(),
                               [](const MortonRow& a, const MortonRow& b) { return a.code < b.code; }));
}

TEST(MortonOrder, OfEqualPlacesTheLowestIdComesFirst) {
    SplatSet set = set_of({{1, 1, 1}, {0, 0, 0}, {1, 1, 1}, {1, 1, 1}});
    EXPECT_EQ(order_of(set), (std::vector<std::int64_t>{1, 0, 2, 3}));
    set.id = {9, 1, 4, 5};
    EXPECT_EQ(order_of(set), (std::vector<std::int64_t>{1, 2, 3, 0}));
}

TEST(MortonOrder, WhatAbsorbsComesLast) {
    SplatSet set = cloud(1000);
    for (std::size_t i = 0; i < 1000; i += 3) set.color[i] = glm::vec3(-1.0f);
    const auto absorbs = [&](std::int64_t row) { return set.color[row].x < 0.0f; };
    std::vector<std::int64_t> order = order_of(set);
    EXPECT_FALSE(std::is_partitioned(order.begin(), order.end(), std::not_fn(absorbs)))
        << "a set that does not say so has no such splats";
    set.absorbs = true;
    order = order_of(set);
    EXPECT_TRUE(std::is_partitioned(order.begin(), order.end(), std::not_fn(absorbs)));
}

TEST(MortonOrder, StopsWhenAskedAndBetweenItsSteps) {
    const std::atomic<bool> stop{true};
    EXPECT_THROW(morton_order(cloud(1000), Progress{{}, &stop}), Cancelled);
    for (const double when : {0.4, 0.8}) {
        std::atomic<bool> later{false};
        Progress progress;
        progress.cancelled = &later;
        progress.report = [&](double fraction) { later = fraction >= when; };
        if (when < 0.8)
            EXPECT_THROW(morton_order(cloud(1000), progress), Cancelled);
        else
            EXPECT_EQ(morton_order(cloud(1000), progress).size(), 1000u);
    }
}

TEST(TakeRows, BringsEverythingAlong) {
    SplatSet set = cloud(50);
    set.uv.resize(50);
    set.radius.resize(50);
    for (std::size_t i = 0; i < 50; ++i) {
        set.uv[i] = glm::vec2(float(i));
        set.radius[i] = float(i) * 2.0f;
        set.alpha[i] = float(i) * 0.01f;
    }
    set.spacing = {1, 2, 3};
    set.max_distance = 4.0;
    set.generated = set.divided = true;
    set.credit = "someone";
    const Buffer<std::int64_t> rows = {7, 3, 49, 3};
    const SplatSet taken = take_rows(set, rows);
    ASSERT_EQ(taken.size(), 4);
    EXPECT_TRUE(taken.normal.empty());
    EXPECT_TRUE(taken.mesh.empty());
    for (std::size_t i = 0; i < 4; ++i) {
        const auto row = std::size_t(rows[i]);
        EXPECT_EQ(taken.position[i], set.position[row]);
        EXPECT_EQ(taken.color[i], set.color[row]);
        EXPECT_EQ(taken.alpha[i], set.alpha[row]);
        EXPECT_EQ(taken.distance[i], set.distance[row]);
        EXPECT_EQ(taken.id[i], set.id[row]);
        EXPECT_EQ(taken.uv[i], set.uv[row]);
        EXPECT_EQ(taken.radius[i], set.radius[row]);
    }
    EXPECT_EQ(taken.spacing, set.spacing);
    EXPECT_EQ(taken.max_distance, 4.0);
    EXPECT_TRUE(taken.generated && taken.divided);
    EXPECT_EQ(taken.credit, "someone");
}

TEST(SampleRows, HasOneRowOfEachStretch) {
    const SplatSet set = cloud(1000);
    const SplatSet sample = sample_rows(set, 250);
    ASSERT_EQ(sample.size(), 250);
    std::vector<int> places(4, 0);
    for (std::uint64_t i = 0; i < 250; ++i) {
        EXPECT_EQ(sample.id[i] / 4, i);
        ++places[sample.id[i] % 4];
    }
    for (const int count : places) EXPECT_GT(count, 30) << "no pattern";
}

TEST(SampleRows, OfFewAreAll) {
    const SplatSet set = cloud(7);
    for (const std::int64_t count : {7, 100}) EXPECT_EQ(sample_rows(set, count).size(), 7);
    EXPECT_EQ(sample_rows(set, 0).size(), 0);
    EXPECT_EQ(sample_rows(cloud(0), 10).size(), 0);
}

}  // namespace
}  // namespace astrosplat
