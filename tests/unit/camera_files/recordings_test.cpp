// Recordings of Gaia Sky and OpenSpace: closed forms of their axes, every message, and real files.
#include "camera_files/formats.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "camera/camera.h"
#include "support/camera_tracks.h"
#include "support/test_data.h"

namespace astrosplat {
namespace {

class Recordings : public test::CameraFileTest {};

void expect_near_to(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-12) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

glm::dmat3 axes_of(const TrackSample& sample) { return rotation_from_quaternion(sample.rotation); }

TEST_F(Recordings, GaiaSkyLooksAlongItsDirectionOnceAFrame) {
    const std::string text = "7 1 2 3 1 0 0 0 1 0\n7 2 2 3 0 0 -2 0.5 3 0\n7 3 2 3 0 0 1 0 -1 0\n";
    const CameraTrack track = read_gaia_sky(put("a.gsc", text), {30.0, 0.0});
    ASSERT_EQ(track.samples.size(), 3u);
    EXPECT_EQ(track.samples[0].frame, 1.0);
    EXPECT_EQ(track.samples[2].frame, 2.0) << "60 a second";
    EXPECT_EQ(read_gaia_sky(put("a.gsc", text), {30.0, 30.0}).samples[2].frame, 3.0);
    EXPECT_EQ(track.samples[1].eye, glm::dvec3(2, 2, 3));
    expect_near_to(-axes_of(track.samples[0])[2], {1, 0, 0});
    expect_near_to(axes_of(track.samples[0])[0], {0, 0, 1});  // right of +x with y up
    expect_near_to(-axes_of(track.samples[1])[2], {0, 0, -1});
    expect_near_to(axes_of(track.samples[2])[1], {0, -1, 0});
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
        expect_near_to(-axes_of(track.samples[0])[2], {-0.96, 0.0, -0.28});
    }
    const CameraTrack two = read_openspace(put("a.osrectxt", v1), {30.0, 0.0});
    ASSERT_EQ(two.samples.size(), 2u);
    expect_near_to(-axes_of(two.samples[1])[2], {0, 0, -1});
    ASSERT_EQ(two.warnings.size(), 1u);
    EXPECT_NE(
        two.warnings[0].find("a.osrectxt:4: places are relative to 'Mars' from here on, to 'Earth' before"),
        std::string::npos)
        << two.warnings[0];
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

}  // namespace
}  // namespace astrosplat
