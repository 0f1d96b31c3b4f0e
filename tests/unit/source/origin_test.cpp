// The words on a layer's origin, kind by kind.
#include "source/origin.h"

#include "support/test.h"

namespace astrosplat {
namespace {

constexpr const char* begins = "measured: light and colours, as the picture's camera sees them; modelled: ";
constexpr const char* invents = "; invented: each splat's place within that depth, all backs";
constexpr const char* hides = ", arms and clouds along the line of sight, the dust's far side";

SourceParams bodies(StructureKind kind) {
    SourceParams source;
    source.structure.kind = kind;
    return source;
}

TEST(Origin, OfAGalaxyTellsHowItLiesAndWhatOfItsPlaneIsHidden) {
    SourceParams source = bodies(StructureKind::disk);
    GalaxyParams& galaxy = source.structure.galaxy;
    const auto lies = [&](const std::string& words) { return begins + ("depths, by " + words) + invents; };
    EXPECT_EQ(origin_of(source), lies("a disk and a spheroid, in the picture's plane"));
    galaxy.inclination = 66.0;
    EXPECT_EQ(origin_of(source), lies("a disk and a spheroid, inclined by 66.0 degrees"));
    galaxy.inclination = 66.1;
    EXPECT_EQ(origin_of(source), lies("a disk and a spheroid, inclined by 66.1 degrees") + hides);
    galaxy.inclination = {};
    EXPECT_EQ(origin_of(source), lies("a disk and a spheroid, inclined by what the picture tells") + hides);
    galaxy.bulge = 1.0;
    EXPECT_EQ(origin_of(source), lies("a spheroid"));
    source.structure.galaxies = {GalaxyParams{}, GalaxyParams{80.0, 0.0, {}, 90.0, {}}};
    EXPECT_EQ(origin_of(source), lies("the disks and spheroids of 2 galaxies") + hides);
}

TEST(Origin, OfOtherBodiesNamesTheirModel) {
    EXPECT_HAS(origin_of(bodies(StructureKind::walls)), "by two walls, the farther apart the brighter;");
    EXPECT_HAS(origin_of(bodies(StructureKind::sheet)), "by a sheet, the nearer the brighter;");
    SourceParams axis = bodies(StructureKind::axis);
    EXPECT_HAS(origin_of(axis), "by rings about an axis, tilted by what the picture tells,");
    axis.structure.tilt = -12.0;
    EXPECT_HAS(origin_of(axis), "tilted by -12.0 degrees,");
    for (const StructureKind kind : {StructureKind::walls, StructureKind::sheet, StructureKind::axis})
        EXPECT_EQ(origin_of(bodies(kind)).find(hides), std::string::npos);
}

TEST(Origin, CountsWhatIsBeyondTheFrameOnceTheSetIsMade) {
    SourceParams source = bodies(StructureKind::sheet);
    EXPECT_FALSE(origin_of(source).ends_with("frame"));
    EXPECT_TRUE(origin_of(source, ShareBeyond{}).ends_with("all backs"));
    source.structure.margin = 0.1;
    EXPECT_TRUE(origin_of(source).ends_with("all backs, all beyond the frame"));
    EXPECT_TRUE(origin_of(source, ShareBeyond{0.304, 0.026})
                    .ends_with("all beyond the frame (30 % of the splats, 3 % of the light)"));
}

TEST(Origin, OfColumnsStarsAndFiles) {
    SourceParams source;
    EXPECT_EQ(origin_of(source),
              "measured: colours, those of the pictures; invented: all places, around the meshes");
    source.kind = SourceKind::splats;
    EXPECT_EQ(origin_of(source), "") << "the file says it itself";
    source.kind = SourceKind::stars;
    EXPECT_EQ(origin_of(source), "measured: light and places, those of the catalogue");
    source.stars.like = "gas";
    EXPECT_EQ(origin_of(source),
              "measured: light and places in the picture, those of its table; invented: depths");
    source.stars.along = "camera";
    EXPECT_EQ(origin_of(source), "invented: all stars");
}

}  // namespace
}  // namespace astrosplat
