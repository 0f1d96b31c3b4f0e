// .chan: closed forms of its angles, every message, and the way there and back.
#include "camera_files/formats.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "camera/camera.h"
#include "camera_files/camera_track.h"
#include "core/real.h"
#include "core/rotation.h"
#include "support/camera_tracks.h"

namespace astrosplat {
namespace {

class Chan : public test::CameraFileTest {};

glm::dmat3 axes(const TrackSample& sample) { return rotation_from_quaternion(sample.rotation); }

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-12) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

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

}  // namespace
}  // namespace astrosplat
