// glTF cameras: parents, curves of every kind against closed forms, binary files, and what a broken or
// hostile file ends with.
#include "camera_files/formats.h"

#include <gtest/gtest.h>

#include <cstring>
#include <glm/geometric.hpp>

#include "camera/camera.h"
#include "core/text.h"
#include "support/bits.h"
#include "support/camera_tracks.h"
#include "support/errors.h"

namespace astrosplat {
namespace {

std::string floats(const std::vector<float>& values) {
    std::string bytes(4 * values.size(), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

class Gltf : public test::CameraFileTest {
  protected:
    /// A camera that a parent, moved along x, holds: times 0 and 2 s, places, and what `between` says.
    static std::string moving(const std::string& between, const std::vector<float>& values,
                              const std::string& path = "translation", const std::string& uri = "") {
        const std::string bytes = floats({0.0f, 2.0f}) + floats(values);
        const std::string type = path == "rotation" ? "VEC4" : "VEC3";
        const std::size_t count = values.size() / (path == "rotation" ? 4 : 3);
        return R"({"asset":{"version":"2.0"},"nodes":[{"camera":0,"translation":[0,1,0]},)"
               R"({"children":[0],"rotation":[0,0.70710678118,0,0.70710678118],"scale":[2,2,2]}],)"
               R"("cameras":[{"type":"perspective","perspective":{"yfov":0.5,"znear":0.1}}],)"
               R"("animations":[{"samplers":[{"input":0,"output":1,"interpolation":")" +
               between + R"("}],"channels":[{"sampler":0,"target":{"node":1,"path":")" + path +
               R"("}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR"},)"
               R"({"bufferView":1,"componentType":5126,"count":)" +
               std::to_string(count) + R"(,"type":")" + type +
               R"("}],"bufferViews":[{"buffer":0,"byteLength":8},{"buffer":0,"byteOffset":8,"byteLength":)" +
               std::to_string(4 * values.size()) + R"(}],"buffers":[{"byteLength":)" +
               std::to_string(bytes.size()) + R"(,"uri":")" +
               (uri.empty() ? "data:application/octet-stream;base64," + base64(bytes) : uri) + R"("}]})";
    }
    CameraTrack read(const std::string& text) { return read_gltf(put("a.gltf", text), {10.0, 0.0}); }
};

TEST_F(Gltf, ParentsCarryTheCameraAndLinesAreStraight) {
    const CameraTrack track = read(moving("LINEAR", {0, 0, 0, 8, 0, 4}));
    ASSERT_EQ(track.samples.size(), 21u);
    EXPECT_EQ(track.samples[5].frame, 5.0);
    EXPECT_LT(glm::distance(track.samples[5].eye, glm::dvec3(2, 2, 1)), 1e-6);
    // A quarter turn about y: -z becomes -x; the parent's size does not reach the turn.
    EXPECT_LT(glm::distance(-rotation_from_quaternion(track.samples[5].rotation)[2], glm::dvec3(-1, 0, 0)),
              1e-6);
    EXPECT_TRUE(track.has_fov);
    EXPECT_NEAR(track.samples[0].fov_deg, 28.6478897565, 1e-9);
}

TEST_F(Gltf, StepsHoldAndCubicsAreHermites) {
    const CameraTrack steps = read(moving("STEP", {0, 0, 0, 8, 0, 4}));
    EXPECT_LT(glm::distance(steps.samples[19].eye, glm::dvec3(0, 2, 0)), 1e-6);
    EXPECT_LT(glm::distance(steps.samples[20].eye, glm::dvec3(8, 2, 4)), 1e-6);
    // In, value, out: leaves with 3 a second, arrives with -1.
    const CameraTrack cubic =
        read(moving("CUBICSPLINE", {0, 0, 0, 0, 0, 0, 3, 0, 0, -1, 0, 0, 8, 0, 0, 0, 0, 0}));
    const double t = 0.25, expected = (t * t * t - 2 * t * t + t) * 6.0 + (3 * t * t - 2 * t * t * t) * 8.0 +
                                      (t * t * t - t * t) * -2.0;
    EXPECT_NEAR(cubic.samples[5].eye.x, expected, 1e-6);
}

