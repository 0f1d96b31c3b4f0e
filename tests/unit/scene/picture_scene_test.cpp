#include "scene/new_scene.h"

#include "prepare/star_removal.h"
#include "scene/animate.h"
#include "scene/load.h"
#include "scene/save.h"
#include "source/textured_mesh.h"
#include "support/pixmap.h"
#include "support/test.h"

namespace astrosplat {
namespace {

Scene parsed(const PictureScene& picture) {
    const std::string text = picture_scene_text(picture, "scenes/a.toml");
    Scene scene = parse_scene(text, "scenes/a.toml");
    EXPECT_EQ(save_text(scene, text, "scenes/a.toml"), text) << "saving changes nothing";
    return scene;
}

TEST(PictureScene, BeginsWithThePictureAsItIs) {
    for (const auto& [width, height] : {std::pair(1600, 1000), std::pair(500, 1000), std::pair(3001, 3001)}) {
        const Scene scene = parsed({"pictures/51 M\xC3\xB6we.png", width, height, StructureKind::walls});
        EXPECT_EQ(scene.layers.at(0).name, "M_we");
        EXPECT_EQ(scene.layers[0].source.meshes.at(0).texture.at(0), "pictures/51 M\xC3\xB6we.png");
        EXPECT_EQ(scene.layers[0].source.structure.kind, StructureKind::walls);
        EXPECT_EQ(std::max(scene.output.width, scene.output.height), 1920);
        EXPECT_EQ(scene.output.width % 2, 0);
        EXPECT_EQ(scene.output.height % 2, 0);
        const double aspect = double(width) / double(height);
        EXPECT_NEAR(double(scene.output.width) / double(scene.output.height), aspect, 0.002 * aspect);
        // The part of the plane that the camera sees; the plane is 10 units along its longer side.
        const double seen =
            2.0 * scene.camera.position->y * std::tan(0.5 * scene.camera.fov * 3.14159265358979 / 180.0);
        EXPECT_NEAR(seen, aspect >= 1.0 ? 10.0 / aspect : 10.0, 1e-4);
        EXPECT_TRUE(scene.animation.empty());
        const UvCamera& took = scene.layers[0].source.uv_camera;
        EXPECT_EQ(scene.layers[0].source.uv, UvMode::camera);
        EXPECT_EQ(took.position, scene.camera.position);
        EXPECT_EQ(took.target, scene.camera.target);
        EXPECT_EQ(took.up, scene.camera.up);
        EXPECT_EQ(took.fov, scene.camera.fov);
    }
}

// The picture's longer side is 10 units.
TEST(PictureScene, HasAScaleWhereThePicturesPixelsHaveALength) {
    PictureScene picture{"a.png", 1600, 1000};
    EXPECT_EQ(parsed(picture).light_years_per_unit, 0.0);
    EXPECT_EQ(picture_scene_text(picture, "a.toml").find("[scene]"), std::string::npos);
    picture.light_years_per_px = 20.0;
    EXPECT_EQ(parsed(picture).light_years_per_unit, 3200.0);
    EXPECT_NE(picture_scene_text(picture, "a.toml").find("# the picture is 32 kly wide"), std::string::npos);
    std::swap(picture.width_px, picture.height_px);
    EXPECT_EQ(parsed(picture).light_years_per_unit, 3200.0);
    EXPECT_NE(picture_scene_text(picture, "a.toml").find("# the picture is 20 kly wide"), std::string::npos);
}

TEST(PictureScene, StarsThatWereTakenOutAreALayerOfTheirOwn) {
    PictureScene picture{"ready/picture.exr", 960, 600, StructureKind::sheet};
    EXPECT_EQ(parsed(picture).layers.size(), 1u);
    picture.stars = "ready/stars.csv";
    picture.star_px = 1.25;
    const Scene scene = parsed(picture);
    ASSERT_EQ(scene.layers.size(), 2u);
    EXPECT_EQ(scene.layers[0].source.structure.stars, StructureParams::Stars::no)
        << "each star is in one place";
    EXPECT_EQ(scene.layers[1].source.kind, SourceKind::stars);
    EXPECT_EQ(scene.layers[1].source.stars.like, scene.layers[0].name);
    EXPECT_EQ(scene.layers[1].source.stars.psf, 2.5) << "in a frame twice as wide";
    picture.image = "stars.exr";
    EXPECT_EQ(parsed(picture).layers[1].name, "more_stars");
}

// Any program may write a stars.csv: only prepare's own, which says so, is of the picture beside it.
TEST(PictureScene, AForeignTableBesideAPictureIsLeftAlone) {
    const TempFolder folder;
    const fs::path picture = folder.file("picture.ppm", "P3\n2 1\n255\n9 9 9 200 90 10\n");
    Identification choice;
    for (const char* foreign :
         {"name,ra,dec,mag\nVega,279.2,38.8,0.03\n", "u,v,flux_r,flux_g,flux_b\n0.5,0.5,1,1,1\n", "", "#"}) {
        folder.file("stars.csv", foreign);
        EXPECT_TRUE(picture_scene(picture, {}, choice).stars.empty()) << foreign;
    }
    PictureStar star;
    star.amplitude = {1.0, 1.0, 1.0};
    const fs::path own = folder.file("stars.csv", star_table(std::vector{star}, 2, 1));
    EXPECT_EQ(picture_scene(picture, {}, choice).stars, own);
    EXPECT_NEAR(picture_scene(picture, {}, choice).star_px, star.sigma_px(), 1e-3);
}

// One long and smooth; one of squares, as no galaxy is.
TEST(PictureScene, EachOfSeveralGalaxiesLiesAsSureAsItIs) {
    const TempFolder folder;
    const auto light = [](int x, int y, int) {
        const double u = (x - 60.0) / 20.0, v = (y - 75.0) / 8.0;
        const bool square =
            x >= 150 && x < 206 && y >= 45 && y < 101 && ((x - 150) / 14 + (y - 45) / 14) % 2 == 0;
        return square ? 200 : 12 + int(220.0 * std::exp(-std::sqrt(u * u + v * v)));
    };
    const fs::path picture = folder.file("pair.ppm", test::pixmap(240, 150, light));
    Identification choice;
    const PictureScene scene = picture_scene(picture, {SkyObject::galaxy}, choice);
    ASSERT_EQ(scene.galaxies.size(), 2u);
    const std::size_t smooth = scene.galaxies[0].center->x < 0.5 ? 0 : 1;
    EXPECT_NEAR(*scene.galaxies[smooth].inclination, 67.0, 6.0);
    EXPECT_EQ(*scene.galaxies[1 - smooth].inclination, 0.0);
    EXPECT_EQ(scene.lies_by,
              fmt::format("2 galaxies, by their light; how number {} lies is unsure: in the picture's plane",
                          2 - smooth));
}

TEST(PictureScene, FilmsHoldThePictureAndThenFly) {
    for (const StructureKind kind : {StructureKind::disk, StructureKind::sheet, StructureKind::walls}) {
        PictureScene picture{"a.png", 1600, 1000, kind};
        picture.mean_light = 0.25;
        const Scene still = parsed(picture);
        EXPECT_EQ(still.layers.at(0).source.structure.warp > 0.0, kind == StructureKind::disk);
        EXPECT_EQ(still.layers.at(0).source.structure.flare > 0.0, kind == StructureKind::disk);
        picture.film = true;
        const Scene film = parsed(picture);
        EXPECT_EQ(film.output.frames, "1-240");
        for (const double frame : {1.0, 20.0, 36.0}) {
            const Scene now = scene_at(film, frame);
            EXPECT_NEAR(now.camera.position->y, still.camera.position->y, 1e-3) << frame;
            EXPECT_NEAR(now.camera.position->x, 0.0, 1e-6) << frame;
            EXPECT_EQ(now.camera.up, still.camera.up) << frame;
            EXPECT_EQ(now.output.exposure, 0.0) << "as the telescope saw it";
        }
        // The tilt keeps its distance, up to 12 %.
        for (double frame = 1.0; frame <= 100.0; ++frame) {
            const double distance = glm::length(*scene_at(film, frame).camera.position);
            EXPECT_GT(distance, 0.86 * still.camera.position->y) << frame;
            EXPECT_LT(distance, 1.02 * still.camera.position->y) << frame;
        }
        const auto height_over_plane = [&](double frame) { return scene_at(film, frame).camera.position->y; };
        const double outermost = kind == StructureKind::walls ? 1.3 : 0.0;  // of a shell, over the plane
        EXPECT_LT(height_over_plane(160.0), outermost + 2.0) << "a close pass";
        EXPECT_GT(height_over_plane(160.0), outermost) << "not through it";
        EXPECT_EQ(picture_scene_text(picture, "film.toml").find(" -0]"), std::string::npos);
        const double close_by = scene_at(film, 160.0).output.exposure;
        EXPECT_EQ(close_by < -0.5, kind != StructureKind::sheet) << close_by;
        EXPECT_EQ(close_by == 0.0, kind == StructureKind::sheet) << close_by;
        if (kind == StructureKind::disk) {
            EXPECT_LT(height_over_plane(240.0), 0.5) << "ends at the edge";
        } else {
            EXPECT_GT(height_over_plane(240.0), 2.0);
        }
    }
}

TEST(PictureScene, SaysHowTheAxisOfANebulaLies) {
    PictureScene picture{"a.png", 1600, 1000, StructureKind::axis};
    picture.axis.emplace();
    picture.axis->angle = 1.5;
    picture.axis->tilt_deg = 48.4;
    picture.lies_by = "rings about an axis explain 91 % of its light";
    picture.lit_rim = 0.5;
    const StructureParams structure = parsed(picture).layers.at(0).source.structure;
    EXPECT_EQ(structure.kind, StructureKind::axis);
    EXPECT_EQ(structure.axis_angle, 85.9);
    EXPECT_EQ(structure.tilt, 48.0);
    EXPECT_EQ(structure.margin, 0.0) << "what is mirrored does not turn about the axis";
    EXPECT_NE(picture_scene_text(picture, "a.toml").find("# " + picture.lies_by), std::string::npos);
}

// An inclined galaxy is seen along its own normal, then from its edge, and its light makes up for it.
TEST(PictureScene, FilmsOfInclinedGalaxiesGoAboutTheirOwnAxes) {
    PictureScene picture{"a.png", 1600, 1000, StructureKind::disk};
    picture.galaxies = {{60.0, 20.0, glm::dvec2(0.55, 0.4), 110.0, {}}};
    picture.lies_by = "its light: 60 degrees";
    picture.film = true;
    const Scene film = parsed(picture);
    EXPECT_EQ(film.layers.at(0).source.structure.galaxy, picture.galaxies[0]);
    EXPECT_LT(film.camera.fov, 20.0) << "seen from far away, as it is";
    const double near = 110.0 * 3.14159265358979 / 180.0, i = 3.14159265358979 / 3.0;
    const glm::dvec3 b(std::cos(near), 0.0, -std::sin(near));
    const glm::dvec3 normal = glm::dvec3(0.0, std::cos(i), 0.0) - std::sin(i) * b;
    const auto rise_deg = [&](double frame) {  // of the camera over the disk's plane
        const CameraParams& camera = scene_at(film, frame).camera;
        return std::asin(glm::dot(glm::normalize(*camera.position - camera.target), normal)) * 57.29577951;
    };
    EXPECT_NEAR(rise_deg(1.0), 30.0, 0.1) << "the picture";
    EXPECT_NEAR(rise_deg(120.0), 90.0, 0.5);
    EXPECT_NEAR(rise_deg(230.0), 4.0, 0.5);
    EXPECT_EQ(scene_at(film, 1.0).output.exposure, 0.0);
    EXPECT_GT(scene_at(film, 120.0).output.exposure, 0.5);
    const glm::dvec3 center(0.5, 0.0, 0.625);
    EXPECT_LT(glm::length(scene_at(film, 120.0).camera.target - center), 1e-3);
}

TEST(PictureScene, SeveralGalaxiesAreAList) {
    PictureScene picture{"a.png", 1600, 1000, StructureKind::disk};
    picture.galaxies = {{60.0, 20.0, glm::dvec2(0.25, 0.4), 110.0, {}},
                        {10.0, 40.0, glm::dvec2(0.75, 0.6), 310.0, 1.0}};
    EXPECT_EQ(parsed(picture).layers.at(0).source.structure.galaxies, picture.galaxies);
}

TEST(PictureScene, TheApertureOfDarkShellsStaysOpen) {
    PictureScene picture{"a.png", 1600, 1000, StructureKind::walls};
    picture.film = true;
    const auto close_by = [&](double mean_light) {
        picture.mean_light = mean_light;
        return scene_at(parsed(picture), 160.0).output.exposure;
    };
    EXPECT_EQ(close_by(0.02), 0.0);
    EXPECT_NEAR(close_by(0.13), -0.33, 0.01);
    EXPECT_NEAR(close_by(0.25), -0.66, 0.01);
}

// Of a cloud, which goes on to its picture's edges, these stay out of the last frame.
TEST(PictureScene, FilmsOfCloudsEndNearThem) {
    PictureScene picture{"a.png", 1600, 1000, StructureKind::sheet};
    picture.film = true;
    const Scene last = scene_at(parsed(picture), 240.0);
    const Camera camera = make_camera(last.camera, 1.6, 1.0, {});  // places in shares of the frame
    for (const double x : {-5.0, 5.0})
        for (const double z : {-3.125, 3.125}) {
            const auto seen = place_in_picture(camera, {x, 0.0, z});
            const bool outside =
                !seen || std::max(std::fabs(seen->uv.x - 0.5), std::fabs(seen->uv.y - 0.5)) > 0.5;
            EXPECT_TRUE(outside) << x << ' ' << z;
        }
}

TEST(PictureScene, FilmsPassByTheirSubject) {
    PictureScene picture{"a.png", 1600, 1000, StructureKind::sheet};
    picture.film = true;
    const auto target_at = [&](double x, double y) {
        picture.subject = {x, y};
        return scene_at(parsed(picture), 160.0).camera.target;
    };
    EXPECT_NEAR(target_at(0.3, 0.6).x, -2.0, 1e-6);
    EXPECT_NEAR(target_at(0.3, 0.6).z, 0.625, 1e-6);
    EXPECT_NEAR(target_at(0.0, 1.0).x, -3.0, 1e-6) << "not over the picture's edge";
    EXPECT_NEAR(target_at(0.0, 1.0).z, 1.875, 1e-6);
}

TEST(PictureScene, PicturesThatGoOnAreContinued) {
    PictureScene picture{"a.png", 1600, 1000, StructureKind::sheet};
    const auto structure = [&] { return parsed(picture).layers.at(0).source.structure; };
    EXPECT_EQ(structure().margin, 0.0);
    EXPECT_GT(structure().border, 0.0);
    picture.lit_rim = 0.05;
    EXPECT_EQ(structure().margin, 0.0) << "alone on its sky";
    picture.lit_rim = 0.2;
    EXPECT_GT(structure().margin, 0.1) << "what leaves the picture would be cut off";
    picture.structure = StructureKind::disk;
    EXPECT_EQ(structure().margin, 0.08) << "grows dim outward";
    picture.structure = StructureKind::sheet;
    EXPECT_EQ(structure().border, 0.0) << "all of the picture is seen";
    picture.width_px = picture.height_px = 8192;
    EXPECT_EQ(structure().margin, 0.0) << "no room";
}

}  // namespace
}  // namespace astrosplat
