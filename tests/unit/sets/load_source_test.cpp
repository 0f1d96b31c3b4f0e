// Sets of sources: whole, and what is seen before that.
#include "sets/load_source.h"

#include "bodies/bodies.h"
#include "sets/kept.h"
#include "sets/set_sample.h"
#include "source/textured_mesh.h"
#include "splat_files/native.h"
#include "splat_files/splat_file.h"
#include "support/pixmap.h"
#include "support/splats.h"
#include "support/test.h"
#include "support/test_data.h"
#include "unit/splat_files/file_support.h"

namespace astrosplat {
namespace {

// The front door: built-in meshes, a mesh's own pictures, splat files, and its messages.

class LoadSourceTest : public SplatFileTest {
  protected:
    static std::string error_of(const SourceParams& source) { return ERROR_OF(load_source(source, "dust")); }
    static SourceParams mesh_source(const fs::path& mesh, std::vector<fs::path> texture = {}) {
        SourceParams source;
        source.meshes.push_back({mesh, std::move(texture), 0.15});
        source.count = 5000;
        return source;
    }

    SourceParams sheet_of_gas(int width, int height) const {
        const std::string pixels = test::pixmap(
            width, height, [&](int x, int y, int k) { return 40 + (3 * (y * width + x) + k) * 7 % 60; });
        SourceParams source = mesh_source("plane", {write("gas.ppm", pixels)});
        source.count = 0;
        source.structure.kind = StructureKind::sheet;
        return source;
    }