TEST_F(Gltf, TurnsGoTheShortWayAtEvenSpeed) {
    // From none to 80 degrees about z, written on the other side.
    const auto s = float(-std::sin(40.0 * 3.14159265358979 / 180.0)),
               c = float(-std::cos(40.0 * 3.14159265358979 / 180.0));
    const CameraTrack track = read(moving("LINEAR", {0, 0, 0, 1, 0, 0, s, c}, "rotation"));
    const glm::dvec3 right = rotation_from_quaternion(track.samples[5].rotation)[0];
    EXPECT_NEAR(std::atan2(right.y, right.x) * 180.0 / 3.14159265358979, 20.0, 1e-4);
}

TEST_F(Gltf, BinaryFilesAndBuffersBesideAreReadAlike) {
    const std::vector<float> values{0, 0, 0, 8, 0, 4};
    const CameraTrack expected = read(moving("LINEAR", values));
    put("buffer ö.bin", floats({0.0f, 2.0f}) + floats(values));
    test::expect_same_way(read(moving("LINEAR", values, "translation", "buffer ö.bin")), expected);
    std::string json = test::replaced(moving("LINEAR", values, "translation", "x"), R"(,"uri":"x")", "");
    while (json.size() % 4) json += ' ';
    const std::string binary = floats({0.0f, 2.0f}) + floats(values);
    const auto word = [](std::size_t n) {
        std::string bytes;
        for (int i = 0; i < 4; ++i) bytes += static_cast<char>(n >> 8 * i & 255);
        return bytes;
    };
    const std::string glb = "glTF" + word(2) + word(28 + json.size() + binary.size()) + word(json.size()) +
                            "JSON" + json + word(binary.size()) + std::string("BIN\0", 4) + binary;
    test::expect_same_way(read_gltf(put("a.glb", glb), {10.0, 0.0}), expected);
    EXPECT_EQ(refusal("a.glb", glb.substr(0, glb.size() - 5), read_gltf),
              "a.glb: expected chunks within the file, found one that ends after it");
}

TEST_F(Gltf, AStillCameraIsOneSample) {
    const CameraTrack track = read(
        R"({"asset":{"version":"2.0"},"nodes":[{"camera":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,3,4,5,1]}],)"
        R"("cameras":[{"type":"orthographic","orthographic":{"xmag":3,"ymag":2.5,"znear":0,"zfar":9}}]})");
    ASSERT_EQ(track.samples.size(), 1u);
    EXPECT_EQ(track.samples[0].eye, glm::dvec3(3, 4, 5));
    EXPECT_TRUE(track.orthographic);
    EXPECT_EQ(track.samples[0].height, 5.0);
}

TEST_F(Gltf, OursComesBack) {
    CameraTrack track = test::wild_track();
    track.fps = 24.0;
    for (TrackSample& sample : track.samples) sample.frame += 2000.0, sample.fov_deg = 33.0;
    const CameraTrack back = read_gltf(put("b.gltf", gltf_text(track, 1.5, 0.1, 0.0)), {24.0, 0.0});
    ASSERT_EQ(back.samples.size(), track.samples.size());
    for (std::size_t i = 0; i < track.samples.size(); ++i) {
        EXPECT_EQ(back.samples[i].frame, track.samples[i].frame);
        EXPECT_LT(glm::distance(back.samples[i].eye, track.samples[i].eye), 1e-5);
        EXPECT_GT(std::fabs(glm::dot(back.samples[i].rotation, track.samples[i].rotation)), 1.0 - 1e-12);
        EXPECT_NEAR(back.samples[i].fov_deg, 33.0, 1e-9);
    }
    track.samples[0].frame = -1.0;
    EXPECT_THROW(gltf_text(track, 1.5, 0.1, 0.0), InputError);
}

