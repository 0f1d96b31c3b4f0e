// The order in which the preview blends: farthest first, ties as the offline renderer breaks them.
#include "gl/order.h"

#include <gtest/gtest.h>

#include <chrono>

#include "camera/camera.h"

namespace astrosplat {
namespace {

/// Splats on the z axis at these places, all kept, with ids that fall as indices rise.
OrderJob job_at(const std::vector<float>& zs) {
    auto set = std::make_shared<SplatSet>();
    Buffer<glm::vec4> places;
    for (std::size_t i = 0; i < zs.size(); ++i) {
        places.push_back({0.0f, 0.0f, zs[i], 1.0f});
        set->id.push_back(1000 - i);
    }
    OrderJob job;
    job.places = std::make_shared<const Buffer<glm::vec4>>(places);
    job.layers = {{0, std::int64_t(zs.size()), glm::dmat3(1.0), glm::dvec3(0.0), set}};
    return job;
}

Order sorted(const OrderJob& job) {
    OrderScratch scratch;
    return sort_far_to_near(job, scratch);
}

std::vector<std::uint32_t> order_of(const OrderJob& job) {
    const Order order = sorted(job);
    return {order.splats.begin(), order.splats.end()};
}

using Indices = std::vector<std::uint32_t>;

TEST(PreviewOrder, FarthestFirst) { EXPECT_EQ(order_of(job_at({-2, -5, -3, -1})), (Indices{1, 2, 0, 3})); }

TEST(PreviewOrder, BehindTheEyeCountsByDistanceToo) {
    EXPECT_EQ(order_of(job_at({-2, 5, -3})), (Indices{1, 2, 0}));
    OrderJob job = job_at({-2, 5, -3});
    job.lens.projection =
        static_cast<int>(Projection::orthographic);  // by depth: what lies behind comes last
    EXPECT_EQ(order_of(job), (Indices{2, 0, 1}));
    job.places = job_at({0, -2, -1}).places;  // one beside the eye
    EXPECT_EQ(order_of(job), (Indices{1, 2, 0}));
}

TEST(PreviewOrder, TheSmallerIdIsInFrontAtEqualDistance) {
    EXPECT_EQ(order_of(job_at({-2, -2, -2})), (Indices{0, 1, 2}));
}

TEST(PreviewOrder, TheEarlierLayerIsInFrontAtEqualDistance) {
    OrderJob job = job_at({-2, -2});
    OrderLayer second = job.layers[0];
    job.layers[0].count = 1;
    second.first = second.count = 1;
    job.layers.push_back(second);
    EXPECT_EQ(order_of(job), (Indices{1, 0}));
}

TEST(PreviewOrder, DroppedSplatsAreLeftOut) {
    OrderJob job = job_at({-2, -5, -3});
    Buffer<glm::vec4> places = *job.places;
    places[1].w = -1.0f;
    job.places = std::make_shared<const Buffer<glm::vec4>>(places);
    EXPECT_EQ(order_of(job), (Indices{2, 0}));
}

TEST(PreviewOrder, CountsWhatLiesBeyondADistance) {
    OrderJob job = job_at({-2, -5, -3, -1});
    job.far_from = 2.5;
    EXPECT_EQ(sorted(job).far_count, 2);
    job.far_from = 0.0;
    EXPECT_EQ(sorted(job).far_count, 4);
    job.far_from = 1e30;
    EXPECT_EQ(sorted(job).far_count, 0);
}

TEST(PreviewOrder, ManySplatsAreInOrder) {
    std::vector<float> zs;
    std::uint32_t state = 1;
    for (int i = 0; i < 100000; ++i)
        zs.push_back(-1.0f - float((state = state * 1664525u + 1013904223u) >> 8) * 1e-6f);
    const Indices order = order_of(job_at(zs));
    ASSERT_EQ(order.size(), zs.size());
    for (std::size_t i = 1; i < order.size(); ++i) ASSERT_LE(zs[order[i - 1]], zs[order[i]]);
}

TEST(OrderThread, GivesTheNewestOrderOfASlotOnce) {
    OrderThread thread;
    for (std::uint64_t version = 1; version <= 3; ++version) {
        OrderJob job = job_at({-2, -5, -3});
        job.version = version;
        thread.submit(4, job);
    }
    ASSERT_TRUE(thread.wait(std::chrono::seconds(60)));
    const std::optional<Order> order = thread.take(4);
    ASSERT_TRUE(order.has_value());
    EXPECT_EQ(order->version, 3u);
    EXPECT_FALSE(thread.take(4).has_value());
    EXPECT_FALSE(thread.take(0).has_value());
}

}  // namespace
}  // namespace astrosplat
