// Sets in the background: what comes, what stays, what is begun again and what is not.
#include "viewer/set_loader.h"

#include <condition_variable>

#include "sets/load_source.h"
#include "splat_files/formats.h"
#include "support/fits_text.h"
#include "support/pixmap.h"
#include "support/small_scene.h"
#include "support/splats.h"
#include "support/test.h"

namespace astrosplat {
namespace {

class SetLoaderTest : public testing::Test {
  protected:
    SmallScene small;
    SetLoader loader{SetCache{}, 5000};

    std::shared_ptr<const LoadedLayer> loaded(const std::string& name) {
        loader.want(small.scene);
        loader.wait();
        return loader.layer(name);
    }
    LayerStatus status(std::size_t layer) const { return loader.status(small.scene.layers[layer]); }
};

TEST_F(SetLoaderTest, BringsWhatLoadingBrings) {
    const std::uint64_t before = loader.revision();
    for (std::size_t i = 0; i < 2; ++i) {
        const LayerParams& layer = small.scene.layers[i];
        const auto found = loaded(layer.name);
        ASSERT_TRUE(found);
        const SplatSet wanted = load_source(layer.source, layer.name);
        EXPECT_TRUE(same_bits(wanted.id, found->set->id));
        EXPECT_TRUE(same_bits(wanted.color, found->set->color));
        EXPECT_TRUE(found->arranged);
        EXPECT_EQ(found->sample.set->size(), 5000);
        EXPECT_EQ(found->sample.tree->rows.size(), 5000u);
        EXPECT_FLOAT_EQ(found->sample.weight, float(wanted.size()) / 5000.0f);
        EXPECT_EQ(found->whole.set, found->set);
        EXPECT_EQ(found->whole.tree->rows.size(), wanted.id.size());
        EXPECT_EQ(found->whole.weight, 1.0f);
        EXPECT_EQ(found->box.lo, bounds(wanted).lo);
        EXPECT_EQ(status(i).splats, wanted.size());
        EXPECT_FALSE(status(i).loading || status(i).stale);
        EXPECT_EQ(status(i).error, "");
    }
    EXPECT_GT(loader.revision(), before);
    EXPECT_TRUE(loader.idle());
}

TEST_F(SetLoaderTest, WantingTheSameAgainDoesNothing) {
    const auto first = loaded("gas");
    const std::uint64_t revision = loader.revision();
    small.scene.layers[0].look.grade.gain = 0.2f;
    small.scene.layers[0].render.blend = Blend::add;
    loader.want(small.scene);
    EXPECT_TRUE(loader.idle());
    EXPECT_EQ(loader.revision(), revision);
    EXPECT_EQ(loader.layer("gas"), first);
}

TEST_F(SetLoaderTest, TheOldSetStaysUntilTheNewOneIsThere) {
    const auto first = loaded("gas");
    small.scene.layers[0].source.count = 200000;
    EXPECT_TRUE(status(0).stale);
    loader.want(small.scene);
    EXPECT_TRUE(loader.layer("gas"));
    EXPECT_GT(status(0).splats, 0);
    loader.wait();
    EXPECT_GT(loader.layer("gas")->set->size(), 3 * first->set->size());
    EXPECT_FALSE(status(0).stale);
}

TEST_F(SetLoaderTest, ARenamedLayerKeepsASetThatDoesNotDependOnTheName) {
    small.scene.layers[0].source.seed = 7;
    const auto first = loaded("gas");
    small.scene.layers[0].name = "glow";
    loader.want(small.scene);
    EXPECT_TRUE(loader.idle());
    EXPECT_EQ(loader.layer("glow")->set, first->set);
    EXPECT_FALSE(loader.layer("gas"));
    EXPECT_FALSE(status(0).stale);
}

TEST_F(SetLoaderTest, ARenamedLayerIsMadeAnewWhereItsSeedComesFromTheName) {
    const auto first = loaded("gas");
    small.scene.layers[0].name = "glow";
    const auto second = loaded("glow");
    ASSERT_TRUE(second);
    EXPECT_NE(second->set, first->set);
    EXPECT_NE(second->set->position[0], first->set->position[0]);
}

TEST_F(SetLoaderTest, ACopiedLayerSharesItsSet) {
    small.scene.layers[0].source.seed = 7;
    const auto first = loaded("gas");
    small.scene.layers.push_back(small.scene.layers[0]);
    small.scene.layers.back().name = "copy";
    loader.want(small.scene);
    EXPECT_TRUE(loader.idle());
    EXPECT_EQ(loader.layer("copy")->set, first->set);
}

TEST_F(SetLoaderTest, AnErrorStaysUntilTheSourceChanges) {
    small.scene.layers[0].source.meshes[0].texture = {small.folder / "later.ppm"};
    EXPECT_FALSE(loaded("gas"));
    EXPECT_HAS(status(0).error, "later.ppm");
    EXPECT_EQ(status(0).error.find('\n'), std::string::npos);
    EXPECT_FALSE(status(0).loading);
    EXPECT_TRUE(loader.layer("dust"));
    loader.want(small.scene);
    EXPECT_TRUE(loader.idle());
    EXPECT_NE(status(0).error, "");
    small.scene.layers[0].source.meshes[0].texture = {small.folder / "picture.ppm"};
    EXPECT_EQ(status(0).error, "");
    EXPECT_TRUE(loaded("gas"));
    EXPECT_EQ(status(0).error, "");
}

TEST_F(SetLoaderTest, RetryReadsWhatIsThereNow) {
    small.scene.layers[0].source.meshes[0].texture = {small.folder / "later.ppm"};
    EXPECT_FALSE(loaded("gas"));
    small.folder.file("later.ppm", SmallScene::picture());
    loader.retry("gas");
    loader.wait();
    EXPECT_TRUE(loader.layer("gas"));
    EXPECT_EQ(status(0).error, "");
    loader.retry("gas");  // nothing to do
    EXPECT_TRUE(loader.idle());
}

TEST_F(SetLoaderTest, OutdatedLayersAreReadAgain) {
    small.scene.layers[0].source.seed = small.scene.layers[1].source.seed = 7;
    small.scene.layers[1].source = small.scene.layers[0].source;
    const auto first = loaded("gas");
    EXPECT_EQ(std::count(first->files.begin(), first->files.end(), small.folder / "picture.ppm"), 1);
    std::string bright = SmallScene::picture();
    std::fill(bright.end() - 64 * 64 * 3, bright.end(), '\xff');
    small.folder.file("picture.ppm", bright);
    for (const char* name : {"gas", "dust"}) {
        loader.outdate(name);
        EXPECT_TRUE(loader.layer(name)) << "the old set stays";
    }
    for (const char* name : {"gas", "dust"}) {
        const auto second = loaded(name);
        EXPECT_NE(second->set, first->set);
        EXPECT_EQ(second->set->color[0], glm::vec3(1.0f));
    }
    EXPECT_FALSE(status(0).stale);
    loader.outdate("unknown");
}

TEST_F(SetLoaderTest, LayersThatAreNeverVisibleAreNotLoaded) {
    small.scene.layers[0].visible = false;
    EXPECT_FALSE(loaded("gas"));
    small.scene.layers[0].visible = true;
    const auto shown = loaded("gas");
    EXPECT_TRUE(shown);
    small.scene.layers[0].visible = false;
    EXPECT_EQ(loaded("gas"), shown);  // kept, should it be shown again
    small.scene.layers.erase(small.scene.layers.begin());
    EXPECT_FALSE(loaded("gas"));
}

TEST_F(SetLoaderTest, ACancelledLayerWaitsForRetryOrAnotherSource) {
    small.scene.layers[0].source.count = 3000000;  // so that the second waits behind it
    loader.want(small.scene);
    loader.cancel("dust");
    loader.cancel("gas");
    EXPECT_FALSE(status(0).loading);
    EXPECT_FALSE(status(1).loading);
    loader.wait();
    EXPECT_FALSE(loader.layer("dust"));
    EXPECT_FALSE(loader.layer("gas"));
    loader.want(small.scene);
    EXPECT_TRUE(loader.idle());
    loader.retry("dust");
    loader.wait();
    EXPECT_TRUE(loader.layer("dust"));
    small.scene.layers[0].source.count = 1000;
    EXPECT_TRUE(loaded("gas"));
}

/// Generates as the program does, but stays where its progress first reaches a mark until it may go on.
class HeldGeneration {
  public:
    explicit HeldGeneration(double mark) : mark_(mark) {}
    SplatSet operator()(const SourceParams& source, const std::string& name, const Progress& progress,
                        KeptWatcher& watcher) {
        Progress held = progress;
        held.report = [&](double fraction) {
            progress.at(fraction);
            if (fraction >= mark_) stay(progress);
        };
        return load_source(source, name, held, &watcher);
    }
    /// Until a set is held half made.
    void wait() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return held_; });
    }
    void go_on() {
        const std::lock_guard lock(mutex_);
        may_go_on_ = true;
        changed_.notify_all();
    }

  private:
    void stay(const Progress& progress) {
        std::unique_lock lock(mutex_);
        held_ = true;
        changed_.notify_all();
        while (!may_go_on_ && !progress.stop()) changed_.wait_for(lock, std::chrono::milliseconds(1));
    }

    double mark_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool held_ = false, may_go_on_ = false;
};

