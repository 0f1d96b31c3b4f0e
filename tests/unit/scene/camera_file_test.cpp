// Cameras of other programs: read by camera.file, and written for them.
#include "scene/camera_file.h"
#include "camera/camera.h"
#include "core/file_format.h"
#include "core/text.h"
#include "scene/animate.h"
#include "scene/load.h"
#include "scene/save.h"
#include "scene_texts.h"
#include "support/camera_tracks.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// camera.file: what it replaces at which frame, in which units and axes, from samples and from tables.

class CameraFile : public test::CameraFileTest {
  protected:
    Scene scene(const std::string& camera, const std::string& rest = "") {
        return parse_scene(test::small_scene() + "[camera]\n" + camera + rest, folder / "scene.toml");
    }
    std::string refused(const std::string& camera) { return without_folder(ERROR_OF(scene(camera))); }
};

glm::dvec3 place(const Scene& scene, double frame) { return *scene_at(scene, frame).camera.position; }
glm::dvec3 view(const Scene& scene, double frame) {
    return -make_camera(scene_at(scene, frame).camera, 100, 100, {}).world_from_camera[2];
}
void expect_at(const glm::dvec3& a, const glm::dvec3& b) { EXPECT_LT(glm::distance(a, b), 1e-9); }

const char* const two_frames = "10 1 2 3 0 0 0 30\n20 3 2 3 0 90 0 40\n";

TEST_F(CameraFile, ReplacesPlaceTurnAndLensAtEveryFrame) {
    put("cam.chan", two_frames);
    const Scene s = scene("file = \"cam.chan\"\nposition = [9, 9, 9]\nfocal_length = 50.0\n",
                          "[animation]\n\"camera.fov\" = { keys = [[1, 70.0]] }\n");
    expect_at(place(s, 10), {1, 2, 3});
    expect_at(place(s, 15), {2, 2, 3});
    expect_at(view(s, 15), {-std::sqrt(0.5), 0, -std::sqrt(0.5)});
    const CameraParams now = scene_at(s, 12.5).camera;
    EXPECT_EQ(now.fov, 32.5) << "the file's, not the animation's";
    EXPECT_EQ(now.focal_length, 0.0) << "it would replace the file's fov";
}

TEST_F(CameraFile, WhatIsStoppedStaysWhereItIs) {
    put("cam.chan", two_frames);
    const Scene s =
        scene("file = \"cam.chan\"\n", "[animation]\n\"camera.near\" = { keys = [[1, 1], [20, 2]] }\n");
    Scene now = scene_at(s, 15);
    EXPECT_TRUE(moves(now, [](const ParameterKey& key) { return key == "camera.position"; }));
    EXPECT_TRUE(moves(now, [](const ParameterKey& key) { return key == "camera.near"; }));
    EXPECT_FALSE(moves(now, [](const ParameterKey& key) { return key == "camera.far"; }));
    stop_animation(now);
    EXPECT_EQ(scene_at(now, 20), now);
    expect_at(place(now, 20), {2, 2, 3});
    EXPECT_FALSE(moves(now, [](const ParameterKey&) { return true; }));
}

TEST_F(CameraFile, HoldsBeforeTheFirstAndAfterTheLastFrame) {
    put("cam.chan", two_frames);
    const Scene s = scene("file = \"cam.chan\"\n");
    expect_at(place(s, -100), {1, 2, 3});
    expect_at(place(s, 1e6), {3, 2, 3});
    EXPECT_EQ(scene_at(s, 1e6).camera.fov, 40.0);
}

TEST_F(CameraFile, WithoutAFieldOfViewTheSceneKeepsItsOwn) {
    put("cam.chan", "1 0 0 5 0 0 0\n");
    const Scene s = scene("file = \"cam.chan\"\nfocal_length = 50.0\n");
    EXPECT_EQ(scene_at(s, 3).camera.focal_length, 50.0);
}

