// The order of a preview: closed forms on a line, fair prefixes in space, ties, threads, and the rows that
// are taken.
#include "splats/stratified.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "core/shared_maths.h"

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
    const Buffer<std::int64_t> order = stratified_order(set);
    return {order.begin(), order.end()};
}

TEST(Stratified, PointsOnALineComeByReversedRank) {
    std::vector<glm::vec3> line;
    for (int i = 0; i < 8; ++i) line.push_back({float(i), 0.0f, 0.0f});
    EXPECT_EQ(order_of(set_of(line)), (std::vector<std::int64_t>{0, 4, 2, 6, 1, 5, 3, 7}));
}

TEST(Stratified, CountsThatAreNoPowerOfTwoSkipTheMissingRanks) {
    std::vector<glm::vec3> line;
    for (int i = 0; i < 6; ++i) line.push_back({float(i), 0.0f, 0.0f});
    EXPECT_EQ(order_of(set_of(line)), (std::vector<std::int64_t>{0, 4, 2, 1, 5, 3}));
}

TEST(Stratified, OfEqualPlacesTheLowestIdComesFirst) {
    SplatSet set = set_of({{1, 1, 1}, {0, 0, 0}, {1, 1, 1}, {0, 0, 0}});
    set.id = {9, 7, 2, 3};
    // In Morton order: rows 3, 1 (ids 3, 7 at the origin), then 2, 0.
    EXPECT_EQ(order_of(set), (std::vector<std::int64_t>{3, 2, 1, 0}));
}

/// Files may hold an id twice: then the rows stay as they are in the file.
TEST(Stratified, OfEqualIdsTheFirstRowComesFirst) {
    SplatSet set = set_of({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}});
    set.id = {5, 3, 3, 3};
    // In order: rows 1, 2, 3 (id 3), then 0; taken by reversed rank.
    EXPECT_EQ(order_of(set), (std::vector<std::int64_t>{1, 3, 2, 0}));
}

TEST(Stratified, EmptyAndSingleSets) {
    EXPECT_TRUE(stratified_order(set_of({})).empty());
    EXPECT_EQ(order_of(set_of({{3, 4, 5}})), (std::vector<std::int64_t>{0}));
}

TEST(Stratified, EveryRowComesOnceForAnyNumberOfThreads) {
    const SplatSet set = cloud(200001);
    const std::vector<std::int64_t> order = order_of(set);
    std::vector<std::int64_t> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], std::int64_t(i));
    set_thread_count(1);
    EXPECT_EQ(order_of(set), order);
    set_thread_count(5);
    EXPECT_EQ(order_of(set), order);
    set_thread_count(0);
}

// A random choice of 2000 would spread by 11 around the 125 of each of 16 columns; the order must do much
// better.
TEST(Stratified, APrefixIsAFairSampleOfSpace) {
    const SplatSet set = cloud(100000);
    const std::vector<std::int64_t> order = order_of(set);
    for (const std::size_t count : {2000u, 5000u, 30000u}) {
        std::array<int, 16> in_cell{};
        std::array<int, 16> all{};
        const auto cell = [&](std::int64_t row) {
            const glm::vec3 p = set.position[std::size_t(row)];
            return std::size_t(p.x * 0.4f) * 4 + std::size_t(p.z * 0.4f);
        };
        for (std::size_t i = 0; i < order.size(); ++i) {
            ++all[cell(order[i])];
            if (i < count) ++in_cell[cell(order[i])];
        }
        for (std::size_t c = 0; c < 16; ++c) {
            const double wanted = double(all[c]) * double(count) / double(order.size());
            EXPECT_NEAR(in_cell[c], wanted, 4.0) << "cell " << c << " of a prefix of " << count;
        }
    }
}

TEST(Stratified, TakenRowsBringEverythingAlong) {
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
    const Buffer<std::int64_t> order = stratified_order(set);
    const SplatSet taken = take_rows(set, order, 20);
    ASSERT_EQ(taken.size(), 20);
    EXPECT_TRUE(taken.normal.empty());
    EXPECT_TRUE(taken.mesh.empty());
    for (std::size_t i = 0; i < 20; ++i) {
        const auto row = std::size_t(order[i]);
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

    const SplatSet first = first_rows(taken, 5);
    ASSERT_EQ(first.size(), 5);
    EXPECT_TRUE(std::equal(first.id.begin(), first.id.end(), taken.id.begin()));
    EXPECT_EQ(first.radius[4], taken.radius[4]);
}

TEST(Stratified, StopsWhenAsked) {
    const std::atomic<bool> stop{true};
    Progress progress;
    progress.cancelled = &stop;
    EXPECT_THROW(stratified_order(cloud(1000), progress), Cancelled);
}

TEST(Stratified, StopsBetweenItsSteps) {
    const SplatSet set = cloud(1000);
    for (const double when : {0.4, 0.8}) {
        std::atomic<bool> stop{false};
        double last = 0.0;
        Progress progress;
        progress.cancelled = &stop;
        progress.report = [&](double fraction) {
            last = fraction;
            stop = fraction >= when;
        };
        EXPECT_THROW(stratified_order(set, progress), Cancelled);
        EXPECT_EQ(last, when);
    }
}

TEST(SampleRows, AnyPrefixHasOneRowOfEachStretch) {
    SplatSet set;
    for (std::uint64_t i = 0; i < 1024; ++i) {
        set.position.push_back({0.0f, 0.0f, 0.0f});
        set.id.push_back(i);
    }
    const SplatSet sample = sample_rows(set, 100);  // 64, the power of two below
    ASSERT_EQ(sample.size(), 64);
    for (const std::uint64_t prefix : {4u, 16u, 64u}) {
        std::vector<std::uint64_t> of_stretch(prefix, 0);
        for (std::uint64_t i = 0; i < prefix; ++i) ++of_stretch[sample.id[i] * prefix / 1024];
        for (const std::uint64_t rows : of_stretch) EXPECT_EQ(rows, 1u);
    }
    EXPECT_EQ(sample_rows(set, 0).size(), 0);
    EXPECT_EQ(sample_rows({}, 100).size(), 0);
}

}  // namespace
}  // namespace astrosplat
