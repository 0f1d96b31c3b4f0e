// Splats that come by the block give the bits that they give in memory: whatever the memory limit, the blocks
// and the threads are, for every blend that has an order and those that have none, with level of detail,
// through every lens.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "core/shared_maths.h"
#include "render/scatter.h"
#include "unit/render/scenes.h"

namespace astrosplat {
namespace {

using namespace astrosplat::test;

constexpr int width_px = 97, height_px = 61;

float random(std::uint32_t n, std::uint32_t purpose) {
    return shared::as_uniform(shared::as_hash(7u, n, 0u, purpose));
}

/// A cloud around the origin, with planes of equal depths, and some splats all at one place.
ShadedSplats cloud(std::uint32_t count, std::uint32_t seed) {
    std::vector<OneSplat> splats;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t n = i + seed * 1000003u;
        const float size = random(n, 5);
        OneSplat s;
        s.position = {random(n, 1) * 8.0f - 4.0f, random(n, 2) * 6.0f - 3.0f,
                      std::floor(random(n, 3) * 24.0f) / 4.0f - 3.0f};
        if (i % 16 == 0) s.position = {0.1f, -0.2f, 0.3f};
        s.radius = 0.005f + 1.2f * size * size * size * size * size;
        s.alpha = random(n, 4);
        s.color = {random(n, 6) * 1.5f, random(n, 7), random(n, 8)};
        splats.push_back(s);
    }
    return make_splats(splats);
}

/// The splats of a set in space, some to a block, as a file may have them: ids in no order.
class BlocksInMemory : public ShadedBlocks {
  public:
    BlocksInMemory(const ShadedSplats& set, std::size_t rows_per_block) : set_(set) {
        rows_.resize(static_cast<std::size_t>(set.size()));
        std::iota(rows_.begin(), rows_.end(), std::size_t{0});
        const auto cell = [&](std::size_t row) {
            const glm::vec3 p = glm::floor(set.position[row] / 2.0f);
            return std::tuple(p.x, p.y, p.z, shared::as_hash(3u, static_cast<std::uint32_t>(row), 0u, 0u));
        };
        std::ranges::stable_sort(rows_, {}, cell);
        splats_ = set.size();
        for (std::size_t begin = 0; begin < rows_.size(); begin += rows_per_block) {
            BlockFacts facts;
            facts.first_sample = sample_.size();
            begins_.push_back(begin);
            const std::size_t end = std::min(rows_.size(), begin + rows_per_block);
            for (std::size_t i = begin; i < end; ++i) {
                const std::size_t row = rows_[i];
                const glm::vec3& c = set.color[row];
                facts.box.add(glm::dvec3(set.position[row]));
                facts.radius = std::max(facts.radius, set.radius[row]);
                largest_light_ = std::max(largest_light_, set.alpha[row] * std::max({c.x, c.y, c.z}));
                if (i % 8 == 0) add(row, sample_);
            }
            facts.splats = static_cast<std::int64_t>(end - begin);
            blocks_.push_back(facts);
        }
        begins_.push_back(rows_.size());
        blocks_.push_back({{}, 0.0f, 0, sample_.size()});
    }

    void shade(std::size_t block, ShadedSplats& out) const override {
        ++made;
        for_each_array(out, [](auto& array) { array.clear(); });
        for (std::size_t i = begins_[block]; i < begins_[block + 1]; ++i) add(rows_[i], out);
    }

    mutable std::atomic<int> made{0};

  private:
    void add(std::size_t row, ShadedSplats& to) const {
        to.position.push_back(set_.position[row]);
        to.color.push_back(set_.color[row]);
        to.alpha.push_back(set_.alpha[row]);
        to.radius.push_back(set_.radius[row]);
        to.id.push_back(set_.id[row]);
    }

    const ShadedSplats& set_;
    std::vector<std::size_t> rows_, begins_;
};

struct Sky {
    std::vector<ShadedSplats> sets;
    std::vector<RenderLayer> layers;
    std::vector<std::unique_ptr<BlocksInMemory>> blocks;
    Camera camera;
    RenderSettings settings = settings_of(width_px, height_px);

