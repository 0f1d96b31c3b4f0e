// Prepared pictures and skies kept beside the sets.
#include "core/file.h"
#include "core/log.h"
#include "sets/kept.h"
#include "sets/load_source.h"
#include "source/prepared_picture.h"
#include "source/write_image.h"
#include "support/pixmap.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// source.prepare: a source that prepares its picture is one of the prepared picture, to the bit; the picture
// is kept beside the sets, and everything that reaches it reaches both names.

// Twelve stars on a slope.
std::string stars_on_a_slope() { return test::starry_pixmap({128, 96, 32, 32, 120.0, 3.0, 0.3, 2.0}); }

class PreparedSource : public testing::Test {
  protected:
    PreparedSource() {
        folder_.file("p.ppm", stars_on_a_slope());
        source_.meshes = {{"plane", {folder_ / "p.ppm"}, 0.15}};
        source_.count = 3000;
        source_.texture.prepare.stars = PrepareParams::Stars::remove;
        source_.texture.prepare.background = PrepareParams::Background::plane;
        source_.texture.prepare.ellipse = glm::dvec4(64.0, 48.0, 50.0, 40.0);
        cache_.folder = folder_ / "sets";
    }

    std::vector<fs::path> pictures() const {
        std::vector<fs::path> files = entries_of(cache_.folder);
        std::erase_if(files, [](const fs::path& file) { return file.extension() != ".exr"; });
        return files;
    }
    std::string name(const SourceParams& source) const { return recipe_of(source, "dust").name; }
    /// `source` with the picture that the command would have written.
    SourceParams by_hand(SourceParams source) const {
        const PreparedPicture ready = prepare_picture(source.meshes[0].texture, source.texture);
        EXPECT_EQ(ready.stars.size(), 12u);
        write_linear_image(folder_ / "ready.exr", without_plain_alpha(ready.image), "", Existing::replace);
        source.meshes[0].texture = {folder_ / "ready.exr"};
        source.texture.prepare = {};
        return source;
    }
    static bool same(const SplatSet& a, const SplatSet& b) {
        return a.size() == b.size() && a.position == b.position && a.color == b.color && a.alpha == b.alpha;
    }

    TempFolder folder_;
    SourceParams source_;
    SetCache cache_;
    Said said_;
};

TEST_F(PreparedSource, IsTheSourceOfThePreparedPicture) {
    for (const StructureKind kind : {StructureKind::columns, StructureKind::sheet}) {
        source_.structure.kind = kind;
        SourceParams hand = by_hand(source_);
        hand.structure.stars = StructureParams::Stars::no;
        const SplatSet set = load_source(source_, "dust");
        ASSERT_GT(set.size(), 500);
        EXPECT_TRUE(same(set, load_source(hand, "dust")));
        SourceParams plain = source_;
        plain.texture.prepare = {};
        EXPECT_FALSE(same(set, load_source(plain, "dust")));
    }
}

TEST_F(PreparedSource, KeepsItsPictureForOtherSets) {
    source_.structure.kind = StructureKind::sheet;
    const SplatSet uncached = load_source(source_, "dust");
    EXPECT_TRUE(same(load_source(cache_, source_, "dust").set, uncached));
    ASSERT_EQ(pictures().size(), 1u);
    // Another picture in its place is seen by every other set, not by the one that is kept.
    PreparedPicture other = prepare_picture(source_.meshes[0].texture, source_.texture);
    for (float& value : other.image.pixels) value *= 0.5f;
    write_linear_image(pictures()[0], other.image, "", Existing::replace);
    EXPECT_TRUE(same(load_source(cache_, source_, "dust").set, uncached));
    source_.structure.clumps = 0.5;
    EXPECT_FALSE(same(load_source(cache_, source_, "dust").set, load_source(source_, "dust")));
    EXPECT_EQ(pictures().size(), 1u);
    EXPECT_TRUE(said_.warnings.empty());
}

TEST_F(PreparedSource, DamagedPicturesArePreparedAgainWithAWarning) {
    load_meshes(cache_, source_);
    ASSERT_EQ(pictures().size(), 1u);
    fs::resize_file(pictures()[0], fs::file_size(pictures()[0]) / 2);
    const SplatSet set = load_source(cache_, source_, "dust").set;
    EXPECT_TRUE(same(set, load_source(source_, "dust")));
    EXPECT_HAS(said_.one_warning(), "; the picture is prepared again");
}