class QuickSetsTest : public testing::Test {
  protected:
    static constexpr std::int64_t limit = 1 << 18;

    QuickSetsTest() {
        small.scene.layers.resize(1);
        gas().source.count = 400000;
    }
    LayerParams& gas() { return small.scene.layers[0]; }

    SmallScene small;
};

TEST_F(QuickSetsTest, WhatIsKeptIsSeenBeforeItIsRead) {
    const SetCache cache{small.folder / "cache"};
    const SplatSet wanted = load_source(cache, gas().source, gas().name).set;
    HeldGeneration held(0.0);
    SetLoader loader(
        std::ref(held),
        [&](const SourceParams& source, const std::string& name, const QuickSets& quick,
            const Progress& progress) { quick.show(*sample_there(cache, source, name, 20000, progress)); },
        limit / 8);
    loader.want(small.scene);
    held.wait();
    const auto sampled = loader.layer("gas");
    ASSERT_TRUE(sampled);
    EXPECT_FALSE(sampled->set) << "what is not whole is no final picture";
    EXPECT_NEAR(double(sampled->sample.set->size()), 20000.0, 4.0);
    const auto splats = double(wanted.size());
    EXPECT_NEAR(double(sampled->splats), splats, 0.01 * splats);
    EXPECT_NEAR(sampled->sample.weight, splats / 20000.0, 0.01 * splats / 20000.0);
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(sampled->box.hi[axis], bounds(wanted).hi[axis], 0.05) << axis;
    EXPECT_TRUE(loader.status(gas()).loading);
    EXPECT_FALSE(loader.sets_there());
    loader.hold_after(SetTask::load);
    held.go_on();
    while (!loader.sets_there()) std::this_thread::yield();
    const auto whole = loader.layer("gas");
    ASSERT_TRUE(whole && whole->set);
    EXPECT_EQ(whole->set->size(), wanted.size());
    EXPECT_EQ(whole->sample, sampled->sample) << "which would be looked at and merged once more";
    EXPECT_FALSE(whole->arranged);
    loader.hold_after(SetTask::describe);
    loader.wait();
    EXPECT_TRUE(loader.layer("gas")->arranged);
}