// defaults < preset < scene < animation < camera.file < --set
TEST_F(CameraFile, SetWinsOverTheFile) {
    put("cam.chan", two_frames);
    const auto with = [&](std::vector<std::string> words) {
        std::vector<Assignment> assignments;
        for (const std::string& word : words) assignments.push_back(parse_assignment(word));
        return parse_scene("astrosplat = 1\n[camera]\nfile = \"cam.chan\"\nfocal_length = 50.0\n",
                           folder / "scene.toml", assignments);
    };
    Scene set = with({"camera.fov=90", "camera.position=[7, 8, 9]"});
    for (const bool again : {false, true}) {  // it stays so where the file's tracks are made anew
        if (again) {
            set.camera.file_scale = 2.0;
            refresh_camera_file(set, "");
        }
        const CameraParams now = scene_at(set, 10).camera;
        EXPECT_EQ(now.fov, 90.0);
        EXPECT_EQ(now.focal_length, 0.0) << "which would replace fov";
        EXPECT_EQ(now.position, glm::dvec3(7, 8, 9));
        EXPECT_TRUE(now.rotation) << "the file's";
    }
    const CameraParams looking = scene_at(with({"camera.target=[1, 0, 0]"}), 10).camera;
    EXPECT_FALSE(looking.rotation) << "which would replace target";
    EXPECT_EQ(looking.target, glm::dvec3(1, 0, 0));
    const Scene moved =
        with({"animation.camera.fov={ keys = [[1, 20], [11, 30]], interpolation = \"linear\" }"});
    EXPECT_EQ(scene_at(moved, 6).camera.fov, 25.0);
    EXPECT_EQ(scene_at(with({}), 1e6).camera.fov, 40.0);
}

TEST_F(CameraFile, UnitAxisOffsetAndRateOfTheFile) {
    put("cam.chan", two_frames);
    const Scene s =
        scene("file = \"cam.chan\"\nfile_scale = 0.5\nfile_up = \"z\"\nfile_offset = 5.0\nfile_fps = 48.0\n");
    expect_at(place(s, 10), {0.5, 1.5, -1.0});  // frame 10 of 48 a second is our 5th, plus 5
    expect_at(place(s, 15), {1.5, 1.5, -1.0});
    expect_at(view(s, 10), {0, -1, 0});  // along -z, which is down there
}

TEST_F(CameraFile, TheSceneSavesTheKeyAndNotTheFrames) {
    put("cam.chan", two_frames);
    const Scene s = scene("file = \"cam.chan\"\n");
    const std::string text = save_text(s, "", folder / "scene.toml");
    EXPECT_HAS(text, "file = \"cam.chan\"");
    EXPECT_EQ(text.find("[animation]"), text.npos) << text;
    EXPECT_EQ(parse_scene(text, folder / "scene.toml"), s);
}

TEST_F(CameraFile, IsReadAgainWhereItsKeysAskForOtherTracks) {
    put("cam.chan", two_frames);
    Scene s = scene("file = \"cam.chan\"\n");
    const auto before = s.imported.camera;
    refresh_camera_file(s, "");
    EXPECT_EQ(s.imported.camera, before) << "the very same";
    s.camera.file_scale = 10.0;
    refresh_camera_file(s, "");
    expect_at(place(s, 10), {10, 20, 30});
    s.camera.file.clear();
    refresh_camera_file(s, "");
    EXPECT_EQ(s.imported.camera, nullptr);
}

TEST_F(CameraFile, ProjectionsAndShiftsOfTheFile) {
    const auto json = [&](const std::string& lens) {
        put("a.json", "{" + lens +
                          R"("w":1920,"h":1000,"fl_x":500,"cx":1460,"cy":500,"frames":[)"
                          R"({"transform_matrix":[[1,0,0,0],[0,1,0,0],[0,0,1,0]]}]})");
        const Said said;
        Scene s = scene("file = \"a.json\"\n", "[output]\nresolution = [300, 100]\n");
        return s;
    };
    Scene flat = json("");
    EXPECT_LT(glm::distance(scene_at(flat, 1).camera.shift, glm::dvec2(-0.5 / 3.0, 0.0)), 1e-12);
    flat.output.width = 100;
    refresh_camera_file(flat, "");
    EXPECT_LT(glm::distance(scene_at(flat, 1).camera.shift, glm::dvec2(-0.5, 0.0)), 1e-12);
    const CameraParams fisheye = scene_at(json(R"("camera_model":"OPENCV_FISHEYE",)"), 1).camera;
    EXPECT_EQ(fisheye.projection, Projection::fisheye);
    EXPECT_NEAR(fisheye.fisheye_fov, 2.0 * 180.0 / 3.14159265358979324, 1e-9);
    const CameraParams round = scene_at(json(R"("camera_model":"EQUIRECTANGULAR",)"), 1).camera;
    EXPECT_EQ(round.projection, Projection::equirectangular);
    EXPECT_EQ(round.panorama_fov, 360.0);
}

