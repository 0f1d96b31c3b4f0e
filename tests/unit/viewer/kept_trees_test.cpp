// Trees in the cache: the same bits as built, for every set with the same positions; what is damaged is built
// again; how much they may take.
#include "viewer/kept_trees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <string>
#include <tuple>

#include "core/file.h"
#include "core/log.h"
#include "core/shared_maths.h"
#include "support/temp_folder.h"
#include "viewer/loaded_layer.h"
#include "viewer/set_loader.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

SplatSet cloud(std::uint32_t count, std::uint32_t seed = 1) {
    SplatSet set;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto random = [&](std::uint32_t axis) {
            return shared::as_uniform(shared::as_hash(seed, i, 0u, axis));
        };
        set.position.push_back({random(0), random(1), random(2)});
        set.color.push_back({random(3), 0.5f, 0.5f});
        set.alpha.push_back(0.5f);
        set.distance.push_back(0.0f);
        set.id.push_back(i);
    }
    return set;
}

bool same(const MergeTree& a, const MergeTree& b) {
    const auto same_node = [](const MergeNode& m, const MergeNode& n) {
        return std::tie(m.first, m.end, m.children) == std::tie(n.first, n.end, n.children);
    };
    return a.rows == b.rows && a.levels == b.levels &&
           std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), b.nodes.end(), same_node);
}

class KeptTreesTest : public testing::Test {
  protected:
    KeptTreesTest() {
        set_log_sink([this](LogLevel level, const std::string& line) {
            if (level == LogLevel::warning) warnings_.push_back(line);
        });
        cache_.folder = folder_ / "cache";
    }
    ~KeptTreesTest() override { set_log_sink(nullptr); }

    KeptTree begin(const SplatSet& set) const {
        KeptTree kept = read_or_build_tree(cache_, set);
        keep_tree(cache_, kept);
        return kept;
    }
    std::vector<fs::path> trees() const {
        std::vector<fs::path> found;
        for (const fs::path& file : entries_of(cache_.folder))
            if (file.extension() == ".tree") found.push_back(file);
        return found;
    }

    TempFolder folder_;
    SetCache cache_;
    std::vector<std::string> warnings_;
};

