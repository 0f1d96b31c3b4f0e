// Sets: bounds and order.
#include "splats/splat_set.h"

#include <gtest/gtest.h>

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

TEST(SplatSet, Bounds) {
    const Bounds box = bounds(unsorted());
    EXPECT_EQ(box.lo, glm::dvec3(0, -5, 2));
    EXPECT_EQ(box.hi, glm::dvec3(5, 0, 2));
    EXPECT_TRUE(bounds(SplatSet()).empty());
}

}  // namespace
}  // namespace astrosplat