    Said said_;
};

TEST_F(LoadSourceTest, StarsComeFromACatalogue) {
    SourceParams source;
    source.kind = SourceKind::stars;
    source.stars.catalogue =
        write("near.csv", "ra,dec,dist,mag\n0,0,10,1\n90,0,10,5.5\n0,90,0,2\n0,90,,2\n0,90,x,2\n0,0,10,9\n");
    source.stars.unit = 2.0;
    source.stars.limit = 6.0;
    const SplatSet set = load_source(source, "sky");
    ASSERT_EQ(set.size(), 4);
    EXPECT_TRUE(set.stars);
    EXPECT_EQ(set.position[0], glm::vec3(20.0f, 0.0f, 0.0f));
    EXPECT_EQ(set.radius[0], 0.0f);
    const std::string file = source.stars.catalogue.string();
    EXPECT_HAS(said_.text(),
               "layer 'sky': " + file +
                   ": 1 of 6 rows cannot be used, at line 6 (line 6: expected a number for the distance, "
                   "found 'x')\n");
    EXPECT_HAS(said_.text(),
               "layer 'sky': 4 stars, 1 fainter than magnitude 6 left out, 2 without a distance at "
               "infinity\n");
}

TEST_F(LoadSourceTest, StarsAreScatteredAlongTheCamera) {
    SourceParams source;
    source.kind = SourceKind::stars;
    source.stars.along = "camera";
    source.stars.path = {{0, 0, 0}, {50, 0, 0}};
    source.stars.spread = 5.0;
    source.count = 3000;
    const SplatSet set = load_source(source, "sky");
    ASSERT_EQ(set.size(), 3000);
    EXPECT_TRUE(set.stars);
    EXPECT_NEAR(bounds(set).hi.x, 54.0, 1.0);
    EXPECT_NE(load_source(source, "other").position[0], set.position[0]);
    source.seed = 5;
    EXPECT_EQ(load_source(source, "other").position[0], load_source(source, "sky").position[0]);
    source.stars.catalogue = write("red.csv", "ra,dec,dist,mag,bv\n0,0,10,1,1.9\n0,0,,1,0\n0,0,10,13,0\n");
    for (const glm::vec3& color : load_source(source, "sky").color) EXPECT_GT(color.x, color.z);
    EXPECT_HAS(said_.text(),
               "layer 'sky': 3 k random stars within 5 of the camera's path, of 1 star of the catalogue\n");
    source.stars.catalogue = write("far.csv", "ra,dec,dist,mag\n0,0,,1\n");
    EXPECT_HAS(error_of(source), "expected stars of magnitude 12 or brighter with a distance, found none");
    source.stars.path.clear();
    EXPECT_HAS(error_of(source), "camera");
}

TEST_F(LoadSourceTest, ACatalogueThatIsNoneIsRefused) {
    SourceParams source;
    source.kind = SourceKind::stars;
    source.stars.catalogue = write("none.csv", "");
    EXPECT_EQ(error_of(source), "layer 'dust': " + source.stars.catalogue.string() +
                                    ": expected a star catalogue, found an empty file");
}

TEST_F(LoadSourceTest, ALimitMayLeaveNoStar) {
    SourceParams source;
    source.kind = SourceKind::stars;
    source.stars.catalogue = write("faint.csv", "ra,dec,mag\n1,2,13\n");
    EXPECT_EQ(load_source(source, "dust").size(), 0);
    EXPECT_HAS(said_.text(), "0 stars, 1 fainter than magnitude 12 left out");
}

TEST_F(LoadSourceTest, NeedsAMesh) {
    EXPECT_EQ(error_of(SourceParams()),
              "layer 'dust': source.meshes: expected at least one mesh, found none");
}

TEST_F(LoadSourceTest, MeshesWithoutPicturesAreNeutralGrey) {
    const auto obj = write("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    for (const fs::path& mesh : {fs::path("sphere"), fs::path(obj)}) {
        SourceParams source = mesh_source(mesh);
        source.count = 2000;
        const SplatSet set = load_source(source, "dust");
        ASSERT_GT(set.size(), 0);
        for (std::size_t i = 0; i < set.color.size(); ++i) {
            EXPECT_EQ(set.color[i], glm::vec3(0.18f));
            EXPECT_EQ(set.alpha[i], 1.0f);
        }
    }
}

TEST_F(LoadSourceTest, BodiesKeepToTexelsAndSplats) {
    SourceParams source = sheet_of_gas(120, 80);
    const std::int64_t all = load_source(source, "gas").size();
    ASSERT_GT(all, 8000);
    source.structure.most_texels = 480 * 320 / 4;  // of the enlarged picture
    const std::int64_t few = load_source(source, "gas").size();
    EXPECT_LT(few, all / 3);
    EXPECT_GT(few, all / 6);
    source.structure.most_texels = 0;
    source.splats = 2000;
    EXPECT_LE(load_source(source, "gas").size(), 2000);
    EXPECT_HAS(said_.text(), "would be more than");
}

TEST_F(LoadSourceTest, LargePicturesAreReducedWhileTheyAreRead) {
    SourceParams source = sheet_of_gas(1300, 900);
    source.structure.most_texels = 90'000;
    const auto plan = [&](std::int64_t most_texels) {
        return plan_bodies(source, load_meshes(source, {}, {make_prepared, {}, most_texels}), "gas");
    };
    const BodiesPlan afterwards = plan(0), while_read = plan(most_texels_read(source, std::int64_t{1} << 40));
    EXPECT_EQ(while_read.meshes[0].textures[0].image.width, 361);
    EXPECT_EQ(while_read.meshes[0].textures[0].image.pixels, afterwards.meshes[0].textures[0].image.pixels);
    EXPECT_TRUE(while_read.fits_memory);
    const std::int64_t within = most_texels_read(source, 2'600'000);  // less than the scene asks for
    EXPECT_LT(within, 50'000);
    EXPECT_GT(within, 40'000);
    BodiesPlan smaller = plan(within);
    EXPECT_FALSE(smaller.fits_memory);
    reduce_pictures(smaller.meshes, smaller.structure, {2'600'000, 0}, "gas");
    EXPECT_HAS(said_.text(), "a picture of 1300x900 px is reduced to");
    source.structure.kind = StructureKind::columns;
    EXPECT_EQ(most_texels_read(source, 2'600'000), 0);
}

TEST_F(LoadSourceTest, BodiesOfAMarginLieBeyondThePictureAndTheOthersWhereTheyWere) {
    SourceParams source = sheet_of_gas(120, 80);
    source.structure.margin = 0.1;
    const SplatSet set = load_source(source, "gas");
    std::int64_t outside = 0;
    for (std::size_t i = 0; i < set.uv.size(); ++i) {
        // A plane of 10 units by 6.67, whose picture reads along +x and -z.
        ASSERT_NEAR(set.position[i].x, (set.uv[i].x - 0.5f) * 10.0f, 1e-4f) << i;
        ASSERT_NEAR(set.position[i].z, (0.5f - set.uv[i].y) * 10.0f * 80.0f / 120.0f, 1e-4f) << i;
        if (set.uv[i].x < 0.0f || set.uv[i].x > 1.0f || set.uv[i].y < 0.0f || set.uv[i].y > 1.0f) ++outside;
    }
    const std::string share =
        fmt::format("{:.0f} % of the splats", 100.0 * double(outside) / double(set.size()));
    EXPECT_HAS(set.origin, "beyond the frame (" + share);
    EXPECT_GT(outside, set.size() / 50);
    EXPECT_LT(outside, set.size() / 2);
    EXPECT_NEAR(bounds(set).extent().x, 12.0, 0.5);
}

// A plane of 10 units by 6.67.
TEST_F(LoadSourceTest, AutomaticHeightAndWidthAreReported) {
    SourceParams source = sheet_of_gas(120, 80);
    EXPECT_NEAR(automatic_values(source).body_height, 0.011 * 10.0, 1e-4);
    EXPECT_EQ(automatic_values(source).uv_width, 0.0) << "the mesh's own";
    source.structure.kind = StructureKind::disk;
    EXPECT_NEAR(automatic_values(source).body_height, 0.018 * 10.0, 1e-4);
    source.structure.margin = 0.1;  // a disk that goes on is larger
    EXPECT_NEAR(automatic_values(source).body_height, 0.018 * 11.0, 1e-4);
    const SplatSet automatic = load_source(source, "gas");
    source.structure.height = automatic_values(source).body_height;
    const SplatSet given = load_source(source, "gas");
    EXPECT_EQ(automatic_values(source).body_height, 0.0) << "nothing is automatic any more";
    EXPECT_NEAR(bounds(given).extent().y / bounds(automatic).extent().y, 1.0, 1e-3);

    SourceParams planar = mesh_source("sphere", source.meshes[0].texture);
    planar.uv = UvMode::planar_xy;
    const double diameter = bounds(load_meshes(planar)).extent().x;
    EXPECT_NEAR(automatic_values(planar).uv_width, diameter, 1e-9);
    planar.uv_width = 3.0;
    EXPECT_EQ(automatic_values(planar).uv_width, 0.0);
}

TEST_F(LoadSourceTest, AMarginOfAnotherMeshThanAPlaneIsNamed) {
    SourceParams source = mesh_source("sphere", {write("gas.ppm", "P6\n2 1\n255\nabcdef")});
    source.count = 0;
    source.structure.kind = StructureKind::sheet;
    source.structure.margin = 0.1;
    load_source(source, "gas");
    EXPECT_HAS(said_.text(), "layer 'gas': source.structure.margin acts on planes only, not on 'sphere'");
}

TEST_F(LoadSourceTest, SplatFilesAreSortedAndKnowTheirLargestDistance) {
    SplatSet set;
    for (int i = 0; i < 4; ++i) {
        add_splat(set, glm::vec3(float(i)), glm::vec3(0.5f), 1.0f);
        set.distance.back() = 0.25f * float(i);
        set.id.back() = std::uint64_t(10 - i);
    }
    SourceParams source;
    source.kind = SourceKind::splats;
    source.file = path("set.pda");
    write_splats(source.file, set);
    const SplatSet read = load_source(source, "dust");
    ASSERT_EQ(read.size(), 4);
    EXPECT_EQ(read.id[0], 7u);
    EXPECT_EQ(read.position[0], glm::vec3(3.0f));
    EXPECT_EQ(read.max_distance, 0.75);
}

TEST_F(LoadSourceTest, PlaneTakesThePicturesAspectAndSaysWhatWasChosen) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(picture, "images/m101_heic0602a.jpg");  // 1920 x 1200
    SourceParams source = mesh_source("plane", {picture});
    const SplatSet set = load_source(source, "dust");
    const Bounds box = bounds(set);
    EXPECT_NEAR(box.extent().x, 10.4, 0.3);  // the longer side, and 2 % on either side
    EXPECT_NEAR(box.extent().z, 6.65, 0.3);
    EXPECT_NEAR(double(set.size() + set.zero_alpha), 5000.0, 750.0);
    EXPECT_HAS(said_.text(), "layer 'dust': ");
    EXPECT_HAS(said_.text(), "max distance 0.2");
    const SplatSet other = load_source(source, "stars");  // another name, another seed
    EXPECT_NE(other.position[0], set.position[0]);
}

TEST_F(LoadSourceTest, MeshesBringTheirOwnPicture) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(mesh, "meshes/smallbodies/phobos.obj");
    const SplatSet set = load_source(mesh_source(mesh), "phobos");
    EXPECT_NEAR(double(set.size()), 5000.0, 1000.0);
    EXPECT_GT(set.color[0].x, 0.0f);
}

TEST_F(LoadSourceTest, MeshesWithoutUvNeedAProjection) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(mesh, "meshes/smallbodies/216Kleopatra.obj");
    ASTROSPLAT_TEST_DATA_OR_SKIP(picture, "images/sh2-106.png");
    SourceParams source = mesh_source(mesh, {picture});
    EXPECT_HAS(error_of(source), "216Kleopatra.obj");
    source.uv = UvMode::planar_xz;
    const std::vector<TexturedMesh> meshes = load_meshes(source);
    EXPECT_EQ(meshes[0].textures[0].wrap, TextureSettings::Wrap::clamp);
    EXPECT_GT(load_source(source, "dust").size(), 0);
}

// Samples of sets: rows of what is kept, and of what is not, splats as wide as those of the whole set.

class SetSampleTest : public testing::Test {
  protected:
    SetSampleTest() {
        folder_.file("p.ppm", test::pixmap(640, 480, [](int column, int row, int k) {
                         const int x = column - 320, y = row - 240;
                         const bool lit = x * x + y * y < 200 * 200;
                         return lit ? 200 - 50 * k + int(50.0 * std::sin(0.02 * x * y)) : 0;
                     }));
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
        return sum / double(set.size());
    }
    /// Of all discs together.
    static double area(const SplatSet& set, double each) {
        double sum = 0.0;
        for (const float radius : set.radius) sum += double(radius) * radius;
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
        EXPECT_EQ(sample->making.seconds, 0.0);
        EXPECT_NEAR(double(sample->splats), double(whole.size()), 0.02 * double(whole.size()));
        EXPECT_LT(sample->set.size(), 0.75 * double(whole.size()));
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
        const double rows = 0.05 * double(usual.set.size());
        EXPECT_NEAR(double(small.set.size()), rows, 0.05 * rows);
        EXPECT_NEAR(double(small.splats), double(usual.splats), 0.03 * double(usual.splats));
    }
}

TEST_F(SetSampleTest, OfWhatIsNotKeptItIsMadeAsWide) {
    for (const SourceParams& source : {columns_, bodies_}) {
        const SetSample sample = sample_set(cache_, source, "a");
        EXPECT_FALSE(fs::exists(cache_.folder));
        const SplatSet whole = load_source(source, "a");
        const auto splats = double(whole.size());
        EXPECT_GT(sample.making.seconds, 0.0);
        EXPECT_NEAR(double(sample.splats), splats, 0.15 * splats);
        EXPECT_GT(sample.each(), 1.3);
        // A smaller picture has fewer sizes of splats; were the rest not made narrower, they would cover 1.5
        // times as much.
        EXPECT_LE(area(sample.set, sample.each()), 1.1 * area(whole, 1.0));
        EXPECT_GE(area(sample.set, sample.each()), 0.5 * area(whole, 1.0));
        EXPECT_NEAR(glm::length(sample.set.spacing), glm::length(whole.spacing),
                    0.01 * glm::length(whole.spacing));
    }
}

// While its quick body is seen: of all, and of the limit that it has.
TEST_F(SetSampleTest, ALargePictureTellsWhatItsBodiesTake) {
    SourceParams source = bodies_;
    source.structure.most_texels = 0;
    const auto told = [&] {
        Making last;
        show_quick_sets({}, source, "a",
                        {1000, true, [&](const SetSample& sample) { last = sample.making; }});
        return last;
    };
    const Making whole = told();
    const auto splats = double(load_source(source, "a").size());
    EXPECT_NEAR(double(whole.splats), splats, 0.2 * splats);
    EXPECT_EQ(whole.whole_splats, whole.splats);
    EXPECT_GT(whole.seconds, 0.0);
    EXPECT_GT(whole.bytes, 68 * whole.splats) << "which the set alone takes";
    source.splats = whole.splats / 4;
    const Making quarter = told();
    EXPECT_EQ(quarter.splats, source.splats);
    EXPECT_EQ(quarter.whole_splats, whole.splats);
    EXPECT_NEAR(double(quarter.bytes), 0.25 * double(whole.bytes), 1e-5 * double(whole.bytes));
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
    EXPECT_NEAR(double(sample->set.size()), 100000.0, 4.0);
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

// Before its bodies are made, a picture is seen as it is: in its place, the right way round, in its colours.

class FlatStartTest : public SplatFileTest {
  protected:
    /// The left third is red, the rest blue; the lower half is darker.
    SourceParams picture(int width, int height) const {
        const std::string pixels = test::pixmap(width, height, [&](int x, int y, int k) {
            return k == (x < width / 3 ? 0 : 2) ? (y < height / 2 ? 120 : 60) : 0;
        });
        SourceParams source;
        source.meshes.push_back({"plane", {write("picture.ppm", pixels)}, 0.0});
        source.structure.kind = StructureKind::sheet;
        return source;
    }
};

TEST_F(FlatStartTest, APictureIsSeenInItsPlaceBeforeItsBodiesAre) {
    const SplatSet flat = flat_picture(load_meshes(picture(300, 200)));
    ASSERT_GT(flat.size(), 20000);
    EXPECT_LE(flat.size(), 1 << 16);
    EXPECT_FALSE(flat.generated) << "which looks take for a lattice";
    double light[2] = {};
    for (std::size_t i = 0; i < flat.id.size(); ++i) {
        ASSERT_EQ(flat.id[i], i);
        ASSERT_NEAR(flat.position[i].y, 0.0f, 1e-5f);
        light[flat.uv[i].y > 0.5f ? 1 : 0] += double(flat.alpha[i]);
        if (std::fabs(flat.uv[i].x - 1.0f / 3.0f) < 0.01f) continue;
        const bool red = flat.uv[i].x < 1.0f / 3.0f;
        ASSERT_EQ(flat.color[i].r > 0.5f, red) << "at " << flat.uv[i].x;
        ASSERT_EQ(flat.color[i].b > 0.5f, !red);
        ASSERT_NEAR(flat.position[i].x, 10.0f * (flat.uv[i].x - 0.5f), 1e-3f);
    }
    EXPECT_GT(light[1], 2.0 * light[0]);
}

TEST_F(FlatStartTest, LargePicturesAreSeenWithAsManySplats) {
    const SplatSet flat = flat_picture(load_meshes(picture(1200, 700)));
    EXPECT_GT(flat.size(), 20000);
    EXPECT_LE(flat.size(), 1 << 16);
    EXPECT_NEAR(bounds(flat).hi.x, 5.0, 0.02);
}

/// What is shown of a source, in order.
std::vector<SetSample> quick_sets(const SetCache& cache, const SourceParams& source, bool flat = true) {
    std::vector<SetSample> shown;
    show_quick_sets(cache, source, "gas",
                    {1000, flat, [&](SetSample sample) { shown.push_back(std::move(sample)); }});
    return shown;
}

TEST_F(FlatStartTest, AQuickBodyStandsForTheSetUntilItIsThere) {
    SourceParams source = picture(900, 600);
    write("picture.ppm", test::pixmap(900, 600, [](int x, int y, int k) { return (x * (k + 1) ^ y) & 127; }));
    source.structure.margin = 0.1;
    const TempFolder folder;
    const SetCache cache{folder / "sets"};
    const std::vector<SetSample> shown = quick_sets(cache, source);
    ASSERT_EQ(shown.size(), 2u);
    const SplatSet &flat = shown[0].set, &quick = shown[1].set, whole = load_source(cache, source, "gas").set;
    EXPECT_LT(bounds(flat).extent().y, 1e-4);
    EXPECT_NEAR(bounds(quick).extent().y, bounds(whole).extent().y, 0.3 * bounds(whole).extent().y);
    EXPECT_NEAR(bounds(quick).extent().x, bounds(whole).extent().x, 0.1 * bounds(whole).extent().x);
    EXPECT_LT(3 * quick.size(), whole.size());
    const auto covers = [](const SplatSet& set) {
        double area = 0.0;
        for (std::size_t i = 0; i < set.id.size(); ++i)
            area += double(set.alpha[i]) * double(set.radius[i]) * double(set.radius[i]);
        return area;
    };
    EXPECT_NEAR(covers(quick) / covers(whole), 1.0, 0.35) << "as wide as few splats must be";
    EXPECT_EQ(quick_sets({}, source, false).size(), 1u) << "a body before is better than a flat picture";
    EXPECT_TRUE(quick_sets(cache, source).empty())
        << "a kept one is there before a few of it were more than blotches";
    source.structure.kind = StructureKind::columns;
    source.count = 2000000;
    const std::vector<SetSample> columns = quick_sets({}, source);
    ASSERT_EQ(columns.size(), 1u);
    EXPECT_GT(columns[0].each(), 3.0);
    source.count = 2000;
    EXPECT_TRUE(quick_sets({}, source).empty()) << "it takes no time";
}

}  // namespace
}  // namespace astrosplat
