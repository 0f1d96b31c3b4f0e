// What becomes of a frame whose device fails.
#include "render/device.h"

#include "render/frame_job.h"
#include "support/test.h"
#include "unit/render/random_scene.h"

namespace astrosplat::test {
namespace {

/// Draws some groups, wrongly, before it is lost.
class LostDevice final : public RenderDevice {
  public:
    LostDevice(std::size_t groups, bool throws) : groups_(groups), throws_(throws) {}
    std::string name() const override { return "lost"; }
    std::string cannot(const FrameJob&) const override { return {}; }
    std::optional<GroupPlanes> draw(const FrameJob& job, std::size_t group, bool) override {
        ++asked;
        if (group >= groups_ && throws_) throw std::bad_alloc();
        if (group >= groups_) return {};
        GroupPlanes planes;
        planes.light = planes.through = planes.more =
            make_image(job.region.width, job.region.height, 4, 0.7f);
        planes.splats = 1000;
        return planes;
    }
    int asked = 0;

  private:
    std::size_t groups_;
    bool throws_;  // where this machine's memory does not suffice
};

TEST(Device, TheProcessorFinishesWhatALostOneHasBegun) {
    int lost_later = 0;
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        RandomScene scene(seed, 200);
        scene.settings.aov_depth = scene.settings.aov_coverage = scene.settings.aov_count = true;
        for (RenderLayer& layer : scene.layers) layer.render.isolate = true;
        const RenderedFrame expected = render(scene.layers, scene.camera, nullptr, scene.settings);
        for (const std::size_t drawn : {0, 1, 2}) {
            if (drawn >= scene.layers.size()) continue;
            LostDevice device(drawn, seed % 3 == 0);
            scene.settings.device = &device;
            const RenderedFrame frame = render(scene.layers, scene.camera, nullptr, scene.settings);
            scene.settings.device = nullptr;
            EXPECT_EQ(device.asked, int(drawn) + 1) << "not again once it is lost";
            lost_later += drawn > 0;
            EXPECT_EQ(frame.beauty.pixels, expected.beauty.pixels) << seed;
            EXPECT_EQ(frame.depth.pixels, expected.depth.pixels) << seed;
            EXPECT_EQ(frame.count.pixels, expected.count.pixels) << seed;
            EXPECT_EQ(frame.statistics.splats_drawn, expected.statistics.splats_drawn);
            EXPECT_EQ(frame.statistics.device, "");
            EXPECT_EQ(frame.statistics.not_on_device, "it ran out of memory or was lost");
        }
    }
    EXPECT_GT(lost_later, 5);
}

}  // namespace
}  // namespace astrosplat::test