TEST_F(QuickSetsTest, WhatCannotBeSampledIsLoadedAllTheSame) {
    SetLoader loader([](const SourceParams& source, const std::string& name, const Progress& progress,
                        KeptWatcher&) { return load_source(source, name, progress); },
                     [](const SourceParams&, const std::string&, const QuickSets&, const Progress&) {
                         throw InputError("damaged");
                     },
                     limit);
    loader.want(small.scene);
    loader.wait();
    EXPECT_TRUE(loader.layer("gas")->set);
    EXPECT_EQ(loader.status(gas()).error, "");
}

/// As the program shows them, of a picture as a sheet.
class QuickBodiesTest : public QuickSetsTest {
  protected:
    QuickBodiesTest() {
        const std::string pixels =
            test::pixmap(640, 500, [](int x, int y, int k) { return (x * (k + 1) ^ y) & 127; });
        gas().source.meshes = {{"plane", {small.folder.file("picture.ppm", pixels)}}};
        gas().source.structure.kind = StructureKind::sheet;
    }

    /// Of every set that is shown.
    void show(const SourceParams& source, const std::string& name, const QuickSets& quick,
              const Progress& progress) {
        show_quick_sets({}, source, name,
                        {quick.rows, quick.flat,
                         [&](SetSample sample) {
                             thick.push_back(bounds(sample.set).extent().y > 1e-3);
                             quick.show(std::move(sample));
                         }},
                        progress);
    }
    SetLoader::Sample shows() {
        return [this](const auto&... all) { show(all...); };
    }
    std::vector<bool> thick;
};

TEST_F(QuickBodiesTest, APictureIsFlatThenAQuickBodyAndGoneWhenCancelled) {
    HeldGeneration held(0.3);
    SetLoader loader(std::ref(held), shows(), limit);
    loader.want(small.scene);
    held.wait();
    EXPECT_EQ(thick, (std::vector<bool>{false, true}));
    const auto quick = loader.layer("gas");
    ASSERT_TRUE(quick);
    EXPECT_FALSE(quick->set) << "what is not whole is no final picture";
    EXPECT_TRUE(loader.status(gas()).loading);
    EXPECT_GT(loader.status(gas()).radius_min, 0.0);
    EXPECT_FALSE(loader.sets_there());
    loader.cancel("gas");
    EXPECT_FALSE(loader.layer("gas"));
    EXPECT_EQ(loader.status(gas()).splats, 0);
}

