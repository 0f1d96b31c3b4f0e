// The first scene of a picture: what it was taken for, and its making again as a person chooses.
#include "edit/picture_start.h"

#include "core/file.h"
#include "scene/load.h"
#include "support/test.h"

namespace astrosplat {
namespace {

class PictureStartTest : public testing::Test {
  protected:
    TempFolder folder;
    fs::path place = folder / "spiral.toml";
    PictureStart start{ASTROSPLAT_SOURCE_DIR "/assets/textures/spiral.jpg"};

    Scene made() { return parse_scene(picture_start_text(start, place), place); }
    void choose(const char* choice) { start = chosen_start(start, choice); }
};

TEST_F(PictureStartTest, SaysWhatAPictureWasTakenForAndWhy) {
    const Scene scene = made();
    EXPECT_EQ(start.object, SkyObject::galaxy);
    EXPECT_EQ(scene.layers[0].source.structure.kind, StructureKind::disk);
    EXPECT_EQ(start.guesses.front().object, SkyObject::galaxy);
    EXPECT_EQ(start.seen, "seen face-on");
    EXPECT_HAS(start.because, "colours of stars");
    EXPECT_HAS(start.because, "how it lies is unsure");
    EXPECT_TRUE(scene.animation.empty());
}

TEST_F(PictureStartTest, AnotherKindIsMadeAndWhatWasFoundStays) {
    made();
    const std::size_t found = start.guesses.size();
    choose("nebula");
    EXPECT_NE(made().layers[0].source.structure.kind, StructureKind::disk);
    EXPECT_EQ(start.object, SkyObject::nebula);
    EXPECT_EQ(start.guesses.size(), found);
    EXPECT_EQ(start.because, "you say so");
    EXPECT_HAS(ERROR_OF(choose("teapot")), "teapot");
}

TEST_F(PictureStartTest, AFilmMovesTheCamera) {
    choose("film");
    EXPECT_FALSE(made().animation.empty());
    choose("still");
    EXPECT_TRUE(made().animation.empty());
}

TEST_F(PictureStartTest, PartedStarsAreALayerOfTheirOwn) {
    choose("part");
    const Scene scene = made();
    ASSERT_EQ(scene.layers.size(), 2u);
    EXPECT_EQ(scene.layers[0].source.texture.prepare.stars, PrepareParams::Stars::remove);
    EXPECT_EQ(scene.layers[1].source.kind, SourceKind::stars);
    EXPECT_EQ(scene.layers[1].source.stars.like, scene.layers[0].name);
    EXPECT_TRUE(fs::exists(folder / "spiral_stars.csv"));
    choose("keep");
    EXPECT_EQ(made().layers.size(), 1u);
}

}  // namespace
}  // namespace astrosplat
