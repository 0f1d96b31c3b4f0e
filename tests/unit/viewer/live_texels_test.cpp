// Previews under other levels than the set was made with: what needs a set and what does not, the colours
// that come of it, and a hand that never rests.
#include "viewer/set_loader.h"

#include "edit/document.h"
#include "sets/kept.h"
#include "sets/load_source.h"
#include "support/fits_text.h"
#include "support/small_scene.h"
#include "support/test.h"

namespace astrosplat {
namespace {

SourceParams source_of_fits(const TempFolder& folder) {
    SourceParams source;
    source.meshes = {{"plane", {folder.file("data.fits", fits_file(64, 32, "", [](int x, int y) {
                                                return 100.0 + 5.0 * x + 3.0 * y;
                                            }))}}};
    source.texture.stretch = TextureSettings::Stretch::linear;
    source.texture.black = 50.0;
    source.texture.white = 600.0;
    source.count = 20000;
    return source;
}

/// As the loader makes it, with all positions as the sample.
std::shared_ptr<const LoadedLayer> loaded_layer(const SourceParams& source) {
    constexpr std::int64_t all = 1 << 20;
    MadeColumns made(all);
    auto set = std::make_shared<const SplatSet>(load_source(source, "gas", {}, &made));
    auto layer = std::make_shared<LoadedLayer>(whole_layer(std::move(set), source, "gas", all));
    layer->columns = made.columns();
    return layer;
}

SplatSet live_set(const std::shared_ptr<const LoadedLayer>& loaded, const SourceParams& now) {
    return *live_maker()({loaded, now}, {}).layer->sample.set;
}

double light(const SplatSet& set) {
    double sum = 0.0;
    for (std::size_t i = 0; i < set.id.size(); ++i)
        sum += double(set.alpha[i]) * double(set.color[i].x + set.color[i].y + set.color[i].z);
    return sum;
}

/// Of all that a preview stands for.
double live_light(const std::shared_ptr<const LoadedLayer>& loaded, const SourceParams& now) {
    const MergeSource sample = live_maker()({loaded, now}, {}).layer->sample;
    return light(*sample.set) * double(sample.weight);
}

class LiveTexelsTest : public testing::Test {
  protected:
    TempFolder folder;
    SourceParams source = source_of_fits(folder);
};

TEST_F(LiveTexelsTest, WhatNeedsNoOtherPositions) {
    using Change = std::function<void(SourceParams&)>;
    const Change followed[] = {
        [](SourceParams& s) { s.texture.black = 70.0; },
        [](SourceParams& s) { s.texture.white = 700.0; },
        [](SourceParams& s) { s.texture.stretch = TextureSettings::Stretch::log; },
        [](SourceParams& s) { s.texture.softening = 0.2; },
        [](SourceParams& s) { s.texture.colorspace = TextureSettings::Colorspace::srgb; },
        [](SourceParams& s) { s.texture.alpha = TextureSettings::Alpha::luminance; },
        [](SourceParams& s) { s.texture.unpremultiply = TextureSettings::Unpremultiply::no; },
        [](SourceParams& s) { s.texture.filter = TextureSettings::Filter::area; },
        [](SourceParams& s) { s.texture.mask.emplace_back().luminance = glm::dvec2(0.2, 1.0); },
    };
    const Change others[] = {
        [](SourceParams&) {},
        [](SourceParams& s) { s.count = 7; },
        [](SourceParams& s) { s.seed = 7; },
        [](SourceParams& s) { s.meshes[0].mesh = "disk"; },
        [](SourceParams& s) { s.meshes[0].texture = {"other.fits"}; },
        [](SourceParams& s) { s.texture.hdu = "1"; },
        [](SourceParams& s) { s.texture.prepare.background = PrepareParams::Background::plane; },
        [](SourceParams& s) { s.kind = SourceKind::splats; },
    };
    for (const bool expected : {true, false})
        for (const Change& change :
             expected ? std::span<const Change>(followed) : std::span<const Change>(others)) {
            SourceParams now = source;
            change(now);
            EXPECT_EQ(can_follow(source, now), expected);
        }
}

TEST_F(LiveTexelsTest, ColumnsReadTheirPicturesAgain) {
    source.texture.black = 200.0;  // hides the dark half
    const auto loaded = loaded_layer(source);
    source.texture.black = 50.0;
    source.texture.filter = TextureSettings::Filter::area;
    const SplatSet wanted = load_source(source, "gas");
    EXPECT_GT(wanted.size(), loaded->splats * 11 / 10);
    const SplatSet seen = lit_splats(Columns{live_set(loaded, source)});
    EXPECT_TRUE(same_bits(seen.id, wanted.id));
    EXPECT_TRUE(same_bits(seen.color, wanted.color));
    EXPECT_TRUE(same_bits(seen.alpha, wanted.alpha));
}

TEST_F(LiveTexelsTest, AColumnOfManyStandsForAll) {
    MadeColumns made(5000);
    const SplatSet set = load_source(source, "gas", {}, &made);
    EXPECT_EQ(made.columns().set->size(), 5000);
    EXPECT_EQ(made.columns().of, set.size() + set.zero_alpha);
}

// Shapes whose grid depends on the picture's size have the faces that the set was made with.
TEST_F(LiveTexelsTest, LargePicturesAreThinnedAndTheirShapesAreNot) {
    source.meshes[0].mesh = "relief";
    source.meshes[0].texture = {folder.file(
        "large.fits", fits_file(1201, 903, "", [](int x, int y) { return 100.0 + 0.3 * x + 0.2 * y; }))};
    const auto loaded = loaded_layer(source);
    source.texture.white = 650.0;
    const double wanted = light(load_source(source, "gas")), seen = light(live_set(loaded, source));
    EXPECT_NEAR(seen / wanted, 1.0, 0.02);
}

TEST_F(LiveTexelsTest, StructuresFollowTheRatioOfThePictures) {
    source.structure.kind = StructureKind::sheet;
    source.texture.black = 0.0;
    const auto loaded = loaded_layer(source);
    ASSERT_FALSE(loaded->columns.set);
    SourceParams now = source;
    now.texture.white = 1200.0;  // half the light
    EXPECT_NEAR(live_light(loaded, now) / light(*loaded->set), 0.5, 0.02);
    now.texture.white = 601.0;
    EXPECT_NEAR(live_light(loaded, now) / light(*loaded->set), 1.0, 0.01);
}

TEST_F(LiveTexelsTest, BodiesAreMovedByTheirNewModel) {
    source.structure.kind = StructureKind::sheet;
    source.structure.margin = 0.1;
    const auto loaded = loaded_layer(source);
    SourceParams now = source;
    now.structure.depth *= 3.0;
    ASSERT_TRUE(can_follow(source, now));
    const double wanted = bounds(load_source(now, "gas")).extent().y,
                 before = bounds(*loaded->set).extent().y, seen = bounds(live_set(loaded, now)).extent().y;
    EXPECT_GT(wanted, 1.5 * before);
    EXPECT_NEAR(seen / wanted, 1.0, 0.15);
    now.texture.white = 1200.0;
    EXPECT_NEAR(live_light(loaded, now) / light(*loaded->set), 0.5, 0.02) << "levels as well";
    now.structure.margin = 0.2;
    EXPECT_FALSE(can_follow(source, now));
}

TEST_F(LiveTexelsTest, APictureThatIsGoneIsNoPreview) {
    const auto loaded = loaded_layer(source);
    fs::remove(source.meshes[0].texture[0]);
    source.texture.black = 60.0;
    EXPECT_THROW(live_set(loaded, source), InputError);
}

TEST_F(LiveTexelsTest, AHandThatNeverRestsSeesSomething) {
    const auto loaded = loaded_layer(source);
    LiveSets live(make_prepared);
    for (double black = 51.0; !live.layer(loaded); black += 1e-3) {
        source.texture.black = black;
        live.want({loaded, source});
        std::this_thread::yield();
    }
    EXPECT_FALSE(live.layer(loaded)->set) << "what is followed is no final picture";
    source.texture.black = 150.0;
    while (live.layer(loaded)->source != source) live.want({loaded, source});
    EXPECT_FALSE(live.layer(loaded_layer(source))) << "of another set";
    live.forget();
    EXPECT_FALSE(live.layer(loaded));
}

class LiveWishesTest : public LiveTexelsTest {
  protected:
    void edit(const std::string& key, const Value& value) {
        document.set("layer.gas.source." + key, value, 1.0);
    }
    std::shared_ptr<const LoadedLayer> shown() const { return wishes.layer(document.scene().layers[0]); }
    void load() {
        wishes.want(document);
        wishes.loader().wait();
    }