TEST_F(QuickBodiesTest, InPlaceOfABodyThereIsNoFlatPicture) {
    HeldGeneration held(0.3);
    bool first_set = true;
    SetLoader loader(
        [&](const SourceParams& source, const std::string& name, const Progress& progress,
            KeptWatcher& watcher) {
            const bool free = std::exchange(first_set, false);
            return free ? load_source(source, name, progress, &watcher)
                        : held(source, name, progress, watcher);
        },
        shows(), limit);
    loader.want(small.scene);
    loader.wait();
    const auto first = loader.layer("gas");
    thick.clear();
    gas().source.structure.margin = 0.1;
    loader.want(small.scene);
    held.wait();
    EXPECT_EQ(thick, std::vector<bool>{true});
    EXPECT_NE(loader.layer("gas"), first);
    EXPECT_EQ(loader.layer("gas")->box.lo, first->box.lo) << "the picture would move";
    EXPECT_FALSE(loader.status(gas()).stale);
    loader.cancel("gas");
    EXPECT_EQ(loader.layer("gas")->set, first->set);
    thick.clear();
    gas().source.structure.margin = 0.0;
    gas().source.structure.depth = 0.3;
    loader.want(small.scene);
    held.go_on();
    loader.wait();
    EXPECT_TRUE(thick.empty()) << "the old one is moved meanwhile";
}

TEST_F(QuickSetsTest, ASetThatIsHalfMadeIsGivenUpWithItsLoader) {
    HeldGeneration held(0.3);
    bool given_up = false;
    const auto load = [&](const SourceParams& source, const std::string& name, const Progress& progress,
                          KeptWatcher& watcher) {
        try {
            return held(source, name, progress, watcher);
        } catch (const Cancelled&) {
            given_up = true;
            throw;
        }
    };
    {
        SetLoader loader(load, limit);
        loader.want(small.scene);
        held.wait();
        EXPECT_FALSE(given_up);
    }
    EXPECT_TRUE(given_up);
}

TEST_F(SetLoaderTest, SaysWhatNoRadiusMeans) {
    const auto found = loaded("gas");
    const glm::dvec3 s = found->set->spacing;
    EXPECT_DOUBLE_EQ(status(0).radius_min, 0.6 * std::sqrt(s.x * s.x + s.y * s.y + s.z * s.z));
    EXPECT_EQ(status(0).radius_min, status(0).radius_max);
}

TEST_F(SetLoaderTest, ASplatFileBringsItsRadii) {
    SplatSet set;
    for (int i = 0; i < 10; ++i) {
        add_splat(set, glm::vec3(float(i)), glm::vec3(1.0f), 1.0f);
        set.radius.push_back(0.5f + 0.25f * float(i));
    }
    write_ply(small.folder / "stars.ply", set);
    small.scene.layers[0].source = {};
    small.scene.layers[0].source.kind = SourceKind::splats;
    small.scene.layers[0].source.file = small.folder / "stars.ply";
    const auto first = loaded("gas");
    ASSERT_TRUE(first);
    EXPECT_DOUBLE_EQ(status(0).radius_min, 0.5);
    EXPECT_DOUBLE_EQ(status(0).radius_max, 2.75);
    EXPECT_TRUE(first->histograms->values.share.empty());
    small.scene.layers[0].name = "stars";  // no seed in a file
    EXPECT_EQ(loaded("stars")->set, first->set);
}

TEST_F(SetLoaderTest, HistogramsAreSharesOfTheFullestBin) {
    const auto found = loaded("dust");  // a plane: as many splats at every distance
    ASSERT_TRUE(found->histograms);
    const LayerHistograms& h = *found->histograms;
    EXPECT_DOUBLE_EQ(h.max_distance, 0.3);
    EXPECT_EQ(*std::max_element(h.distance.begin(), h.distance.end()), 1.0f);
    EXPECT_GT(*std::min_element(h.distance.begin(), h.distance.end()), 0.4f);
    ASSERT_EQ(h.values.share.size(), 64u);
    EXPECT_EQ(h.values.lo, 0.0);
    EXPECT_EQ(h.values.hi, 1.0);
    EXPECT_EQ(h.values.share[0], 0.0f);  // the darkest pixel is 61 of 255
}

TEST_F(SetLoaderTest, FitsValuesAreDataValuesWithTheAutomaticLimits) {
    small.scene.layers[0].source.meshes[0].texture = {
        small.folder.file("ramp.fits", fits_file(100, 100, "", [](int x, int y) { return 100 * y + x; }))};
    small.scene.layers[0].source.texture.black = 4000.0;  // which leaves what "auto" means alone
    const auto found = loaded("gas");
    ASSERT_TRUE(found && found->histograms) << status(0).error;
    const LayerHistograms::Values& values = found->histograms->values;
    EXPECT_NEAR(values.black, 0.0025 * 9999.0, 1e-9);
    EXPECT_NEAR(values.white, 0.9975 * 9999.0, 1e-9);
    EXPECT_EQ(values.lo, 0.0);
    EXPECT_EQ(values.hi, 9999.0);
    ASSERT_EQ(values.share.size(), 64u);
    for (const float share : values.share) EXPECT_NEAR(share, 1.0f, 0.01f);
}

}  // namespace
}  // namespace astrosplat
