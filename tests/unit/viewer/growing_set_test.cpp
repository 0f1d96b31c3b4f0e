// The sample of a set while it is generated: fair, of the right size, steady.
#include "viewer/growing_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "sets/load_source.h"
#include "support/small_scene.h"

namespace astrosplat {
namespace {

/// One splat an id, its number in x.
std::vector<KeptSplat> splats(std::uint64_t first, std::size_t count) {
    std::vector<KeptSplat> made(count);
    for (std::size_t i = 0; i < count; ++i) {
        made[i] = {};
        made[i].id = first + i;
        made[i].alpha = 1.0f;
        made[i].position.x = static_cast<float>(first + i);
    }
    return made;
}

void keep(GrowingSet& growing, const std::vector<KeptSplat>& kept) {
    const auto lit =
        std::count_if(kept.begin(), kept.end(), [](const KeptSplat& s) { return s.alpha > 0.0f; });
    const KeptStore::Run run{kept.data(), kept.size(), static_cast<std::size_t>(lit)};
    growing.keeps({&run, 1});
}

std::set<std::uint64_t> ids(const SplatSet& set, std::int64_t count) {
    return {set.id.begin(), set.id.begin() + static_cast<std::ptrdiff_t>(count)};
}

TEST(GrowingSet, IsAllOfAFewSplats) {
    GrowingSet growing(100);
    growing.begins({}, {});
    EXPECT_EQ(growing.sample().set->size(), 0);
    keep(growing, splats(7, 40));
    const GrowingSet::Sample sample = growing.sample();
    EXPECT_EQ(sample.kept, 40);
    ASSERT_EQ(sample.set->size(), 40);
    EXPECT_EQ(*ids(*sample.set, 40).begin(), 7u);
    for (std::int64_t i = 0; i < 40; ++i)
        EXPECT_EQ(sample.set->position[std::size_t(i)].x, static_cast<float>(sample.set->id[std::size_t(i)]));
}

TEST(GrowingSet, IsAFairShareOfMany) {
    GrowingSet growing(1000);
    growing.begins({}, {});
    for (std::uint64_t first = 0; first < 200000; first += 500) keep(growing, splats(first, 500));
    const GrowingSet::Sample sample = growing.sample();
    EXPECT_EQ(sample.kept, 200000);
    EXPECT_LE(sample.set->size(), 1000);
    EXPECT_GT(sample.set->size(), 400);
    // The mean of n uniform numbers is within 5 of its standard deviations; so is that of a prefix.
    for (const std::int64_t n : {sample.set->size(), sample.set->size() / 4}) {
        double mean = 0.0;
        for (std::int64_t i = 0; i < n; ++i) mean += sample.set->position[std::size_t(i)].x / double(n);
        EXPECT_NEAR(mean, 100000.0, 5.0 * 200000.0 / std::sqrt(12.0 * double(n)));
    }
}

TEST(GrowingSet, WhatWasInFrontStaysThereWhileMoreComes) {
    GrowingSet growing(400);
    growing.begins({}, {});
    keep(growing, splats(0, 5000));
    const auto before = growing.sample().set;
    keep(growing, splats(5000, 5000));
    const auto after = growing.sample().set;
    // The best half of the old ones is still among the new ones.
    const auto all = ids(*after, after->size());
    std::int64_t stayed = 0;
    for (const std::uint64_t id : ids(*before, before->size() / 3)) stayed += all.count(id) ? 1 : 0;
    EXPECT_EQ(stayed, before->size() / 3);
}

TEST(GrowingSet, WatchesAGeneration) {
    const SmallScene small;
    const LayerParams& layer = small.scene.layers[0];
    GrowingSet growing(1 << 20);
    const SplatSet set = load_source(layer.source, layer.name, {}, &growing);
    const GrowingSet::Sample sample = growing.sample();
    EXPECT_EQ(sample.kept, set.size());
    EXPECT_EQ(sample.set->size(), set.size());
    EXPECT_EQ(ids(*sample.set, set.size()), ids(set, set.size()));
    EXPECT_EQ(sample.set->spacing, set.spacing);
    EXPECT_EQ(sample.set->max_distance, set.max_distance);
    EXPECT_TRUE(sample.set->generated);
    const Bounds box = bounds(set);
    for (int axis = 0; axis < 3; ++axis) {
        const double off = 2.0 * set.spacing[axis];
        EXPECT_NEAR(sample.box.lo[axis], box.lo[axis], off);
        EXPECT_NEAR(sample.box.hi[axis], box.hi[axis], off);
    }
}

}  // namespace
}  // namespace astrosplat
