// Camera tracks as text: .chan, recordings of Gaia Sky and OpenSpace, transforms.json.
#include <glm/matrix.hpp>

#include "camera/camera.h"
#include "camera_files/camera_track.h"
#include "camera_files/formats.h"
#include "core/rotation.h"
#include "support/camera_tracks.h"
#include "support/test.h"
#include "support/test_data.h"

namespace astrosplat {
namespace {

// .chan: closed forms of its angles, every message, and the way there and back.

class Chan : public test::CameraFileTest {};

glm::dmat3 axes(const TrackSample& sample) { return rotation_from_quaternion(sample.rotation); }

TEST_F(Chan, PlacesAnglesAndFieldsOfViewAsNukeHasThem) {
    const CameraTrack track = read_chan(put("cam.chan",
                                            "# frame tx ty tz rx ry rz fov\r\n"
                                            "1 1 2 3 0 90 0 40\r\n\n"
                                            "2 1.5 2 3\t90 0 0 41\n"
                                            "3 +2e0 2 3 0 0 90 42"),
                                        {});
    ASSERT_EQ(track.samples.size(), 3u);
    EXPECT_TRUE(track.has_fov);
    EXPECT_EQ(track.samples[2].frame, 3.0);
    EXPECT_EQ(track.samples[1].eye, glm::dvec3(1.5, 2, 3));
    EXPECT_EQ(track.samples[2].fov_deg, 42.0);
    expect_near(-axes(track.samples[0])[2], {-1, 0, 0});  // a quarter to the left
    expect_near(-axes(track.samples[1])[2], {0, 1, 0});   // straight up
    expect_near(axes(track.samples[2])[0], {0, 1, 0});    // on its side
}

TEST_F(Chan, AnglesAreAppliedInTheOrderZXY) {
    const CameraTrack track = read_chan(put("cam.chan", "1 0 0 0 20 50 -70"), {});
    const glm::dmat3 expected = rotation_from_degrees({0, 50, 0}) * rotation_from_degrees({20, 0, 0}) *
                                rotation_from_degrees({0, 0, -70});
    for (int c = 0; c < 3; ++c) expect_near(axes(track.samples[0])[c], expected[c]);
    EXPECT_FALSE(track.has_fov);
}

TEST_F(Chan, FramesOfAnotherRateFallBetweenOurs) {
    const CameraTrack track = read_chan(put("cam.chan", "0 0 0 0 0 0 0\n60 1 0 0 0 0 0\n"), {24.0, 60.0});
    EXPECT_EQ(track.samples[1].frame, 24.0);
}

TEST_F(Chan, EachMessageNamesTheLine) {
    const auto message = [&](const std::string& text) { return refusal("cam.chan", text, read_chan); };
    EXPECT_EQ(message(""), "cam.chan:0: expected frame tx ty tz rx ry rz, found no line of numbers");
    EXPECT_EQ(message("1 2 3"),
              "cam.chan:1: expected frame tx ty tz rx ry rz and perhaps fov, 7 or 8 numbers, found 3");
    EXPECT_EQ(message("# a\n1 0 0 0 0 0 0\n2 0 0 0 0 0 0 30"),
              "cam.chan:3: expected 7 numbers as in the lines before, found 8");
    EXPECT_EQ(message("1 0 0 0 0 0 0\n1 0 0 0 0 0 0"),
              "cam.chan:2: expected ascending frames, each once, found 1 after 1");
    EXPECT_EQ(message("1 0 0,5 0 0 0 0"), "cam.chan:1: expected a number for ty, found '0,5'");
    EXPECT_EQ(message("1 0 nan 0 0 0 0"), "cam.chan:1: expected a number for ty, found 'nan'");
    EXPECT_EQ(message("1 0 0 0 0 0 0 180"),
              "cam.chan:1: expected a vertical field of view between 0 and 180 degrees, found 180");
    EXPECT_EQ(message(std::string("\0\1\2", 3)),
              "cam.chan:1: expected frame tx ty tz rx ry rz and perhaps fov, 7 or 8 numbers, found 1");
}

TEST_F(Chan, ThereAndBackIsTheSameWithin1e6) {
    const CameraTrack track = test::wild_track();
    const CameraTrack back = read_chan(put("cam.chan", chan_text(track)), {});
    test::expect_same_way(back, track);
}

TEST_F(Chan, WrittenAnglesNeverJumpByATurn) {
    CameraTrack track;
    for (int i = 0; i <= 72; ++i) {
        const double half = 0.5 * real::radians(10.0 * i);
        track.samples.push_back({double(i), {}, {0, std::sin(half), 0, std::cos(half)}, 0, 0});
    }
    const std::string last = chan_text(track).substr(chan_text(track).rfind("\n72 ") + 1);
    EXPECT_NEAR(std::stod(last.substr(std::string("72 0 0 0 0 ").size())), 720.0, 1e-9) << last;
}

TEST_F(Chan, OtherEndingsAreRefused) {
    EXPECT_TRUE(is_camera_file("a/B.CHAN"));
    EXPECT_FALSE(is_camera_file("a/b.txt"));
    EXPECT_FALSE(is_camera_file("chan"));
}

// Recordings of Gaia Sky and OpenSpace: closed forms of their axes, every message, and real files.

class Recordings : public test::CameraFileTest {};

TEST_F(Recordings, GaiaSkyLooksAlongItsDirectionOnceAFrame) {
    const std::string text = "7 1 2 3 1 0 0 0 1 0\n7 2 2 3 0 0 -2 0.5 3 0\n7 3 2 3 0 0 1 0 -1 0\n";
    const CameraTrack track = read_gaia_sky(put("a.gsc", text), {30.0, 0.0});
    ASSERT_EQ(track.samples.size(), 3u);
    EXPECT_EQ(track.samples[0].frame, 1.0);
    EXPECT_EQ(track.samples[2].frame, 2.0) << "60 a second";
    EXPECT_EQ(read_gaia_sky(put("a.gsc", text), {30.0, 30.0}).samples[2].frame, 3.0);
    EXPECT_EQ(track.samples[1].eye, glm::dvec3(2, 2, 3));
    expect_near(-axes(track.samples[0])[2], {1, 0, 0});
    expect_near(axes(track.samples[0])[0], {0, 0, 1});  // right of +x with y up
    expect_near(-axes(track.samples[1])[2], {0, 0, -1});
    expect_near(axes(track.samples[2])[1], {0, -1, 0});
    EXPECT_FALSE(track.has_fov);
}

TEST_F(Recordings, GaiaSkyMessagesNameTheLine) {
    const auto message = [&](const std::string& text) { return refusal("a.gsc", text, read_gaia_sky); };
    EXPECT_EQ(message("# none\n"),
              "a.gsc:1: expected time x y z, direction and up, found no line of numbers");
    EXPECT_EQ(message("0 1 2 3"), "a.gsc:1: expected time x y z, direction and up, 10 numbers, found 4");
    EXPECT_EQ(message("0 0 0 0 0 0 1 0 0 2"),
              "a.gsc:1: expected a direction and an up that differ, found '0 0 0 0 0 0 1 0 0 2'");
    EXPECT_EQ(message("0 0 0 0 0 0 1 0 nan 2"), "a.gsc:1: expected a number for up, found 'nan'");
}

constexpr const char* v1 =
    "OpenSpace_record/playback01.00A\nscript 9 0 0 1 openspace.x()\n"
    "camera 212.2 0.5 7 1 2 3 0 0.6 0 0.8 0.1 F Earth\n"
    "camera 212.3 1.0 7 4 5 6 0 0 0 2 0.1 F Mars\n";

TEST_F(Recordings, OpenSpaceOfEveryFormat) {
    const std::string v2 = "OpenSpace_record/playback02.00A\ncamera 0.5 7 1 2 3 0 0.6 0 0.8 0.1 - Earth\n",
                      v3 = "OpenSpace_record/playback03.00A\ncamera 0.5 7 1 2 3 0.8 0 0.6 0 0.1 - Earth\n";
    for (const std::string& text : {std::string(v1), v2, v3}) {
        const CameraTrack track = read_openspace(put("a.osrectxt", text), {30.0, 0.0});
        EXPECT_EQ(track.samples[0].frame, 16.0) << "half a second after frame 1";
        EXPECT_EQ(track.samples[0].eye, glm::dvec3(1, 2, 3));
        // Turned about y by 2 asin 0.6, to the left.
        expect_near(-axes(track.samples[0])[2], {-0.96, 0.0, -0.28});
    }
    const CameraTrack two = read_openspace(put("a.osrectxt", v1), {30.0, 0.0});
    ASSERT_EQ(two.samples.size(), 2u);
    expect_near(-axes(two.samples[1])[2], {0, 0, -1});
    ASSERT_EQ(two.warnings.size(), 1u);
    EXPECT_HAS(two.warnings[0],
               "a.osrectxt:4: places are relative to 'Mars' from here on, to 'Earth' before");
}

TEST_F(Recordings, OpenSpaceMessagesNameTheLine) {
    const auto message = [&](const std::string& text) { return refusal("a.osrectxt", text, read_openspace); };
    EXPECT_EQ(message(""), "a.osrectxt:0: expected an OpenSpace recording, found an empty file");
    EXPECT_EQ(
        message("OpenSpace_record/playback01.00B\n"),
        "a.osrectxt:1: expected OpenSpace_record/playback with format 01.00A, 02.00A or 03.00A (text), found "
        "'OpenSpace_record/playback01.00B'");
    EXPECT_EQ(message("OpenSpace_record/playback02.00A\nscript 1\n"),
              "a.osrectxt:2: expected lines that begin with camera, found none");
    EXPECT_EQ(message("OpenSpace_record/playback02.00A\ncamera 1 2 3\n"),
              "a.osrectxt:2: expected 13 words in a camera's line, found 4");
    EXPECT_EQ(message("OpenSpace_record/playback02.00A\ncamera 2 7 1 2 3 0 0 0 1 0.1 - E\n"
                      "camera 1 7 1 2 3 0 0 0 1 0.1 - E\n"),
              "a.osrectxt:3: expected times that ascend, found '1'");
    EXPECT_EQ(message("OpenSpace_record/playback02.00A\ncamera 2 7 1 2 3 0 0 0 0 0.1 - E\n"),
              "a.osrectxt:2: expected a rotation of length 1, found 0");
}

TEST_F(Recordings, RealFiles) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(cameras, "cameras");
    const CameraTrack gaia = read_gaia_sky(cameras / "gaiasky/camera-path-test.gsc", {60.0, 0.0});
    EXPECT_EQ(gaia.samples.size(), 607u);
    EXPECT_EQ(gaia.samples.back().frame, 607.0);
    for (const char* name : {"0100", "0200", "0300"})
        EXPECT_GE(read_openspace(cameras / ("openspace/" + std::string(name) + "_ascii_linux.osrectxt"), {})
                      .samples.size(),
                  3u)
            << name;
}

// transforms.json: its axes and fields of view in closed form, and what odd files end with.

class TransformsJson : public test::CameraFileTest {
  protected:
    CameraTrack read(const std::string& text) {
        return read_transforms_json(put("transforms.json", text), {});
    }
    /// Looks along +x from (1, 2, 3), z up, then once more from (4, 5, 6).
    static std::string two(const std::string& all, const std::string& own = "") {
        return "{" + all + R"("frames":[{"file_path":"a",)" + own +
               R"("transform_matrix":[[0,0,-1,1],[-1,0,0,2],[0,1,0,3],[0,0,0,1]]},{"file_path":"b",)" + own +
               R"("transform_matrix":[[0,0,-1,4],[-1,0,0,5],[0,1,0,6]]}]})";
    }
};

TEST_F(TransformsJson, HoldsRowsOfWorldFromCamera) {
    const CameraTrack track = read(two(""));
    ASSERT_EQ(track.samples.size(), 2u);
    EXPECT_EQ(track.up, FileUp::z);
    EXPECT_FALSE(track.has_fov);
    EXPECT_EQ(track.samples[1].frame, 2.0);
    EXPECT_EQ(track.samples[1].eye, glm::dvec3(4, 5, 6));
    const glm::dmat3 turned = axes(track.samples[0]);
    for (int c = 0; c < 3; ++c) expect_near(turned[c], glm::dmat3(0, -1, 0, 0, 0, 1, -1, 0, 0)[c]);
}

TEST_F(TransformsJson, FieldsOfViewAreVertical) {
    const auto fov = [&](const std::string& all, const std::string& own = "") {
        const CameraTrack track = read(two(all, own));
        EXPECT_TRUE(track.has_fov);
        return track.samples[1].fov_deg;
    };
    EXPECT_NEAR(fov(R"("fl_y":500,"fl_x":700,"w":800,"h":1000,)"), 90.0, 1e-9);
    EXPECT_NEAR(fov(R"("fl_x":500,"w":800,"h":1000,)"), 90.0, 1e-9);
    EXPECT_NEAR(fov(R"("fl_y":9,"h":9,)", R"("fl_y":500,"h":1000,)"), 90.0, 1e-9)
        << "a frame's own comes first";
    EXPECT_NEAR(fov(R"("camera_angle_y":1.0,)"), 57.29577951308232, 1e-9);
    EXPECT_NEAR(fov(R"("camera_angle_x":1.5707963267948966,)"), 90.0, 1e-9);
    EXPECT_NEAR(fov(R"("camera_angle_x":1.5707963267948966,"w":200,"h":100,)"), 53.13010235415598, 1e-9);
}

TEST_F(TransformsJson, TheMiddleShiftsTheFrameAndDistortionsAreTold) {
    const CameraTrack track =
        read(two(R"("w":1920,"h":1000,"fl_x":500,"fl_y":510,"cx":1200,"cy":450,"k1":-0.1,"p2":0.5,)"));
    EXPECT_TRUE(track.has_shift);
    expect_near(track.samples[1].shift, {-0.24, -0.05});
    ASSERT_EQ(track.warnings.size(), 2u);
    EXPECT_HAS(track.warnings[0], "transforms.json: k1 = -0.1, p2 = 0.5: distortions are left out");
    EXPECT_HAS(track.warnings[1], "fl_x = 500, fl_y = 510: pixels are taken for square ones");
    EXPECT_FALSE(read(two(R"("w":1920,"h":1000,"fl_x":500,"cx":960,"cy":500,)")).has_shift);
}

TEST_F(TransformsJson, WhatElseItSaysOfLensesIsToldWhereItIsNotZero) {
    const CameraTrack track =
        read(two(R"("fisheye_crop_radius":900.5,"rolling_shutter_time":0.01,"rolling_shutter":[0,0,0.5,0],)",
                 R"("distortion_params":[0.1,0,0,0,0,0],)"));
    ASSERT_EQ(track.warnings.size(), 1u);
    EXPECT_HAS(track.warnings[0],
               "transforms.json: its values of distortion_params, fisheye_crop_radius, rolling_shutter, "
               "rolling_shutter_time are not followed");
    const CameraTrack none = read(
        two(R"("fisheye_crop_radius":null,"rolling_shutter_time":0.0,"distortion_params":[0,0.0,0,0,0,0],)"));
    EXPECT_TRUE(none.warnings.empty());
}

TEST_F(TransformsJson, SizesBesideTheMatricesAreTold) {
    const std::string applied = R"("applied_transform":[[0,1,0,0],[1,0,0,0],[0,0,-1,0]],"applied_scale":3,)";
    const CameraTrack plain = read(two(applied + R"("scale":1,"offset":[0,0,0],)"));
    EXPECT_EQ(plain.samples[0].eye, glm::dvec3(1, 2, 3)) << "the matrices have it";
    EXPECT_TRUE(plain.warnings.empty());
    const CameraTrack told =
        read(test::replaced(two(R"("scale":0.33,"offset":[0.5,0.5,0.5],)"), "0,0,-1,4", "0,0,-2,4"));
    EXPECT_EQ(told.samples[0].eye, glm::dvec3(1, 2, 3));
    expect_near(axes(told.samples[1])[2], {-1, 0, 0});
    ASSERT_EQ(told.warnings.size(), 2u);
    EXPECT_HAS(told.warnings[0],
               "transforms.json: scale and offset are left out: places are those of "
               "transform_matrix");
    EXPECT_HAS(told.warnings[1], "transforms.json: the axes of frame 2 are 1, 1 and 2 long: taken for 1");
}

TEST_F(TransformsJson, ModelsAreProjections) {
    const std::string size = R"("w":1920,"h":1000,"fl_x":500,"cx":960,"cy":500,)";
    const CameraTrack fisheye = read(two(size + R"("camera_model":"OPENCV_FISHEYE",)"));
    EXPECT_EQ(fisheye.projection, Projection::fisheye);
    EXPECT_NEAR(fisheye.samples[1].fov_deg, 2.0 * 180.0 / 3.14159265358979324, 1e-9)
        << "1000 px of 1/500 rad";
    EXPECT_EQ(read(two(size + R"("is_fisheye":true,)")).projection, Projection::fisheye);
    const CameraTrack round = read(two(size + R"("camera_model":"EQUIRECTANGULAR",)"));
    EXPECT_EQ(round.projection, Projection::equirectangular);
    EXPECT_FALSE(round.has_fov);
    EXPECT_TRUE(round.warnings.empty());
    EXPECT_EQ(read(two(size + R"("camera_model":"OPENCV",)")).projection, Projection::perspective);
    const CameraTrack other = read(two(size + R"("camera_model":"FISHEYE624",)"));
    ASSERT_EQ(other.warnings.size(), 1u);
    EXPECT_HAS(other.warnings[0], "camera_model 'FISHEYE624' is not known, a perspective one is taken");
}

TEST_F(TransformsJson, FramesComeInTheOrderOfTheirNumbers) {
    const auto last = [&](const std::string& first_name, const std::string& second_name) {
        return read(test::replaced(test::replaced(two(""), "\"a\"", first_name), "\"b\"", second_name))
            .samples[1]
            .eye.x;
    };
    EXPECT_EQ(last(R"("images/cam2_10.v.png")", R"("images/cam2_9.png")"), 1.0) << "9 comes before 10";
    EXPECT_EQ(last(R"("images/9.png")", R"("images/10.png")"), 4.0);
    EXPECT_EQ(last(R"("a/2.png")", R"("b/2.png")"), 4.0) << "the file's order";
    EXPECT_EQ(last(R"("2.png")", R"("x.png")"), 4.0) << "the file's order";
}

TEST_F(TransformsJson, OddFilesEndInOneLine) {
    const auto message = [&](const std::string& text) {
        return refusal("transforms.json", text, read_transforms_json);
    };
    EXPECT_EQ(message("[1]"),
              "transforms.json: expected a transforms.json with frames, found something else");
    EXPECT_EQ(message(R"({"frames":[]})"),
              "transforms.json: expected at least one of its frames, found none");
    EXPECT_EQ(
        message(R"({"frames":[{"transform_matrix":[[1,2],[3]]}]})"),
        "transforms.json: expected 3 or 4 rows of 4 numbers as transform_matrix of frame 1, found others");
    EXPECT_EQ(message(R"({"frames":[{"transform_matrix":[[0,0,0,1],[0,0,0,1],[0,0,0,1]]}]})"),
              "transforms.json: expected axes in the transform_matrix of frame 1, found none");
    EXPECT_EQ(message(two(R"("camera_angle_y":4.0,)")),
              "transforms.json: expected a field of view between 0 and 180 degrees at frame 1, found 229.2");
    EXPECT_HAS(message(R"({"frames":[7]})"), "transforms.json: expected a transforms.json, found");
    EXPECT_HAS(message(R"({"frames":[{"transform_matrix":[["x",2,3,4],[],[]]}]})"),
               "expected a transforms.json");
}

}  // namespace
}  // namespace astrosplat