    Document document = Document::open(folder.file("scene.toml", R"(astrosplat = 1
[[layer]]
name = "gas"
[layer.source]
meshes = [ { mesh = "plane", texture = "data.fits" } ]
black = 50.0
white = 600.0
count = 20000
)"));
    SetWishes wishes{SetCache{}, 1 << 16};
};

TEST_F(LiveWishesTest, LevelsAreFollowedAndASetIsMadeOnceTheHandRests) {
    load();
    const auto first = shown();
    ASSERT_TRUE(first && first->set);
    double now = 10.0;
    for (int step = 1; step <= 20; ++step, now += 0.1) {  // a drag of two seconds
        edit("black", 50.0 + step);
        EXPECT_FALSE(wishes.due(document, now)) << step;
        EXPECT_FALSE(wishes.wanted(document.scene()));
    }
    while (shown()->source != document.scene().layers[0].source) wishes.follow(document.scene());
    EXPECT_FALSE(shown()->set);
    EXPECT_EQ(shown()->box.lo, first->box.lo) << "the view would move";
    EXPECT_EQ(wishes.loader().layer("gas"), first) << "nothing was generated";
    EXPECT_TRUE(wishes.due(document, now + 0.4));
    load();
    EXPECT_TRUE(shown()->set);
    EXPECT_TRUE(wishes.wanted(document.scene()));
    EXPECT_TRUE(same_bits(shown()->set->color, load_source(document.scene().layers[0].source, "gas").color));
}

TEST_F(LiveWishesTest, BodiesAreReadyBeforeTheHandMoves) {
    edit("structure.kind", std::string("sheet"));
    load();
    const auto first = shown();
    ASSERT_TRUE(first && first->set && !first->columns.set);
    wishes.follow(document.scene());
    EXPECT_FALSE(wishes.prepares()) << "there is no time to spare";
    wishes.follow(document.scene(), 0, true);
    EXPECT_FALSE(wishes.following());
    while (wishes.prepares()) std::this_thread::yield();
    EXPECT_EQ(shown(), first);
    fs::remove(folder / "data.fits");  // which need not be read again
    edit("structure.depth", 0.4);
    for (int i = 0; i < 5000 && shown()->source.structure.depth != 0.4; ++i) {
        wishes.follow(document.scene());
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(shown()->source.structure.depth, 0.4);
    EXPECT_FALSE(shown()->set);
}

// Or the window would wait until something else happens.
TEST_F(LiveWishesTest, AResultIsSaidToComeUntilItIsTaken) {
    load();
    LiveSets live(make_prepared);
    edit("black", 80.0);
    const LiveRequest request{shown(), document.scene().layers[0].source};
    live.want(request);
    while (live.working()) std::this_thread::yield();
    EXPECT_EQ(live.layer(request.loaded), nullptr);
    EXPECT_TRUE(live.comes());
    live.want(request);
    EXPECT_NE(live.layer(request.loaded), nullptr);
    EXPECT_FALSE(live.comes());
    live.forget();
    EXPECT_EQ(live.layer(request.loaded), nullptr);
    live.want(request);
    EXPECT_NE(live.layer(request.loaded), nullptr) << "it is there at once";
    EXPECT_FALSE(live.comes());
}

TEST_F(LiveWishesTest, UndoneLevelsShowTheSetItself) {
    load();
    const auto first = shown();
    edit("black", 80.0);
    while (shown() == first) wishes.follow(document.scene());
    edit("black", 50.0);
    EXPECT_EQ(shown(), first);
}

TEST_F(LiveWishesTest, WhatNeedsAnotherSetIsNotFollowed) {
    load();
    const auto first = shown();
    edit("count", std::int64_t{30000});
    wishes.follow(document.scene());
    EXPECT_FALSE(wishes.following());
    EXPECT_EQ(shown(), first);
    EXPECT_FALSE(wishes.due(document, 5.0));
    edit("count", std::int64_t{40000});
    EXPECT_TRUE(wishes.due(document, 5.4)) << "it is generated again while the hand moves, too";
}

}  // namespace
}  // namespace astrosplat
