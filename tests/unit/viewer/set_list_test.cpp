// The next task for each layer, and the sample of a set while it grows.
#include "sets/load_source.h"
#include "support/small_scene.h"
#include "support/test.h"
#include "viewer/loaded_layer.h"
#include "viewer/set_loader.h"

namespace astrosplat {
namespace {

// The next task for each layer, and the fate of its result.

class SetListTest : public testing::Test {
  protected:
    Scene scene;
    SetList list{1000};

    LayerParams& add_layer(const std::string& name) {
        LayerParams& layer = scene.layers.emplace_back();
        layer.name = name;
        return layer;
    }
    /// With these layers more.
    void want(const std::vector<std::string>& names) {
        for (const std::string& name : names) add_layer(name);
        list.want(scene);
    }
    /// The task that the list begins next, as "task name"; "": nothing.
    std::string begun() {
        if (!list.next_task()) return "";
        job = list.begin_next();
        static constexpr const char* names[] = {"sample ", "load ", "arrange ", "describe "};
        return names[int(job->task)] + job->name;
    }
    /// The result that a job would bring.
    SetList::Layer result(bool whole) const {
        auto layer = std::make_shared<LoadedLayer>();
        layer->source = job->source;
        layer->name = job->name;
        layer->arranged = whole;
        if (whole) layer->histograms = std::make_shared<LayerHistograms>();
        return layer;
    }
    SetList::Layer keep(bool whole) {
        const SetList::Layer given_back = list.keep(*job, result(whole));
        list.end();
        return given_back;
    }