TEST_F(PreparedSource, PicturesMakeRoomForOthers) {
    load_meshes(cache_, source_);
    ASSERT_EQ(pictures().size(), 1u);
    const fs::path first = pictures()[0];
    cache_.limit_bytes = 128 * 96 * 4 * 4 + 1000;  // one of them
    source_.texture.prepare.threshold = 6.0;
    load_meshes(cache_, source_);
    ASSERT_EQ(pictures().size(), 1u);
    EXPECT_NE(pictures()[0], first);
    cache_.limit_bytes = 1000;
    source_.texture.prepare.threshold = 7.0;
    load_meshes(cache_, source_);
    EXPECT_EQ(pictures().size(), 1u) << "what is larger than the limit is not kept";
}

TEST_F(PreparedSource, EveryKeyChangesTheNames) {
    using P = PrepareParams;
    const fs::path mask = folder_.file("mask.ppm", "P6\n128 96\n255\n" + std::string(128 * 96 * 3, 'x'));
    const std::vector<std::function<void(P&)>> changes = {
        [](P&) {},
        [](P& p) { p.stars = P::Stars::keep; },
        [](P& p) { p.threshold = 6.0; },
        [](P& p) { p.saturation = 0.5; },
        [](P& p) { p.background = P::Background::level; },
        [](P& p) { p.lupton = true; },
        [](P& p) { p.lupton = true, p.q = 3.0; },
        [](P& p) { p.lupton = true, p.lupton_stretch = 0.3; },
        [](P& p) { p.ellipse->x = 63.0; },
        [](P& p) { p.ellipse = std::nullopt; },
        [](P& p) { p.turn = 5.0; },
        [](P& p) { p.feather = 0.2; },
        [](P& p) { p.alpha = glm::dvec2(0.1, 0.2); },
        [&](P& p) { p.mask = mask; },
        [&](P& p) { p.fill = mask; },
        [&](P& p) { p.align = mask; },
        [](P& p) { p = {}; },
    };
    std::vector<std::string> sets, pictures;
    for (const auto& change : changes) {
        SourceParams source = source_;
        change(source.texture.prepare);
        sets.push_back(name(source));
        pictures.push_back(prepared_recipe_text(source.meshes[0].texture, source.texture));
    }
    for (std::vector<std::string>* names : {&sets, &pictures}) {
        std::ranges::sort(*names);
        EXPECT_EQ(std::ranges::adjacent_find(*names), names->end());
    }
    source_.texture.prepare.mask = mask;
    const std::string before = name(source_);
    folder_.file("mask.ppm", "P6\n128 96\n255\n" + std::string(128 * 96 * 3, 'y'));
    EXPECT_NE(name(source_), before) << "the mask's bytes";
}

TEST_F(PreparedSource, WhatDoesNothingStaysOutOfTheNames) {
    SourceParams plain = source_;
    plain.texture.prepare = {};
    const std::string unprepared = name(plain);
    plain.texture.prepare.threshold = 7.0;
    plain.texture.prepare.q = 7.0;
    plain.texture.prepare.feather = 0.5;
    EXPECT_EQ(name(plain), unprepared);
    const std::string prepared = name(source_);
    source_.texture.prepare.q = 7.0;
    EXPECT_EQ(name(source_), prepared);
}

TEST_F(PreparedSource, BodiesLookForStarsUnlessThoseWereRemovedOrTheSourceSays) {
    using Stars = StructureParams::Stars;
    source_.structure.kind = StructureKind::disk;
    const auto finds = [&](PrepareParams::Stars removed, Stars said) {
        source_.texture.prepare.stars = removed;
        source_.structure.stars = said;
        return finds_stars(source_);
    };
    EXPECT_TRUE(finds(PrepareParams::Stars::keep, Stars::automatic));
    EXPECT_FALSE(finds(PrepareParams::Stars::keep, Stars::no));
    EXPECT_FALSE(finds(PrepareParams::Stars::remove, Stars::automatic));
    EXPECT_TRUE(finds(PrepareParams::Stars::remove, Stars::yes));
    const std::string said = name(source_);
    source_.structure.stars = Stars::automatic;
    EXPECT_NE(name(source_), said);
    source_.structure.stars = Stars::no;
    const std::string off = name(source_);
    source_.structure.stars = Stars::automatic;
    EXPECT_EQ(name(source_), off) << "it is the same set";
    source_.texture.prepare.threshold = 1e6;   // all stay
    source_.structure.most_texels = 128 * 96;  // where it is enlarged, they are knots
    const SplatSet without = load_source(source_, "dust");
    source_.structure.stars = Stars::yes;
    EXPECT_FALSE(same(load_source(source_, "dust"), without));
}

