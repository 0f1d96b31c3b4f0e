// The scene's camera for other programs: there and back through every format, and what USD says.
#include "scene/camera_file.h"

#include <gtest/gtest.h>

#include <numeric>
#include <sstream>

#include "scene/load.h"
#include "support/camera_tracks.h"

namespace astrosplat {
namespace {

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
        EXPECT_EQ(track.orthographic, back.orthographic);
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
        EXPECT_NE(text.find(part), std::string::npos) << part << text;
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
    EXPECT_NE(message_of<InputError>([&] {
                  camera_track(framing, frames);
              }).find("camera.position: expected a position"),
              std::string::npos);
    const Scene flat = scene("projection = \"orthographic\"\nposition = [0, 0, 5]\n", "");
    const CameraTrack track = camera_track(flat, frames);
    EXPECT_NE(message_of<InputError>([&] { camera_text(track, flat, "a.chan"); }).find("found orthographic"),
              std::string::npos);
    EXPECT_NE(message_of<InputError>([&] {
                  camera_text(track, flat, "a.abc");
              }).find(".chan, .csv, .gltf or .usda"),
              std::string::npos);
}

}  // namespace
}  // namespace astrosplat
