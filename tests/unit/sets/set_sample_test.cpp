// What is seen before a set is whole: samples, and pictures as they are.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <vector>

#include "sets/kept.h"
#include "sets/load_source.h"
#include "sets/set_sample.h"
#include "splat_files/native.h"
#include "support/pixmap.h"
#include "support/quiet.h"
#include "support/temp_folder.h"
#include "unit/splat_files/file_support.h"

namespace astrosplat {
namespace {

// Samples of sets: rows of what is kept, and of what is not, splats as wide as those of the whole set.

namespace fs = std::filesystem;

class SetSampleTest : public testing::Test {
  protected:
    SetSampleTest() {
        folder_.file("p.ppm", test::pixmap(640, 480, [](int column, int row, int k) {
                         const int x = column - 320, y = row - 240;
                         const bool lit = x * x + y * y < 200 * 200;
                         return lit ? 200 - 50 * k + static_cast<int>(50.0 * std::sin(0.02 * x * y)) : 0;
                     }));
        columns_.meshes = {{"plane", {folder_ / "p.ppm"}, 0.15}};
        columns_.count = 600000;
        bodies_ = columns_;
        bodies_.structure.kind = StructureKind::sheet;
        bodies_.structure.most_texels = 250000;
        cache_.folder = folder_ / "sets";
    }

    static double mean_alpha(const SplatSet& set) {
        double sum = 0.0;
        for (const float alpha : set.alpha) sum += alpha;
        return sum / static_cast<double>(set.size());
    }
    /// Of all discs together.
    static double area(const SplatSet& set, double each) {
        double sum = 0.0;
        for (const float radius : set.radius) sum += static_cast<double>(radius) * radius;
        return sum * each;
    }

    TempFolder folder_;
    SourceParams columns_, bodies_;
    SetCache cache_;
    Quiet quiet_;
};

TEST_F(SetSampleTest, OfWhatIsKeptItHoldsRows) {
    for (const SourceParams& source : {columns_, bodies_}) {
        EXPECT_FALSE(sample_there(cache_, source, "a"));
        const SplatSet whole = load_source(cache_, source, "a", {}, nullptr, {true, true, true, true}).set;
        ASSERT_GT(whole.size(), 150000);
        const auto sample = sample_there(cache_, source, "a");
        ASSERT_TRUE(sample);
        EXPECT_EQ(sample->making_seconds, 0.0);
        EXPECT_NEAR(static_cast<double>(sample->splats), static_cast<double>(whole.size()),
                    0.02 * static_cast<double>(whole.size()));
        EXPECT_LT(sample->set.size(), 0.75 * static_cast<double>(whole.size()));
        EXPECT_NEAR(mean_alpha(sample->set), mean_alpha(whole), 0.02 * mean_alpha(whole));
        std::size_t row = 0;
        for (std::size_t i = 0; i < sample->set.id.size(); i += 97) {
            while (row < whole.id.size() && whole.id[row] < sample->set.id[i]) ++row;
            ASSERT_LT(row, whole.id.size());
            EXPECT_EQ(whole.id[row], sample->set.id[i]);
            EXPECT_EQ(whole.position[row], sample->set.position[i]);
            EXPECT_EQ(whole.color[row], sample->set.color[i]);
        }
    }
}

TEST_F(SetSampleTest, ItHasAsManyRowsAsAreAskedFor) {
    for (const SourceParams& source : {columns_, bodies_}) {
        load_source(cache_, source, "a");
        const SetSample usual = sample_there(cache_, source, "a").value();
        const SetSample small = sample_there(cache_, source, "a", 5000).value();
        const double rows = 0.05 * static_cast<double>(usual.set.size());
        EXPECT_NEAR(static_cast<double>(small.set.size()), rows, 0.05 * rows);
        EXPECT_NEAR(static_cast<double>(small.splats), static_cast<double>(usual.splats),
                    0.03 * static_cast<double>(usual.splats));
    }
}

TEST_F(SetSampleTest, OfWhatIsNotKeptItIsMadeAsWide) {
    for (const SourceParams& source : {columns_, bodies_}) {
        const SetSample sample = sample_set(cache_, source, "a");
        EXPECT_FALSE(fs::exists(cache_.folder));
        const SplatSet whole = load_source(source, "a");
        const auto splats = static_cast<double>(whole.size());
        EXPECT_GT(sample.making_seconds, 0.0);
        EXPECT_NEAR(static_cast<double>(sample.splats), splats, 0.15 * splats);
        EXPECT_GT(sample.each(), 1.3);
        // A smaller picture has fewer sizes of splats; were the rest not made narrower, they would cover 1.5
        // times as much.
        EXPECT_LE(area(sample.set, sample.each()), 1.1 * area(whole, 1.0));
        EXPECT_GE(area(sample.set, sample.each()), 0.5 * area(whole, 1.0));
        EXPECT_NEAR(glm::length(sample.set.spacing), glm::length(whole.spacing),
                    0.01 * glm::length(whole.spacing));
    }
}

TEST_F(SetSampleTest, OfASplatFileItHoldsRowsWhateverItsFormat) {
    SplatSet set = load_source(columns_, "a");
    write_native(folder_ / "a.splats", set, {}, RowOrder::id);
    SourceParams source;
    source.kind = SourceKind::splats;
    source.file = folder_ / "a.splats";
    const auto sample = sample_there({}, source, "a");
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->splats, set.size());
    EXPECT_NEAR(static_cast<double>(sample->set.size()), 100000.0, 4.0);
    std::ofstream(folder_ / "few.pda") << "ATTRIBUTES\n position rgbPP opacityPP radiusPP\nTYPES\n V V R R\n"
                                          "NUMBER_OF_PARTICLES: 1\nBEGIN DATA\n0 0 0 1 1 1 1 1\n";
    source.file = folder_ / "few.pda";
    EXPECT_FALSE(sample_there({}, source, "a"));
    EXPECT_EQ(sample_set({}, source, "a").splats, 1);
}

TEST_F(SetSampleTest, WhatIsDamagedIsNotThere) {
    load_source(cache_, bodies_, "a");
    fs::resize_file(cache_.folder / (recipe_of(bodies_, "a").name + ".splats"), 5000);
    EXPECT_FALSE(sample_there(cache_, bodies_, "a"));
}

TEST_F(SetSampleTest, NumbersThatAreNoneAreNotThere) {
    load_source(cache_, bodies_, "a");
    const fs::path file = cache_.folder / (recipe_of(bodies_, "a").name + ".splats");
    ASSERT_TRUE(sample_there(cache_, bodies_, "a"));
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(fs::file_size(file) / 4));
    bytes << std::string(1 << 20, '\xff');  // as floats not a number
    bytes.close();
    EXPECT_FALSE(sample_there(cache_, bodies_, "a"));
}

// Before its bodies are made, a picture is seen as it is: in its place, the right way round, in its colours.

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
        const std::string pixels = test::pixmap(width, height, [&](int x, int y, int k) {
            return k == (x < width / 3 ? 0 : 2) ? (y < height / 2 ? 120 : 60) : 0;
        });
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