TEST_F(KeptTreesTest, ASecondStartReadsTheTreeThatTheFirstOneBuilt) {
    const SplatSet set = cloud(100'000);
    const KeptTree first = begin(set), second = begin(set);
    EXPECT_FALSE(first.cached);
    ASSERT_TRUE(second.cached);
    EXPECT_EQ(trees(), std::vector{first.file});
    EXPECT_TRUE(same(*first.tree, build_merge_tree(set)));
    EXPECT_TRUE(same(*second.tree, *first.tree));
}

TEST_F(KeptTreesTest, ATreeIsOfPositionsAndOfWhatAbsorbs) {
    SplatSet set = cloud(3000);
    begin(set);
    set.color[5] = glm::vec3(0.25f);
    set.alpha[7] = 0.125f;
    EXPECT_TRUE(begin(set).cached) << "another look of the same positions";
    set.absorbs = true;
    set.color[5].x = -1.0f;
    EXPECT_FALSE(begin(set).cached) << "a splat that absorbs has another root";
    EXPECT_EQ(begin(set).tree->root_count(), 2);
    EXPECT_TRUE(begin(set).cached);
    set.position[2999].z += 0.001f;
    EXPECT_FALSE(begin(set).cached);
    set.id[2998] = 2999;
    set.id[2999] = 2998;
    EXPECT_FALSE(begin(set).cached) << "ids order what lies at one place";
    set.spacing = glm::dvec3(0.1);
    EXPECT_FALSE(begin(set).cached) << "a lattice is halved in its middle";
    set.position.pop_back();
    set.color.pop_back();
    set.alpha.pop_back();
    set.distance.pop_back();
    set.id.pop_back();
    EXPECT_FALSE(begin(set).cached);
    EXPECT_EQ(trees().size(), 6u);
}

TEST_F(KeptTreesTest, WhatIsDamagedIsBuiltAgainWithoutAWord) {
    const SplatSet set = cloud(5000);
    const fs::path file = begin(set).file;
    const auto whole = static_cast<std::int64_t>(fs::file_size(file));
    const std::int64_t header = 32, version = 8, rows = 16, nodes = 24;
    for (const std::int64_t place :
         {std::int64_t{0}, version, rows, nodes, header + 3, whole / 2, whole - 1}) {
        SCOPED_TRACE(place);
        std::fstream damaged(file, std::ios::binary | std::ios::in | std::ios::out);
        damaged.seekg(place);
        const auto byte = static_cast<char>(damaged.get() ^ 0x41);
        damaged.seekp(place).put(byte);
        damaged.close();
        const KeptTree kept = begin(set);
        EXPECT_FALSE(kept.cached);
        EXPECT_TRUE(same(*kept.tree, build_merge_tree(set)));
        EXPECT_TRUE(begin(set).cached);
    }
    for (const std::int64_t length : {std::int64_t{0}, header, whole - 1, whole / 3}) {
        SCOPED_TRACE(length);
        fs::resize_file(file, static_cast<std::uintmax_t>(length));
        EXPECT_FALSE(begin(set).cached);
        EXPECT_TRUE(begin(set).cached);
    }
    EXPECT_TRUE(warnings_.empty()) << warnings_.front();
}

TEST_F(KeptTreesTest, TreesCountInTheCachesLimitAndDriveOutNoSet) {
    begin(cloud(5000, 1));
    const auto bytes = static_cast<std::int64_t>(fs::file_size(trees().front()));
    const auto hour_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
    fs::last_write_time(trees().front(), hour_ago);
    folder_.file("cache/0.splats", std::string(static_cast<std::size_t>(6 * bytes), 'x'));
    cache_.limit_bytes = 8 * bytes;
    begin(cloud(5000, 2));
    EXPECT_EQ(trees().size(), 2u);
    begin(cloud(5000, 3));
    ASSERT_EQ(trees().size(), 2u) << "the one used longest ago makes room";
    for (const fs::path& file : trees()) EXPECT_GT(fs::last_write_time(file), hour_ago);
    cache_.limit_bytes = 8 * bytes - 8;
    EXPECT_FALSE(begin(cloud(5000, 4)).cached);
    EXPECT_FALSE(begin(cloud(5000, 4)).cached) << "more than an eighth";
    EXPECT_TRUE(fs::exists(cache_.folder / "0.splats"));
}

TEST_F(KeptTreesTest, WithoutACacheNothingIsWritten) {
    cache_.folder.clear();
    const KeptTree kept = begin(cloud(3000));
    EXPECT_TRUE(kept.file.empty());
    EXPECT_FALSE(kept.cached);
    EXPECT_TRUE(begin(SplatSet()).tree->nodes.empty());
}

TEST_F(KeptTreesTest, AFolderThatCannotBeWrittenCostsAWarning) {
    folder_.file("cache", "a file");
    EXPECT_FALSE(begin(cloud(3000)).cached);
    EXPECT_EQ(warnings_.size(), 1u);
}

TEST_F(KeptTreesTest, ALoaderKeepsTheTreesOfSetsThatAreLargerThanTheirSample) {
    Scene scene;
    scene.layers.resize(1);
    scene.layers[0].name = "gas";
    scene.layers[0].source.meshes = {{"plane", {}, 0.15}};
    scene.layers[0].source.count = 20'000;
    const auto load = [&](std::int64_t sample_limit) {
        SetLoader loader(cache_, sample_limit);
        loader.want(scene);
        loader.wait();
        const auto layer = loader.layer("gas");
        EXPECT_TRUE(layer && layer->arranged);
        return layer;
    };
    load(100'000);
    EXPECT_TRUE(trees().empty()) << "the sample is the set";
    const auto first = load(1000);
    ASSERT_EQ(trees().size(), 1u);
    const auto hour_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
    fs::last_write_time(trees().front(), hour_ago);
    const auto second = load(1000);
    EXPECT_GT(fs::last_write_time(trees().front()), hour_ago) << "it was read";
    EXPECT_TRUE(same(*first->whole.tree, *second->whole.tree));
}

}  // namespace
}  // namespace astrosplat
