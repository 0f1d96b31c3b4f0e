// Samples of sets: rows of what is kept, and of what is not, dots as wide as those of the whole set.
#include "sets/set_sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "sets/kept.h"
#include "sets/load_source.h"
#include "splat_files/native.h"
#include "support/quiet.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

class SetSampleTest : public testing::Test {
  protected:
    SetSampleTest() {
        std::string picture = "P6\n640 480\n255\n";
        for (int i = 0; i < 640 * 480; ++i) {
            const int x = i % 640 - 320, y = i / 640 - 240;
            const bool lit = x * x + y * y < 200 * 200;
            for (const int value : {200, 150, 100})
                picture +=
                    static_cast<char>(lit ? value + static_cast<int>(50.0 * std::sin(0.02 * x * y)) : 0);
        }
        folder_.file("p.ppm", picture);
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
        // A smaller picture has fewer sizes of dots; were the rest not made narrower, they would cover 1.5
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

}  // namespace
}  // namespace astrosplat
