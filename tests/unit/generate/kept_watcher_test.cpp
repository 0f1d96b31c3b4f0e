// Who watches a generation sees every splat once, and changes nothing.
#include "generate/kept_store.h"

#include <gtest/gtest.h>

#include <map>
#include <mutex>

#include "core/parallel.h"
#include "generate/generate.h"
#include "unit/generate/generate_support.h"

namespace astrosplat {
namespace {

class Collector : public KeptWatcher {
  public:
    void begins(const SplatSet& empty, const Bounds& box) override {
        ++begun;
        EXPECT_TRUE(kept.empty());
        EXPECT_EQ(empty.size(), 0);
        spacing = empty.spacing;
        max_distance = empty.max_distance;
        generated = empty.generated;
        lattice_box = box;
    }
    void keeps(std::span<const KeptStore::Run> runs) override {
        const std::lock_guard lock(mutex);
        for (const KeptStore::Run& run : runs)
            for (std::size_t i = 0; i < run.count; ++i) {
                EXPECT_TRUE(kept.emplace(run.splats[i].id, run.splats[i]).second) << "twice";
                EXPECT_LT(run.splats[i].id, i + 1 < run.count ? run.splats[i + 1].id : ~std::uint64_t{0});
            }
    }

    std::int64_t sample_limit() const override { return 1000; }
    void ends(Columns sample, std::int64_t of) override {
        ++ended;
        EXPECT_EQ(sample.splats.size(), 1000);
        EXPECT_EQ(static_cast<std::size_t>(of), kept.size());
        for (std::size_t i = 0; i < sample.splats.id.size(); ++i)
            EXPECT_EQ(kept.at(sample.splats.id[i]).face, sample.splats.face[i]);
    }

    int begun = 0, ended = 0;
    glm::dvec3 spacing{0.0};
    double max_distance = 0.0;
    bool generated = false;
    Bounds lattice_box;
    std::map<std::uint64_t, KeptSplat> kept;

  private:
    std::mutex mutex;
};

TEST(KeptWatcher, SeesEverySplatOnceAndChangesNothing) {
    std::vector<TexturedMesh> meshes;
    meshes.push_back(
        test::textured(builtin_mesh("sphere", 1.0), test::flat_texture({0.2f, 0.4f, 0.8f, 0.5f})));
    SourceParams source;
    source.count = 150000;  // more than one block of a store
    const Lattice lattice = make_lattice(source, meshes, 0.5);
    const SplatSet alone = generate(meshes, lattice, 0.5, 1.0, 9);
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        Collector watcher;
        const SplatSet watched = lit_splats(make_columns(meshes, lattice, 0.5, 1.0, 9, {}, &watcher));
        test::expect_same_bits(watched, alone);
        EXPECT_EQ(watcher.begun, 1);
        EXPECT_EQ(watcher.ended, 1);
        EXPECT_EQ(watcher.spacing, alone.spacing);
        EXPECT_EQ(watcher.max_distance, alone.max_distance);
        EXPECT_TRUE(watcher.generated);
        EXPECT_EQ(watcher.lattice_box.lo, lattice.box.lo);
        ASSERT_EQ(static_cast<std::int64_t>(watcher.kept.size()), alone.size());
        std::size_t row = 0;
        for (const auto& [id, splat] : watcher.kept) {
            ASSERT_EQ(id, alone.id[row]);
            ASSERT_EQ(splat.position, alone.position[row]);
            ASSERT_EQ(splat.alpha, alone.alpha[row]);
            ++row;
        }
    }
    set_thread_count(0);
}

}  // namespace
}  // namespace astrosplat