TEST_F(CameraFile, FramesThatDoNotMeetTheScenesAreTold) {
    put("cam.chan", two_frames);
    const Scene s = scene("file = \"cam.chan\"\nfile_offset = 2\n");
    const auto missed = [&](std::vector<std::int64_t> frames) {
        return without_folder(missed_camera_frames(s, frames));
    };
    EXPECT_EQ(missed({1, 2, 5}),
              "cam.chan: its camera stands still, for it moves at frames 12 to 22, outside of 1 "
              "to 5; camera.file_offset = -9 would fit");
    EXPECT_EQ(missed({30}),
              "cam.chan: its camera stands still, for it moves at frames 12 to 22, outside of 30 to "
              "30; camera.file_offset = 20 would fit");
    EXPECT_EQ(missed({1, 12}), "");
    put("cam.chan", "1001 0 0 0 0 0 0\n");
    const Scene still = scene("file = \"cam.chan\"\n");
    EXPECT_EQ(missed_camera_frames(still, std::vector<std::int64_t>{1}), "") << "nothing moves";
}

TEST_F(CameraFile, TablesSetAnyKeyThatCanBeAnimated) {
    put("move.csv",
        "frame,camera.position.x,camera.position.y,camera.position.z,layer.stars.look.density,"
        "layer.stars.visible,layer.stars.look.grade.tint.r,layer.stars.look.grade.tint.g,"
        "layer.stars.look.grade.tint.b,layer.stars.look.noise.cull,layer.stars.render.blend\n"
        "1,0,0,10,1,true,1,1,1,0,over\n"
        "11,0,5,20,0.5,false,1,0.5,0,0.5,add\n");
    const Scene s = scene("file = \"move.csv\"\n");
    expect_at(place(s, 6), {0, 2.5, 15});
    const LayerParams layer = scene_at(s, 6).layers[0];
    EXPECT_EQ(layer.look.density, 0.75f);
    EXPECT_TRUE(layer.visible) << "steps";
    EXPECT_EQ(layer.look.grade.tint.z, 0.5f);
    EXPECT_EQ(layer.look.noise.at(0).cull, 0.25f);
    EXPECT_FALSE(scene_at(s, 11).layers[0].visible);
    EXPECT_EQ(scene_at(s, 11).layers[0].render.blend, Blend::add);
    EXPECT_TRUE(ever_visible(s, s.layers[0]));
}

TEST_F(CameraFile, TablesTakeOtherSeparatorsQuotesAndMarks) {
    put("a.csv", "\xef\xbb\xbf\"frame\";\"camera.fov\"\r\n1;\"30\"\r\n\r\n2;40\r\n");
    EXPECT_EQ(scene_at(scene("file = \"a.csv\"\n"), 2).camera.fov, 40.0);
    put("b.csv", "camera.fov\tframe\n30\t1\n40\t3\n");
    EXPECT_EQ(scene_at(scene("file = \"b.csv\"\n"), 2).camera.fov, 35.0);
}

