// Figures of a layer in the controls: histograms of its distances and of its picture's values, its mean
// colour.
#include "viewer/loaded_layer.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/temp_folder.h"

namespace astrosplat {
namespace {

SplatSet set_of(const std::vector<float>& distances) {
    SplatSet set;
    for (const float distance : distances) {
        set.position.push_back({0.0f, 0.0f, 0.0f});
        set.color.push_back({1.0f, 1.0f, 1.0f});
        set.alpha.push_back(1.0f);
        set.distance.push_back(distance);
        set.id.push_back(set.id.size());
    }
    return set;
}

TEST(Histograms, OfDistancesReachToTheLargest) {
    SplatSet set = set_of({0.0f, 0.9f, 1.0f, 63.5f, 64.0f, 65.0f, -0.5f});
    set.distance.push_back(std::numeric_limits<float>::quiet_NaN());
    set.max_distance = 64.0;
    const LayerHistograms found = histograms(set, {});
    EXPECT_EQ(found.max_distance, 64.0);
    for (int i = 0; i < LayerHistograms::bins; ++i)
        EXPECT_EQ(found.distance[std::size_t(i)], i == 0 || i == 63 ? 1.0f : i == 1 ? 0.5f : 0.0f) << i;
    EXPECT_TRUE(found.values.share.empty());
}

TEST(Histograms, WithoutDistancesAreEmpty) {
    const LayerHistograms found = histograms(set_of({}), {});
    for (const float share : found.distance) EXPECT_EQ(share, 0.0f);
}

TEST(Histograms, OfAPictureAreOfItsLargestChannel) {
    const TempFolder folder;
    SourceParams source;
    // 255, 255, 128 and 0 of 255 in one channel, less in the others.
    source.meshes = {{"plane",
                      {folder.file("a.ppm", std::string("P6\n2 2\n255\n\xff\x10\x20\x01\xff\x02"
                                                        "\x80\x7f\x01\x00\x00\x00",
                                                        11 + 12))}}};
    const LayerHistograms found = histograms(set_of({}), source);
    ASSERT_EQ(found.values.share.size(), std::size_t{LayerHistograms::bins});
    EXPECT_EQ(found.values.lo, 0.0);
    EXPECT_EQ(found.values.hi, 1.0);
    for (std::size_t i = 0; i < found.values.share.size(); ++i)
        EXPECT_EQ(found.values.share[i], i == 63 ? 1.0f : i == 0 || i == 32 ? 0.5f : 0.0f) << i;
}

/// Weighted by alpha, of a few thousand splats at most.
TEST(MeanColor, IsOfSplatsFromEverywhere) {
    SplatSet set = set_of(std::vector<float>(16384, 0.0f));
    for (std::size_t i = 0; i < 16384; ++i) {
        const bool first = i < 8192;
        set.color[i] = glm::vec3(first ? 1.0f : 0.25f);
        set.alpha[i] = first ? 0.5f : 1.0f;
    }
    GrowingSet::Sample sample;
    sample.set = std::make_shared<const SplatSet>(set);
    EXPECT_EQ(growing_layer(sample, {}, "a").color, glm::vec3(0.5f));
    sample.set = std::make_shared<const SplatSet>(set_of({}));
    EXPECT_EQ(growing_layer(sample, {}, "a").color, glm::vec3(1.0f));
}

}  // namespace
}  // namespace astrosplat