TEST_F(PreparedSource, RefusesMasksOfAnotherSize) {
    const fs::path small = folder_.file("small.ppm", "P6\n16 16\n255\n" + std::string(16 * 16 * 3, 'x'));
    source_.texture.prepare.mask = small;
    EXPECT_EQ(ERROR_OF(load_source(source_, "dust")),
              "layer 'dust': prepare.mask:" + small.string() +
                  ": expected 128x96 px like the picture, found 16x16 px");
    source_.texture.prepare.mask.clear();
    source_.texture.prepare.fill = small;
    EXPECT_HAS(ERROR_OF(load_source(source_, "dust")), "prepare.fill:");
}

TEST_F(PreparedSource, RefusesToAlignWhatHasNoSky) {
    source_.texture.prepare.align = folder_ / "p.ppm";
    EXPECT_EQ(ERROR_OF(load_source(source_, "dust")),
              "layer 'dust': " + (folder_ / "p.ppm").string() +
                  ": expected a FITS picture whose header tells the sky, found none");
}

// Skies of one picture are kept beside the sets, to the bit, under a name that everything enters
// that makes them.

class KeptSky : public testing::Test {
  protected:
    KeptSky() {
        folder_.file("p.ppm", picture(120.0));
        cache_.folder = folder_ / "sets";
        tiling_.height_deg = 40.0;
        tiling_.face_px = 32;
    }
    static std::string picture(double light) {
        return test::starry_pixmap({64, 48, 16, 16, light, 3.0, 0.3, 2.0});
    }
    std::array<Image, 6> sky() const { return kept_skies(cache_)(folder_ / "p.ppm", tiling_, {}); }
    std::array<Image, 6> made() const { return tiled_sky_of(folder_ / "p.ppm", tiling_); }
    bool kept() const { return is_kept(cache_, folder_ / "p.ppm", tiling_); }

    static void expect_same(const std::array<Image, 6>& a, const std::array<Image, 6>& b) {
        for (std::size_t f = 0; f < 6; ++f) {
            EXPECT_EQ(a[f].width, b[f].width);
            EXPECT_EQ(a[f].channels, b[f].channels);
            EXPECT_EQ(a[f].pixels, b[f].pixels) << f;
        }
    }

    TempFolder folder_;
    SetCache cache_;
    SkyTiling tiling_;
    Said said_;
};

TEST_F(KeptSky, IsTheOneThatWasMadeToTheBit) {
    EXPECT_FALSE(kept());
    expect_same(sky(), made());
    EXPECT_TRUE(kept());
    ASSERT_EQ(entries_of(cache_.folder).size(), 1u);
    expect_same(sky(), made());
    EXPECT_TRUE(said_.warnings.empty());
}

TEST_F(KeptSky, IsReadAndNotMadeAgain) {
    sky();
    const std::vector<fs::path> first = entries_of(cache_.folder);
    SkyTiling other = tiling_;
    other.seed = 2;
    kept_skies(cache_)(folder_ / "p.ppm", other, {});
    std::vector<fs::path> second = entries_of(cache_.folder);
    std::erase(second, first.at(0));
    // Another sky under the first one's name: what is read is what lies there.
    fs::copy_file(second.at(0), first.at(0), fs::copy_options::overwrite_existing);
    expect_same(sky(), tiled_sky_of(folder_ / "p.ppm", other));
}

TEST_F(KeptSky, EverythingThatMakesItIsInItsName) {
    const fs::path file = folder_ / "p.ppm";
    const std::string own = sky_recipe_text(file, tiling_);
    SkyTiling seeded = tiling_, higher = tiling_, larger = tiling_;
    seeded.seed = 2, higher.height_deg = 41.0, larger.face_px = 64;
    for (const SkyTiling& other : {seeded, higher, larger}) EXPECT_NE(sky_recipe_text(file, other), own);
    folder_.file("q.ppm", picture(120.0));
    EXPECT_EQ(sky_recipe_text(folder_ / "q.ppm", tiling_), own) << "names of files stay out";
    folder_.file("q.ppm", picture(121.0));
    EXPECT_NE(sky_recipe_text(folder_ / "q.ppm", tiling_), own);
    EXPECT_EQ(sky_recipe_text(folder_ / "none.ppm", tiling_), "");
}

TEST_F(KeptSky, ThatIsDamagedIsMadeAgain) {
    sky();
    const fs::path file = entries_of(cache_.folder).at(0);
    fs::resize_file(file, fs::file_size(file) / 2);
    expect_same(sky(), made());
    EXPECT_HAS(said_.one_warning(), "the sky is made again");
    expect_same(sky(), made());
    EXPECT_EQ(said_.warnings.size(), 1u);
}

TEST_F(KeptSky, IsMadeWithoutACache) {
    cache_.folder.clear();
    expect_same(sky(), made());
    EXPECT_FALSE(kept());
    EXPECT_FALSE(fs::exists(folder_ / "sets"));
}

}  // namespace
}  // namespace astrosplat