TEST_F(Gltf, OddFilesEndInOneLine) {
    const auto message = [&](const std::string& text) { return refusal("a.gltf", text, read_gltf); };
    const std::string good = moving("LINEAR", {0, 0, 0, 8, 0, 4});
    const auto with = [&](const std::string& what, const std::string& by) {
        return message(test::replaced(good, what, by));
    };
    EXPECT_EQ(message(""), "a.gltf: expected glTF 2.0, JSON or binary, found something else");
    EXPECT_EQ(message("{}"), "a.gltf: expected version 2.0 of glTF, found none");
    EXPECT_EQ(with("\"version\":\"2.0\"", "\"version\":\"1.0\""),
              "a.gltf: expected version 2.0 of glTF, found \"1.0\"");
    EXPECT_EQ(with("\"camera\":0,", ""), "a.gltf: expected a node with a camera, found none");
    EXPECT_EQ(with("\"camera\":0,", "\"camera\":1,"),
              "a.gltf: expected a number of one of its cameras, found 1");
    EXPECT_EQ(with("{\"camera\":0", "{\"children\":[1],\"camera\":0"),
              "a.gltf: expected nodes that are not their own children, found a circle");
    EXPECT_EQ(with("\"sampler\":0", "\"sampler\":7"),
              "a.gltf: expected a number of one of its samplers, found 7");
    EXPECT_EQ(with("\"count\":2,\"type\":\"SCALAR\"", "\"count\":900000000000,\"type\":\"SCALAR\""),
              "a.gltf: expected an accessor within its buffer, found 900000000000 elements beyond it");
    EXPECT_EQ(with("\"byteOffset\":8", "\"byteOffset\":-8"),
              "a.gltf: expected an accessor within its buffer, found 2 elements beyond it");
    EXPECT_EQ(with(";base64,", ";base64,*"),
              "a.gltf: expected base64 in a buffer's data:, found something else");
    EXPECT_EQ(with("\"yfov\":0.5", "\"yfov\":-1"), "a.gltf: expected a yfov between 0 and pi, found -1");
    EXPECT_HAS(with("\"yfov\":0.5", "\"yfov\":[]"), "a.gltf: expected a glTF 2.0 file, found");
    for (const char* uri : {"../secret.bin", "/etc/passwd", "file:///etc/passwd", "a/../../b.bin"})
        EXPECT_HAS(message(moving("LINEAR", {0, 0, 0, 8, 0, 4}, "translation", uri)),
                   "buffers in or beside the file")
            << uri;
    std::string late = moving("LINEAR", {0, 0, 0, 8, 0, 4});
    const std::string before = base64(floats({0.0f, 2.0f, 0, 0, 0, 8, 0, 4}));
    EXPECT_HAS(message(test::replaced(late, before, base64(floats({0.0f, 2e9f, 0, 0, 0, 8, 0, 4})))),
               "at most 6000000 frames");
    EXPECT_EQ(message(test::replaced(late, before, base64(floats({2.0f, 2.0f, 0, 0, 0, 8, 0, 4})))),
              "a.gltf: expected times that ascend, found others");
}

TEST(Base64, IsRfc4648) {
    for (const auto& [bytes, text] : std::vector<std::pair<std::string, std::string>>{{"", ""},
                                                                                      {"f", "Zg=="},
                                                                                      {"fo", "Zm8="},
                                                                                      {"foo", "Zm9v"},
                                                                                      {"foob", "Zm9vYg=="},
                                                                                      {"\xff\xfe", "//4="}}) {
        EXPECT_EQ(base64(bytes), text);
        EXPECT_EQ(bytes_of_base64(text), bytes);
    }
    EXPECT_FALSE(bytes_of_base64("Zg=x") || bytes_of_base64("A") || bytes_of_base64("Zm 9"));
}

}  // namespace
}  // namespace astrosplat
