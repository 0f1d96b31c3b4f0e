// The settled picture is the pipeline's, bit for bit, whatever was begun and cancelled before it.
#include "viewer/view_frame.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <thread>

#include "core/memory.h"
#include "core/shared_maths.h"
#include "output/write.h"
#include "pipeline.h"
#include "sets/load_source.h"
#include "support/frames.h"
#include "support/small_scene.h"

namespace astrosplat {
namespace {

using State = FinalFrame::State;

class FinalFrameTest : public testing::Test {
  protected:
    FinalFrameTest() {
        for (const LayerParams& layer : small.scene.layers)
            sets.push_back(std::make_shared<const SplatSet>(load_source(layer.source, layer.name)));
    }

    /// One of a few pictures that differ in look, camera or size.
    FinalRequest request(std::uint32_t which) const {
        FinalRequest wanted;
        wanted.scene = small.scene;
        wanted.sets = sets;
        wanted.width = which % 2 ? 200 : 161;
        wanted.height = 99;
        wanted.scene.layers[0].look.grade.gain = 1.0f + 0.1f * static_cast<float>(which / 2 % 2);
        wanted.scene.camera.position = glm::dvec3(4.0, 6.0 + which / 4, 12.0);
        return wanted;
    }

    static std::string hash_of(const FinalRequest& wanted) {
        Pipeline pipeline;
        pipeline.set_scene(wanted.scene, wanted.sets);
        RenderSettings settings = settings_of(pipeline, wanted.frame);
        settings.width = wanted.width;
        settings.height = wanted.height;
        settings.region = wanted.region;
        return pixel_hash(pipeline.frame(wanted.frame, settings).beauty);
    }

    static void wait(const FinalFrame& picture) {
        while (picture.outcome().state == State::running)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }

    /// Starts it, and waits until it is done.
    static void finish(FinalFrame& picture, const FinalRequest& wanted) {
        picture.start(wanted);
        wait(picture);
        ASSERT_EQ(picture.outcome().state, State::done) << picture.outcome().error;
    }