TEST_F(CameraFile, EachMessageNamesPlaceExpectationAndFinding) {
    const std::vector<std::string> all = endings_of(FileUse::camera_read);
    EXPECT_EQ(refused("file = \"cam.mov\"\n"), "scene.toml:8: camera.file: expected a name ending in " +
                                                   alternatives(all) + ", found 'cam.mov'");
    EXPECT_EQ(refused("file = \"none.chan\"\n"),
              "scene.toml:8: camera.file: none.chan: cannot be read: No such file or directory");
    const auto table = [&](const std::string& text) {
        put("t.csv", text);
        return refused("file = \"t.csv\"\n");
    };
    EXPECT_EQ(table(""), "t.csv:0: expected a header such as frame,camera.position.x, found an empty file");
    EXPECT_EQ(table("1,2,3\n"), "t.csv:1: expected a header with a column 'frame', found '1'");
    EXPECT_EQ(table("frame\n1\n"), "t.csv:1: expected at least one key besides 'frame', found none");
    EXPECT_EQ(table("frame,camera.fov\n"), "t.csv:1: expected rows of numbers below the header, found none");
    EXPECT_EQ(table("frame,camera.fuv\n1,2\n"),
              "t.csv:1: unknown key 'camera.fuv'; did you mean 'camera.fov'?");
    EXPECT_EQ(table("frame,layer.dust.visible\n1,2\n"), "t.csv:1: layer.dust.visible: unknown layer 'dust'");
    EXPECT_EQ(table("frame,output.fps\n1,2\n"),
              "t.csv:1: expected keys that can be animated, found 'output.fps'");
    EXPECT_EQ(table("frame,camera.position\n1,2\n"),
              "t.csv:1: expected columns camera.position.x, camera.position.y, ..., found 'camera.position'");
    EXPECT_EQ(table("frame,camera.position.x,camera.position.z\n1,2,3\n"),
              "t.csv:1: expected 3 columns for camera.position, found none for its number 2");
    EXPECT_EQ(table("frame,camera.position.w\n1,2\n"),
              "t.csv:1: expected 3 numbers for camera.position, found 'camera.position.w'");
    EXPECT_EQ(table("frame,camera.fov,camera.fov\n1,2,3\n"),
              "t.csv:1: expected each column once, found 'camera.fov' twice");
    EXPECT_EQ(table("frame,camera.fov\n1,2,3\n"), "t.csv:2: expected 2 columns as in the header, found 3");
    EXPECT_EQ(table("frame,camera.fov\n1,200\n"),
              "t.csv:2: camera.fov: expected a number of at least 0.001 and below 180, found 200");
    EXPECT_EQ(table("frame,camera.fov\n1,\n"), "t.csv:2: expected a number for camera.fov, found nothing");
    EXPECT_EQ(table("frame,layer.stars.render.blend\n1,over\n2,ovr\n"),
              "t.csv:3: layer.stars.render.blend: expected over, add, screen, lighten, hybrid or absorb, "
              "found 'ovr'; did "
              "you mean 'over'?");
    EXPECT_EQ(table("frame,camera.fov\n1,3\n1,4\n"),
              "t.csv:3: expected ascending frames, each once, found 1 after 1");
    EXPECT_EQ(
        table("frame,camera.rotation.x,camera.rotation.y,camera.rotation.z,camera.rotation.w\n1,0,0,0,0\n"),
        "t.csv:2: camera.rotation: expected a quaternion that is not zero, found 0, 0, 0, 0");
    put("far.chan", "1 1e13 0 0 0 0 0\n");
    EXPECT_EQ(
        refused("file = \"far.chan\"\n"),
        "far.chan:frame 1: expected camera.position within 1e+12, found 1e+13 (camera.file_scale makes it "
        "smaller)");
}

TEST_F(CameraFile, ATableThereAndBackIsTheSame) {
    put("move.csv",
        "frame,camera.position.x,camera.position.y,camera.position.z,camera.fov\n"
        "1,0.1,0.2,0.3,40\n2.5,1e-9,-3,12345678.9,41.123456789012345\n");
    Scene s = scene("");
    const std::vector<Track> tracks = read_csv_tracks(folder / "move.csv", {}, s);
    put("again.csv", csv_text(tracks));
    EXPECT_EQ(read_csv_tracks(folder / "again.csv", {}, s), tracks);
}

// The scene's camera for other programs: there and back through every format, and what USD says.

class ExportCamera : public test::CameraFileTest {
  protected:
    Scene scene(const std::string& camera, const std::string& animation = moving) {
        const std::string text =
            "astrosplat = 1\n[output]\nresolution = [300, 100]\n[camera]\n" + camera + animation;
        return parse_scene(text, put("scene.toml", text));
    }
    static constexpr const char* moving =
        "\n[animation]\n\"camera.position\" = { keys = [[1, [0, 0, 9]], [20, [5, 3, -8]], [40, [-7, -2, 1]]] "
        "}\n"
        "\"camera.target\" = { keys = [[1, [0, 0, 0]], [40, [1, 2, -3]]] }\n"
        "\"camera.roll\" = { keys = [[1, 0], [40, 500]] }\n";

    /// The camera at frames -3 to 50, written, read by another scene and asked for again.
    void expect_back(const Scene& original, const std::string& name, const std::string& camera = "") {
        std::vector<std::int64_t> frames(54);
        std::iota(frames.begin(), frames.end(), -3);
        const CameraTrack track = camera_track(original, frames);
        ASSERT_EQ(track.samples.size(), frames.size());
        put(name, camera_text(track, original, name));
        const CameraTrack back = camera_track(scene(camera + "file = \"" + name + "\"\n", ""), frames);
        test::expect_same_way(track, back);
        EXPECT_EQ(track.projection, back.projection);
        for (std::size_t i = 0; i < frames.size(); ++i)
            EXPECT_LT(glm::distance(track.samples[i].shift, back.samples[i].shift), 1e-9);
        for (std::size_t i = 0; i < frames.size(); ++i)
            EXPECT_NEAR(track.samples[i].height, back.samples[i].height, 1e-6);
    }
};

