// Sets: bounds and order.
#include "splats/splat_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "core/parallel.h"
#include "splats/row_order.h"

namespace astrosplat {
namespace {

SplatSet unsorted() {
    SplatSet set;
    const std::uint64_t ids[] = {5, 1, 5, std::uint64_t{1} << 40, 0, 1};
    for (int i = 0; i < 6; ++i) {
        set.position.push_back(glm::vec3(static_cast<float>(i), static_cast<float>(-i), 2.0f));
        set.color.push_back(glm::vec3(static_cast<float>(i)));
        set.alpha.push_back(static_cast<float>(i));
        set.distance.push_back(static_cast<float>(i));
        set.radius.push_back(static_cast<float>(i));
        set.id.push_back(ids[i]);
    }
    return set;
}

TEST(SplatSet, SortIsStableAndMovesEveryArray) {
    SplatSet set = unsorted();
    sort_by_id(set);
    const float expected[] = {4, 1, 5, 0, 2, 3};
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(set.position[i].x, expected[i]);
        EXPECT_EQ(set.color[i].y, expected[i]);
        EXPECT_EQ(set.alpha[i], expected[i]);
        EXPECT_EQ(set.distance[i], expected[i]);
        EXPECT_EQ(set.radius[i], expected[i]);
    }
    EXPECT_TRUE(set.uv.empty());
}

// Ids near each other, equal ones, and some that are as far away as can be.
Buffer<std::uint64_t> scattered_ids(std::size_t count) {
    Buffer<std::uint64_t> ids;
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t mixed = i * 0x9e3779b97f4a7c15u;
        ids.push_back(i % 1000 == 7 ? mixed : mixed >> 46);
    }
    ids[count / 2] = std::numeric_limits<std::uint64_t>::max();
    return ids;
}

TEST(SplatSet, SortsManyRowsAsAStableSortDoes) {
    const Buffer<std::uint64_t> ids = scattered_ids(200000);
    std::vector<std::size_t> expected(ids.size());
    std::iota(expected.begin(), expected.end(), std::size_t{0});
    std::stable_sort(expected.begin(), expected.end(),
                     [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        SplatSet set;
        set.id = ids;
        set.position.resize(ids.size());
        set.color.resize(ids.size());
        set.alpha.resize(ids.size());
        set.distance.resize(ids.size());
        for (std::size_t i = 0; i < ids.size(); ++i) set.distance[i] = static_cast<float>(i);
        sort_by_id(set);
        for (std::size_t i = 0; i < ids.size(); ++i) {
            ASSERT_EQ(set.id[i], ids[expected[i]]) << i;
            ASSERT_EQ(set.distance[i], static_cast<float>(expected[i])) << i;
        }
    }
    set_thread_count(0);
}

TEST(RowOrder, DescentsAreFoundAnywhere) {
    Buffer<std::uint64_t> ids(150000);
    std::iota(ids.begin(), ids.end(), std::uint64_t{0});
    ids[7] = 6;
    EXPECT_TRUE(ids_ascend(ids));
    EXPECT_TRUE(ids_ascend({}));
    for (const std::size_t at :
         {1, 65535, 65536, 65537, 131072, 149999}) {  // work is cut at multiples of 2^16
        Buffer<std::uint64_t> other = ids;
        std::swap(other[at - 1], other[at]);
        EXPECT_FALSE(ids_ascend(other)) << at;
    }
}

TEST(RowOrder, BinsThenIdsThenRows) {
    const Buffer<std::uint32_t> bins{2, 0, 2, 1, 2, 0};
    const Buffer<std::uint64_t> ids{9, 4, 3, 8, 9, 4};
    const auto rows = rows_by_bin<std::uint32_t>(bins, 4, ids);
    EXPECT_EQ(std::vector(rows.begin(), rows.end()), (std::vector<std::uint32_t>{1, 5, 3, 2, 0, 4}));
    const auto wide = rows_by_bin<std::uint64_t>(bins, 4, ids);
    EXPECT_TRUE(std::equal(rows.begin(), rows.end(), wide.begin(), wide.end()));
}

TEST(SplatSet, Bounds) {
    const Bounds box = bounds(unsorted());
    EXPECT_EQ(box.lo, glm::dvec3(0, -5, 2));
    EXPECT_EQ(box.hi, glm::dvec3(5, 0, 2));
    EXPECT_TRUE(bounds(SplatSet()).empty());
}

}  // namespace
}  // namespace astrosplat