    SmallScene small;
    std::vector<std::shared_ptr<const SplatSet>> sets;
};

TEST_F(FinalFrameTest, SettlesToThePipelinesPixels) {
    FinalFrame picture;
    EXPECT_EQ(picture.outcome().state, State::idle);
    finish(picture, request(0));
    const std::string wanted = hash_of(request(0));
    EXPECT_EQ(pixel_hash(picture.outcome().frame->beauty), wanted);
    EXPECT_TRUE(picture.outcome().frame->depth.pixels.empty());
    EXPECT_EQ(picture.progress(), 1.0f);
    Image tiles;
    EXPECT_FALSE(picture.take_tiles(tiles).empty());
    EXPECT_EQ(pixel_hash(tiles), wanted);
    EXPECT_TRUE(picture.take_tiles(tiles).empty());
}

TEST_F(FinalFrameTest, DepthComesWithTheSamePixels) {
    FinalRequest wanted = request(0);
    wanted.depth = true;
    FinalFrame picture;
    finish(picture, wanted);
    EXPECT_EQ(pixel_hash(picture.outcome().frame->beauty), hash_of(request(0)));
    EXPECT_EQ(picture.outcome().frame->depth.width, wanted.width);
}

TEST_F(FinalFrameTest, ARegionIsThatPartOfThePicture) {
    FinalRequest wanted = request(1);
    wanted.region = {37, 20, 90, 51};
    FinalFrame picture;
    finish(picture, wanted);
    Image tiles;
    picture.take_tiles(tiles);
    EXPECT_EQ(tiles.width, 90);
    EXPECT_EQ(pixel_hash(tiles), hash_of(wanted));
}

TEST_F(FinalFrameTest, CancelsAndRestartsInAnyOrderLeaveNoTrace) {
    std::array<std::string, 8> wanted;
    for (std::uint32_t i = 0; i < 8; ++i) wanted[i] = hash_of(request(i));
    FinalFrame picture;
    Image tiles;
    std::uint32_t current = 0;
    for (std::uint32_t step = 0; step < 120; ++step) {
        const std::uint32_t chance = shared::as_hash(3u, step, 0u, 1u);
        const std::uint32_t action = chance % 5;
        if (action == 0) picture.cancel();
        if (action <= 2) picture.start(request(current = (chance >> 8) % 8));
        if (action == 3) picture.take_tiles(tiles);
        if (action == 4) std::this_thread::sleep_for(std::chrono::milliseconds((chance >> 8) % 12));
        if (step % 20 != 19) continue;
        picture.start(request(current));
        while (picture.outcome().state == State::running) {
            picture.take_tiles(tiles);
            std::this_thread::yield();
        }
        picture.take_tiles(tiles);
        ASSERT_EQ(picture.outcome().state, State::done) << picture.outcome().error;
        ASSERT_EQ(pixel_hash(picture.outcome().frame->beauty), wanted[current]) << "step " << step;
        ASSERT_EQ(pixel_hash(tiles), wanted[current]) << "step " << step;
    }
}

TEST_F(FinalFrameTest, IsWholeWhenItIsDone) {
    FinalRequest wanted = request(0);
    wanted.region = {70, 40, 24, 16};
    const std::string hash = hash_of(wanted);
    FinalFrame picture;
    for (int round = 0; round < 200; ++round) {
        Image tiles;
        FinalFrame::Outcome outcome;
        for (picture.start(wanted); outcome.state != State::done; std::this_thread::yield()) {
            outcome = picture.outcome();
            picture.take_tiles(tiles);
        }
        ASSERT_EQ(pixel_hash(tiles), hash) << "round " << round;
    }
}

TEST_F(FinalFrameTest, ACancelledPictureStaysUnfinished) {
    FinalRequest large = request(0);
    large.width = large.height = 4000;
    FinalFrame picture;
    Image tiles;
    picture.start(large);
    while (picture.take_tiles(tiles).empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    picture.cancel();
    EXPECT_EQ(picture.outcome().state, State::idle);
    EXPECT_EQ(picture.progress(), 0.0f);
    EXPECT_FALSE(picture.outcome().frame);
    EXPECT_TRUE(picture.take_tiles(tiles).empty());

    const auto begin = std::chrono::steady_clock::now();
    FinalRequest next = request(1);
    next.region = {0, 0, 1, 1};
    finish(picture, next);
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
    std::printf("from cancel to the next picture's pixel: %.1f ms\n", taken.count());
}

/// Where memory does not suffice for a frame at once, it comes in bands, as --batch makes them.
TEST_F(FinalFrameTest, ALimitOfMemoryMakesBandsAndNotAnError) {
    small.scene.layers.resize(1);
    small.scene.layers[0].source.count = 2'500'000;
    FinalRequest wanted;
    wanted.scene = small.scene;
    wanted.sets = {std::make_shared<const SplatSet>(load_source(small.scene.layers[0].source, "gas"))};
    wanted.width = 400;
    wanted.height = 260;
    const std::string hash = hash_of(wanted);
    FinalFrame picture;
    FinalRequest pixel = wanted;  // so that the splats are shaded
    pixel.region = {0, 0, 1, 1};
    finish(picture, pixel);
    const std::int64_t before = resident_memory_bytes(), left = 72'000'000;
    limit_memory(before + left, "a dial");
    picture.start(wanted);
    wait(picture);
    EXPECT_LT(resident_memory_bytes(), before + left);
    limit_memory(before + 1'000'000, "a dial");
    wanted.scene.camera.position = glm::dvec3(5.0, 6.0, 12.0);
    wanted.width = wanted.height = 3000;
    FinalFrame refused;
    refused.start(wanted);
    wait(refused);
    limit_memory(0);
    ASSERT_EQ(picture.outcome().state, State::done) << picture.outcome().error;
    EXPECT_EQ(pixel_hash(picture.outcome().frame->beauty), hash);
    EXPECT_EQ(refused.outcome().state, State::failed);
    EXPECT_NE(refused.outcome().error.find(" that a dial allows; this takes "), std::string::npos)
        << refused.outcome().error;
}

TEST_F(FinalFrameTest, AFailureIsOneLineAndTheNextPictureWorks) {
    FinalRequest bad = request(0);
    bad.scene.layers[0].look.thickness.map = small.folder / "missing.png";
    FinalFrame picture;
    picture.start(bad);
    wait(picture);
    EXPECT_EQ(picture.outcome().state, State::failed);
    EXPECT_NE(picture.outcome().error.find("missing.png"), std::string::npos);
    EXPECT_EQ(picture.outcome().error.find('\n'), std::string::npos);
    EXPECT_FALSE(picture.outcome().frame);
    finish(picture, request(0));
    EXPECT_EQ(picture.outcome().error, "");
    EXPECT_EQ(pixel_hash(picture.outcome().frame->beauty), hash_of(request(0)));
}

TEST_F(FinalFrameTest, LayersStillLoadingAreLeftOut) {
    FinalRequest wanted = request(0);
    wanted.sets[0] = nullptr;
    FinalFrame picture;
    finish(picture, wanted);
    EXPECT_EQ(pixel_hash(picture.outcome().frame->beauty), hash_of(wanted));
    EXPECT_NE(pixel_hash(picture.outcome().frame->beauty), hash_of(request(0)));
}

TEST_F(FinalFrameTest, EndsInTheMiddleOfAPicture) {
    FinalRequest large = request(0);
    large.width = large.height = 4000;
    const long owners = sets[0].use_count();
    {
        FinalFrame picture;
        picture.start(large);
        while (picture.progress() == 0.0f) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        EXPECT_EQ(picture.outcome().state, State::running);
        EXPECT_GT(sets[0].use_count(), owners);
    }
    EXPECT_EQ(sets[0].use_count(), owners) << "a thread still works on it";
}

}  // namespace
}  // namespace astrosplat