    std::shared_ptr<SetJob> job;
};

TEST_F(SetListTest, TheNewestWishComesFirst) {
    want({"gas", "dust"});
    EXPECT_EQ(begun(), "load gas");
    want({"stars"});
    keep(true);
    EXPECT_EQ(begun(), "load stars");
    keep(true);
    EXPECT_EQ(begun(), "load dust");
    keep(true);
    EXPECT_EQ(begun(), "");
    EXPECT_TRUE(list.resting());
}

TEST_F(SetListTest, SamplesOfAllLayersComeBeforeAnySet) {
    list = SetList(1000, true);
    want({"gas", "dust"});
    EXPECT_EQ(begun(), "sample gas");
    const SetList::Layer sampled = result(false);
    const std::uint64_t revision = list.revision();
    list.show_sample(*job, sampled);
    list.end();
    EXPECT_GT(list.revision(), revision);
    EXPECT_EQ(list.shown("gas"), sampled);
    EXPECT_TRUE(list.status(scene.layers[0]).loading);
    EXPECT_EQ(begun(), "sample dust");
    list.end();  // of which there was none
    EXPECT_TRUE(list.loading());
    EXPECT_EQ(begun(), "load gas");
    EXPECT_EQ(job->sampled, sampled);
    keep(true);
    EXPECT_NE(list.shown("gas"), sampled);
    EXPECT_EQ(begun(), "load dust");
    EXPECT_FALSE(job->sampled);
    keep(true);
    scene.layers[0].source.count = 7;
    list.want(scene);
    EXPECT_EQ(begun(), "load gas") << "the old set is shown";
    EXPECT_FALSE(job->sampled);
}

TEST_F(SetListTest, ASampleGoesWithItsWish) {
    for (const bool fails : {false, true}) {
        list = SetList(1000, true);
        scene.layers.clear();
        want({"gas"});
        EXPECT_EQ(begun(), "sample gas");
        list.show_sample(*job, result(false));
        list.end();
        EXPECT_TRUE(list.shown("gas"));
        if (fails) {
            EXPECT_EQ(begun(), "load gas");
            list.fail(*job, "damaged");
        } else {
            list.cancel("gas");
        }
        EXPECT_FALSE(list.shown("gas"));
    }
}

TEST_F(SetListTest, HowStarsLookMakesNoOtherSet) {
    SourceParams& source = add_layer("sky").source;
    StarsParams& stars = source.stars;
    source.kind = SourceKind::stars;
    list.want(scene);
    EXPECT_EQ(begun(), "load sky");
    keep(true);
    stars.psf = 2.0;
    stars.wings.share = 0.1;
    stars.spikes.share = 0.1;
    list.want(scene);
    EXPECT_EQ(begun(), "");
    EXPECT_FALSE(list.status(scene.layers[0]).stale);
    stars.limit = 5.0;
    list.want(scene);
    EXPECT_EQ(begun(), "load sky");
}

TEST_F(SetListTest, StarsAlongTheCameraFollowItsPath) {
    add_layer("sky");
    scene.camera.position = glm::dvec3(1.0, 2.0, 3.0);
    scene.layers[0].source.kind = SourceKind::stars;
    scene.layers[0].source.stars.along = "camera";
    list.want(scene);
    EXPECT_EQ(begun(), "load sky");
    EXPECT_EQ(job->source.stars.path, (std::vector{glm::dvec3(1.0, 2.0, 3.0)}));
    keep(true);
    EXPECT_FALSE(list.status(scene.layers[0]).stale);
    scene.camera.fov = 20.0;
    list.want(scene);
    EXPECT_EQ(begun(), "");
    scene.camera.position = glm::dvec3(4.0, 2.0, 3.0);
    list.want(scene);
    EXPECT_EQ(begun(), "load sky");
}

TEST_F(SetListTest, WhatComesLaterWaitsForAllSetsAndWhileItIsHeld) {
    want({"gas", "dust"});
    EXPECT_EQ(begun(), "load gas");
    keep(false);
    EXPECT_EQ(begun(), "load dust");
    EXPECT_TRUE(list.loading());
    keep(false);
    EXPECT_FALSE(list.loading());
    EXPECT_TRUE(list.hold(true));
    EXPECT_FALSE(list.hold(true));
    EXPECT_EQ(begun(), "");
    EXPECT_FALSE(list.resting());
    list.hold(false);
    for (const char* next : {"arrange gas", "arrange dust", "describe gas", "describe dust"}) {
        EXPECT_EQ(begun(), next);
        list.end();
    }
    EXPECT_TRUE(list.resting());
}

TEST_F(SetListTest, WhatIsAbandonedBeginsAgainWhenItIsWanted) {
    want({"gas"});
    begun();
    list.abandon("gas");
    EXPECT_TRUE(job->cancelled);
    EXPECT_FALSE(list.status(scene.layers[0]).loading);
    list.end();
    EXPECT_FALSE(list.next_task());
    list.want(scene);
    EXPECT_EQ(list.next_task(), SetTask::load);
    list.abandon("unknown");
}

TEST_F(SetListTest, AGrowingSetIsShownAlongsideAnOldOneFromHalfOnwards) {
    want({"gas"});
    begun();
    const auto keep_one = [&] {
        job->growing.begins({}, {});
        KeptSplat splat{};
        splat.alpha = 1.0f;
        const KeptStore::Run run{&splat, 1, 1};
        job->growing.keeps({&run, 1});
    };
    EXPECT_FALSE(list.growing_job()) << "nothing is kept yet";
    keep_one();
    EXPECT_EQ(list.growing_job(), job) << "there is no old one";
    keep(false);
    scene.layers[0].source.seed = 7;
    list.want(scene);
    EXPECT_EQ(begun(), "load gas");
    keep_one();
    job->progress = 0.49f;
    EXPECT_FALSE(list.growing_job());
    job->progress = 0.5f;
    EXPECT_EQ(list.growing_job(), job);
}

TEST_F(SetListTest, AJobKeepsWhatItBeganWithWhateverBecomesOfItsLayer) {
    want({"gas"});
    begun();
    keep(false);
    const SetList::Layer first = list.shown("gas");
    EXPECT_EQ(begun(), "arrange gas");
    scene.layers.clear();
    list.want(scene);
    EXPECT_TRUE(job->cancelled);
    EXPECT_EQ(job->loaded, first);
    EXPECT_FALSE(list.shown("gas"));
    const std::uint64_t revision = list.revision();
    const SetList::Layer late = result(true);
    EXPECT_EQ(list.replace(*job, late), late) << "it is not wanted any more";
    EXPECT_EQ(list.keep(*job, late), late);
    list.fail(*job, "too late");
    EXPECT_FALSE(list.shown("gas"));
    EXPECT_EQ(list.revision(), revision);
    list.end();
    EXPECT_TRUE(list.resting());
}

TEST_F(SetListTest, AResultGivesBackWhatItReplaces) {
    want({"gas"});
    begun();
    EXPECT_FALSE(keep(true));
    const SetList::Layer first = list.shown("gas");
    list.outdate("gas");
    const SetList::Layer old = list.shown("gas");
    EXPECT_NE(old, first) << "marked as outdated";
    list.want(scene);
    EXPECT_EQ(begun(), "load gas");
    EXPECT_EQ(keep(true), old);
    EXPECT_NE(list.shown("gas"), old);
}

// The sample of a set while it is generated: fair, of the right size, steady.

/// One splat an id, its number in x.
std::vector<KeptSplat> splats(std::uint64_t first, std::size_t count) {
    std::vector<KeptSplat> made(count);
    for (std::size_t i = 0; i < count; ++i) {
        made[i] = {};
        made[i].id = first + i;
        made[i].alpha = 1.0f;
        made[i].position.x = float(first + i);
    }
    return made;
}

void keep(GrowingSet& growing, const std::vector<KeptSplat>& kept) {
    const auto lit =
        std::count_if(kept.begin(), kept.end(), [](const KeptSplat& s) { return s.alpha > 0.0f; });
    const KeptStore::Run run{kept.data(), kept.size(), std::size_t(lit)};
    growing.keeps({&run, 1});
}

std::set<std::uint64_t> ids(const SplatSet& set, std::int64_t count) {
    return {set.id.begin(), set.id.begin() + std::ptrdiff_t(count)};
}

TEST(GrowingSet, IsAllOfAFewSplats) {
    GrowingSet growing(100);
    growing.begins({}, {});
    EXPECT_EQ(growing.sample().set->size(), 0);
    keep(growing, splats(7, 40));
    const GrowingSet::Sample sample = growing.sample();
    EXPECT_EQ(sample.kept, 40);
    ASSERT_EQ(sample.set->size(), 40);
    EXPECT_EQ(*ids(*sample.set, 40).begin(), 7u);
    for (std::int64_t i = 0; i < 40; ++i)
        EXPECT_EQ(sample.set->position[std::size_t(i)].x, float(sample.set->id[std::size_t(i)]));
}

TEST(GrowingSet, IsAFairShareOfMany) {
    GrowingSet growing(1000);
    growing.begins({}, {});
    for (std::uint64_t first = 0; first < 200000; first += 500) keep(growing, splats(first, 500));
    const GrowingSet::Sample sample = growing.sample();
    EXPECT_EQ(sample.kept, 200000);
    EXPECT_LE(sample.set->size(), 1000);
    EXPECT_GT(sample.set->size(), 400);
    // The mean of n uniform numbers is within 5 of its standard deviations; so is that of a prefix.
    for (const std::int64_t n : {sample.set->size(), sample.set->size() / 4}) {
        double mean = 0.0;
        for (std::int64_t i = 0; i < n; ++i) mean += sample.set->position[std::size_t(i)].x / double(n);
        EXPECT_NEAR(mean, 100000.0, 5.0 * 200000.0 / std::sqrt(12.0 * double(n)));
    }
}

TEST(GrowingSet, WhatWasInFrontStaysThereWhileMoreComes) {
    GrowingSet growing(400);
    growing.begins({}, {});
    keep(growing, splats(0, 5000));
    const auto before = growing.sample().set;
    keep(growing, splats(5000, 5000));
    const auto after = growing.sample().set;
    // The best half of the old ones is still among the new ones.
    const auto all = ids(*after, after->size());
    std::int64_t stayed = 0;
    for (const std::uint64_t id : ids(*before, before->size() / 3)) stayed += all.count(id) ? 1 : 0;
    EXPECT_EQ(stayed, before->size() / 3);
}

TEST(GrowingSet, WatchesAGeneration) {
    const SmallScene small;
    const LayerParams& layer = small.scene.layers[0];
    GrowingSet growing(1 << 20);
    const SplatSet set = load_source(layer.source, layer.name, {}, &growing);
    const GrowingSet::Sample sample = growing.sample();
    EXPECT_EQ(sample.kept, set.size());
    EXPECT_EQ(sample.set->size(), set.size());
    EXPECT_EQ(ids(*sample.set, set.size()), ids(set, set.size()));
    EXPECT_EQ(sample.set->spacing, set.spacing);
    EXPECT_EQ(sample.set->max_distance, set.max_distance);
    EXPECT_TRUE(sample.set->generated);
    const Bounds box = bounds(set);
    for (int axis = 0; axis < 3; ++axis) {
        const double off = 2.0 * set.spacing[axis];
        EXPECT_NEAR(sample.box.lo[axis], box.lo[axis], off);
        EXPECT_NEAR(sample.box.hi[axis], box.hi[axis], off);
    }
}

}  // namespace
}  // namespace astrosplat
