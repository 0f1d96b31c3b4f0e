// Before its bodies are made, a picture is seen as it is: in its place, the right way round, in its colours.
#include "sets/load_source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "unit/splat_files/file_support.h"

namespace astrosplat {
namespace {

class Watcher : public KeptWatcher {
  public:
    void begins(const SplatSet& empty, const Bounds& of) override {
        set = empty;
        box = of;
        ++begun;
    }
    void keeps(std::span<const KeptStore::Run> runs) override {
        for (const KeptStore::Run& run : runs)
            splats.insert(splats.end(), run.splats, run.splats + run.count);
    }
    std::int64_t sample_limit() const override { return 0; }
    void ends(Columns, std::int64_t) override {}

    SplatSet set;
    Bounds box;
    std::vector<KeptSplat> splats;
    int begun = 0;
};

class FlatStartTest : public SplatFileTest {
  protected:
    /// The left third is red, the rest blue; the lower half is darker.
    SourceParams picture(int width, int height) const {
        std::string pixels = "P6\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const char level = static_cast<char>(y < height / 2 ? 120 : 60);
                const bool red = x < width / 3;
                for (const char value : {red ? level : char(0), char(0), red ? char(0) : level})
                    pixels += value;
            }
        SourceParams source;
        source.meshes.push_back({"plane", {write("picture.ppm", pixels)}, 0.0});
        source.structure.kind = StructureKind::sheet;
        return source;
    }
};

TEST_F(FlatStartTest, APictureIsSeenInItsPlaceBeforeItsBodiesAre) {
    Watcher watcher;
    const SourceParams source = picture(300, 200);
    const SplatSet set = load_source(source, "gas", {}, &watcher);
    ASSERT_EQ(watcher.begun, 1);
    ASSERT_GT(watcher.splats.size(), 20000u);
    EXPECT_LE(watcher.splats.size(), 1u << 16);
    EXPECT_GT(watcher.set.spacing.x, 0.0);
    EXPECT_TRUE(watcher.set.generated);
    for (std::size_t i = 0; i < watcher.splats.size(); ++i) {
        const KeptSplat& splat = watcher.splats[i];
        if (i > 0) {
            ASSERT_LT(watcher.splats[i - 1].id, splat.id);
        }
        ASSERT_NEAR(splat.position.y, 0.0f, 1e-5f);
        if (std::fabs(splat.uv.x - 1.0f / 3.0f) < 0.01f) continue;
        const bool red = splat.uv.x < 1.0f / 3.0f;
        ASSERT_EQ(splat.color.r > 0.5f, red) << "at " << splat.uv.x;
        ASSERT_EQ(splat.color.b > 0.5f, !red);
        ASSERT_NEAR(splat.position.x, 10.0f * (splat.uv.x - 0.5f), 1e-3f);
    }
    const auto light_of = [&](bool upper) {
        double sum = 0.0;
        for (const KeptSplat& splat : watcher.splats)
            if ((splat.uv.y > 0.5f) == upper) sum += splat.alpha;
        return sum;
    };
    EXPECT_GT(light_of(true), 2.0 * light_of(false));
}

TEST_F(FlatStartTest, LargePicturesAreSeenWithAsManySplats) {
    Watcher watcher;
    show_flat(load_meshes(picture(1200, 700)), watcher);
    EXPECT_GT(watcher.splats.size(), 20000u);
    EXPECT_LE(watcher.splats.size(), 1u << 16);
    ASSERT_FALSE(watcher.box.empty());
    EXPECT_NEAR(watcher.box.hi.x, 5.0, 1e-6);
}

TEST_F(FlatStartTest, TheSetIsTheSameWhoeverWatches) {
    Watcher watcher;
    const SourceParams source = picture(60, 40);
    const SplatSet watched = load_source(source, "gas", {}, &watcher), alone = load_source(source, "gas");
    EXPECT_EQ(watched.id, alone.id);
    EXPECT_EQ(watched.position, alone.position);
}

}  // namespace
}  // namespace astrosplat