TEST_F(ExportCamera, ComesBackFromEveryFormat) {
    const Scene original =
        scene("fov = 33.0", std::string(moving) + "\"camera.fov\" = { keys = [[1, 20], [40, 70]] }\n");
    expect_back(original, "a.chan");
    expect_back(original, "a.csv");
    expect_back(scene("focal_length = 50.0"), "b.chan");
    const Scene shifted = scene("shift = [0.25, -0.5]");
    const std::vector<std::int64_t> first{1};
    expect_near(camera_track(shifted, first).samples[0].shift, {0.75, -0.5});
    expect_back(shifted, "s.csv");
    expect_back(shifted, "s.usda");
    const Said said;
    for (const char* name : {"s.chan", "s.gltf"}) camera_text(camera_track(shifted, first), shifted, name);
    ASSERT_EQ(said.warnings.size(), 2u);
    EXPECT_EQ(said.warnings[0], "s.chan: camera.shift is left out, for .chan cannot say it");
    EXPECT_EQ(said.warnings[1], "s.gltf: camera.shift is left out, for glTF cannot say it");
    expect_back(scene("projection = \"fisheye\"\nfisheye_tilt = 30.0"), "c.chan",
                "projection = \"fisheye\"\nfisheye_tilt = 30.0\n");
    expect_back(scene("eye = \"left\"\neye_separation = 3.0"), "d.csv", "eye = \"right\"\n");
    expect_back(scene("projection = \"orthographic\"\nheight = 7.0"), "e.csv",
                "projection = \"orthographic\"\n");
}

TEST_F(ExportCamera, UsdHasRowsAndAVerticalAperture) {
    const Scene still = scene("position = [1, 2, 3]\ntarget = [-4, 2, 3]\nfov = 90.0\nfar = 50.0\n", "");
    const std::vector<std::int64_t> frames{7, 9};
    const std::string text = camera_text(camera_track(still, frames), still, "a.usda");
    for (const char* part :
         {"#usda 1.0\n", "startTimeCode = 7\n", "endTimeCode = 9\n", "timeCodesPerSecond = 24\n",
          "upAxis = \"Y\"", "float2 clippingRange = (0.01, 50)", "float horizontalAperture = 72\n",
          "float verticalAperture = 24\n", "uniform token[] xformOpOrder = [\"xformOp:transform\"]"})
        EXPECT_HAS(text, part) << part << text;
    // Looks along -x: right is -z, back is +x.
    const std::size_t at = text.find("9: ( (");
    ASSERT_NE(at, std::string::npos) << text;
    double m[16];
    std::string numbers = text.substr(at + 3, text.find(") )", at) - at);
    for (char& c : numbers)
        if (c == '(' || c == ')' || c == ',') c = ' ';
    std::istringstream in(numbers);
    for (double& x : m) ASSERT_TRUE(in >> x) << numbers;
    const double expected[16] = {0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 2, 3, 1};
    for (int i = 0; i < 16; ++i) EXPECT_NEAR(m[i], expected[i], 1e-12) << i;
    const std::size_t focal = text.find("9: ", text.find("focalLength.timeSamples"));
    EXPECT_NEAR(std::stod(text.substr(focal + 3)), 12.0, 1e-9);
}

TEST_F(ExportCamera, RefusesWhatItCannotSay) {
    const std::vector<std::int64_t> frames{1};
    const Scene framing = scene("fov = 40.0\n", "");
    EXPECT_HAS(ERROR_OF(camera_track(framing, frames)), "camera.position: expected a position");
    const Scene flat = scene("projection = \"orthographic\"\nposition = [0, 0, 5]\n", "");
    const CameraTrack track = camera_track(flat, frames);
    EXPECT_HAS(ERROR_OF(camera_text(track, flat, "a.chan")), "found orthographic");
    EXPECT_HAS(ERROR_OF(camera_text(track, flat, "a.abc")), ".chan, .csv, .gltf or .usda");
}

}  // namespace
}  // namespace astrosplat