    explicit Sky(const std::vector<Blend>& blends, float lod_px = 0.0f, std::uint32_t count = 1500) {
        sets.reserve(blends.size());
        for (std::size_t i = 0; i < blends.size(); ++i) {
            sets.push_back(cloud(count, static_cast<std::uint32_t>(i + 1)));
            RenderLayer layer = layer_of("layer", sets.back(), blends[i], all_shapes[1 + i % 4]);
            layer.axis = {0.3, 0.9, 0.1};
            layer.translate = {0.1 * static_cast<double>(i), 0.0, 0.0};
            layer.scale = 1.0 + 0.2 * static_cast<double>(i);
            layer.render.lod.max_px = lod_px;
            layer.render.lod.max_children = 64;
            layer.render.lod.noise = lod_px > 0.0f ? 0.7f : 0.0f;
            layers.push_back(layer);
        }
        camera.eye = {0.3, 0.2, 6.0};
        camera.focal_px = 70.0;
        camera.center_x_px = width_px * 0.5;
        camera.center_y_px = height_px * 0.5;
    }

    /// The layers, those whose number is in `streamed` by the block.
    std::vector<RenderLayer> by_block(std::size_t rows, const std::vector<std::size_t>& streamed) {
        std::vector<RenderLayer> some = layers;
        blocks.clear();
        for (const std::size_t i : streamed) {
            blocks.push_back(std::make_unique<BlocksInMemory>(sets[i], rows));
            some[i].splats = nullptr;
            some[i].blocks = blocks.back().get();
        }
        return some;
    }

    int made() const {
        int sum = 0;
        for (const auto& each : blocks) sum += each->made;
        return sum;
    }

