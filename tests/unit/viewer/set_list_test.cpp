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
    EXPECT_EQ(begun(), "sample gas");
    EXPECT_TRUE(job->loaded) << "so no flat picture is shown";
    list.end();
    EXPECT_EQ(begun(), "load gas");
    EXPECT_FALSE(job->sampled);
}

TEST_F(SetListTest, WhatIsFollowedNeedsNoSample) {
    list = SetList(1000, true);
    want({"gas"});
    begun();
    list.end();
    begun();
    keep(true);
    scene.layers[0].source.texture.black = 0.1;
    list.want(scene);
    EXPECT_EQ(begun(), "load gas");
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
    EXPECT_TRUE(list.hold_after(SetTask::load));
    EXPECT_FALSE(list.hold_after(SetTask::load));
    EXPECT_EQ(begun(), "");
    EXPECT_FALSE(list.resting());
    const auto expect_begun = [&](std::initializer_list<const char*> tasks) {
        for (const char* next : tasks) {
            EXPECT_EQ(begun(), next);
            list.end();
        }
    };
    list.hold_after(SetTask::arrange);
    expect_begun({"arrange gas", "arrange dust"});
    EXPECT_EQ(begun(), "") << "histograms while the final frame is on its way";
    list.hold_after(SetTask::describe);
    expect_begun({"describe gas", "describe dust"});
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

TEST(MadeColumns, CountsWhatIsKeptAndHasSomeOfIt) {
    const SmallScene small;
    const LayerParams& layer = small.scene.layers[0];
    MadeColumns made(100);
    const SplatSet set = load_source(layer.source, layer.name, {}, &made);
    EXPECT_EQ(made.kept(), set.size());
    EXPECT_EQ(made.columns().set->size(), 100);
    EXPECT_EQ(made.columns().of, set.size() + set.zero_alpha);
}

}  // namespace
}  // namespace astrosplat