    /// `little`: bytes that are to make slabs.
    void expect_same_bits(const std::vector<std::size_t>& streamed, std::int64_t little = 100000) {
        const RenderedFrame whole = render(layers, camera, nullptr, settings);
        EXPECT_GT(total(whole.beauty, 3) + total(whole.beauty, 0), 0.01);
        const int before = thread_count();
        // Rows of a block, bytes, threads.
        const std::tuple<std::size_t, std::int64_t, int> ways[] = {
            {1000, 0, 2}, {97, 2 * little, 1}, {97, 2 * little, 3}, {61, little, 2}};
        for (const auto& [rows, limit, threads] : ways) {
            const std::vector<RenderLayer> some = by_block(rows, streamed);
            RenderSettings limited = settings;
            limited.memory_limit_bytes = limit;
            set_thread_count(threads);
            SCOPED_TRACE(testing::Message()
                         << rows << " rows, " << limit << " bytes, " << threads << " threads");
            const RenderedFrame frame = render(some, camera, nullptr, limited);
            EXPECT_EQ(whole.beauty.pixels, frame.beauty.pixels);
            EXPECT_EQ(whole.depth.pixels, frame.depth.pixels);
            EXPECT_EQ(whole.coverage.pixels, frame.coverage.pixels);
            EXPECT_EQ(whole.count.pixels, frame.count.pixels);
            ASSERT_EQ(whole.layers.size(), frame.layers.size());
            for (std::size_t i = 0; i < whole.layers.size(); ++i)
                EXPECT_EQ(whole.layers[i].pixels, frame.layers[i].pixels) << i;
            EXPECT_EQ(whole.statistics.splats_drawn, frame.statistics.splats_drawn);
            EXPECT_EQ(whole.statistics.splats_in, frame.statistics.splats_in);
        }
        set_thread_count(before);
    }
};

const std::vector<Blend> affine = {Blend::over, Blend::add, Blend::screen, Blend::hybrid, Blend::absorb};

TEST(ByTheBlock, EveryBlendAlone) {
    for (const Blend blend :
         {Blend::over, Blend::add, Blend::screen, Blend::hybrid, Blend::absorb, Blend::lighten}) {
        SCOPED_TRACE(static_cast<int>(blend));
        Sky({blend}).expect_same_bits({0});
    }
}

TEST(ByTheBlock, LayersAmongEachOther) { Sky(affine).expect_same_bits({0, 2, 3}); }

TEST(ByTheBlock, IsolatedLayersHoldoutsAndDust) {
    Sky sky({Blend::over, Blend::lighten, Blend::add, Blend::over, Blend::screen});
    sky.layers[2].render.isolate = true;
    sky.layers[3].render.holdout = true;
    sky.expect_same_bits({0, 1, 2, 3, 4});
}

TEST(ByTheBlock, Children) {
    Sky({Blend::over, Blend::screen, Blend::add}, 60.0f, 150).expect_same_bits({0, 1, 2}, 200000);
}

TEST(ByTheBlock, Lenses) {
    for (const Projection projection :
         {Projection::orthographic, Projection::fisheye, Projection::equirectangular}) {
        SCOPED_TRACE(static_cast<int>(projection));
        Sky sky({Blend::over, Blend::screen}, 60.0f, 200);
        sky.camera.projection = projection;
        sky.camera.focal_px =
            projection == Projection::orthographic ? 12.0 : width_px / (2.0 * 3.14159265358979);
        if (projection != Projection::orthographic) sky.camera.eye = {0.3, 0.2, 0.1};  // among them
        sky.expect_same_bits({0, 1}, 200000);
    }
}

TEST(ByTheBlock, FromWithin) {
    Sky sky({Blend::over, Blend::add}, 40.0f, 300);
    sky.camera.eye = {0.3, 0.2, 0.1};
    sky.expect_same_bits({0, 1}, 200000);
}

TEST(ByTheBlock, AllThatAFrameHas) {
    Sky sky(affine);
    sky.settings.aov_depth = sky.settings.aov_coverage = sky.settings.aov_count = sky.settings.aov_layers =
        true;
    sky.settings.region = {20, 11, 57, 43};
    sky.expect_same_bits({1, 2, 4});
}

TEST(ByTheBlock, WhatDoesNotShowIsNotMade) {
    Sky sky({Blend::over});
    sky.camera.focal_px = 500.0;
    for (float& radius : sky.sets[0].radius) radius = 0.01f;
    const std::vector<RenderLayer> some = sky.by_block(10, {0});
    const RenderedFrame whole = render(sky.layers, sky.camera, nullptr, sky.settings);
    const RenderedFrame frame = render(some, sky.camera, nullptr, sky.settings);
    EXPECT_EQ(whole.beauty.pixels, frame.beauty.pixels);
    EXPECT_GT(sky.made(), 5);
    EXPECT_LT(sky.made(), 100);  // of 150
}

TEST(ByTheBlock, TheStoreKeepsToItsLimit) {
    SplatStore store;
    store.limit(1000);
    store.take<char>(500);
    EXPECT_EQ(store.used_bytes(), 512);  // whole cache lines
    EXPECT_THROW(store.take<char>(500), StoreFull);
    store.clear();
    EXPECT_NO_THROW(store.take<char>(900));
    store.limit(0);
    EXPECT_NO_THROW(store.take<char>(5000));
}

TEST(ByTheBlock, LittleMemoryTakesMorePasses) {
    Sky sky({Blend::over});
    const auto passes = [&](std::int64_t limit) {
        const std::vector<RenderLayer> some = sky.by_block(50, {0});
        sky.settings.memory_limit_bytes = limit;
        render(some, sky.camera, nullptr, sky.settings);
        return sky.made();
    };
    const int one = passes(0);
    EXPECT_EQ(passes(std::int64_t{1} << 30), one);
    EXPECT_GT(passes(70000), one);
}

TEST(ByTheBlock, WhatWillNotFitIsSaid) {
    std::vector<OneSplat> splats(20000);
    for (OneSplat& s : splats) s.position = {0.0f, 0.0f, 0.0f};
    Sky sky({Blend::over});
    sky.sets[0] = make_splats(splats);
    const std::vector<RenderLayer> some = sky.by_block(1000, {0});
    sky.settings.memory_limit_bytes = 100000;
    try {
        render(some, sky.camera, nullptr, sky.settings);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("splats at one distance"), std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace astrosplat
