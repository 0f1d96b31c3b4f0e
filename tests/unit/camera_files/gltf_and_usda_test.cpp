// Cameras of glTF and USD.
#include "camera/camera.h"
#include "camera_files/formats.h"
#include "core/text.h"
#include "support/camera_tracks.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// glTF cameras: parents, curves of every kind against closed forms, binary files, and what a broken or
// hostile file ends with.

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
    test::expect_same_way(read(moving("LINEAR", values, "translation", "buffer%20%c3%B6.bin")), expected);
    put("50%.bin", floats({0.0f, 2.0f}) + floats(values));
    test::expect_same_way(read(moving("LINEAR", values, "translation", "50%.bin")), expected);
    std::string json = test::replaced(moving("LINEAR", values, "translation", "x"), R"(,"uri":"x")", "");
    while (json.size() % 4) json += ' ';
    const std::string binary = floats({0.0f, 2.0f}) + floats(values);
    const auto word = [](std::size_t n) {
        std::string bytes;
        for (int i = 0; i < 4; ++i) bytes += char(n >> 8 * i & 255);
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
    EXPECT_TRUE(track.orthographic());
    EXPECT_EQ(track.samples[0].height, 5.0);
}

/// A camera under an empty, and what moves: pairs of a target and its two values, an animation each.
std::string animated(const std::vector<std::pair<std::string, std::vector<float>>>& moves,
                     const std::string& more = "") {
    std::string bytes = floats({0.0f, 1.0f}), animations, views = R"({"buffer":0,"byteLength":8})",
                accessors = R"({"bufferView":0,"componentType":5126,"count":2})";
    for (std::size_t i = 0; i < moves.size(); ++i) {
        const auto& [target, values] = moves[i];
        views += R"(,{"buffer":0,"byteOffset":)" + std::to_string(bytes.size()) + R"(,"byteLength":)" +
                 std::to_string(4 * values.size()) + "}";
        bytes += floats(values);
        accessors += R"(,{"bufferView":)" + std::to_string(i + 1) + R"(,"componentType":5126,"count":2})";
        animations += std::string(i ? "," : "") + R"({"name":"take )" + std::to_string(i) +
                      R"(","samplers":[{"input":0,"output":)" + std::to_string(i + 1) +
                      R"(}],"channels":[{"sampler":0,"target":)" + target + "}]}";
    }
    return R"({"asset":{"version":"2.0"},"nodes":[{"children":[1]},{"name":"hero","camera":0,)"
           R"("translation":[0,0,10]},{"name":"spare","camera":0}],"animations":[)" +
           animations +
           R"(],"cameras":[{"type":"perspective","perspective":{"yfov":0.5,"znear":0.1}}],"accessors":[)" +
           accessors + R"(],"bufferViews":[)" + views + R"(],"buffers":[{"byteLength":)" +
           std::to_string(bytes.size()) + R"(,"uri":"data:application/octet-stream;base64,)" + base64(bytes) +
           "\"}]" + more + "}";
}

TEST_F(Gltf, EveryObjectsAnimationMovesTheCamera) {
    const std::string of_camera = R"({"node":1,"path":"translation"})";
    const CameraTrack track = read(animated({{of_camera, {0, 0, 10, 0, 0, 20}},
                                             {R"({"node":2,"path":"translation"})", {9, 9, 9, 9, 9, 9}},
                                             {R"({"node":0,"path":"translation"})", {0, 0, 0, 6, 0, 0}},
                                             {of_camera, {7, 7, 7, 7, 7, 7}}}));
    ASSERT_EQ(track.samples.size(), 11u);
    EXPECT_LT(glm::distance(track.samples[5].eye, glm::dvec3(3, 0, 15)), 1e-6);
    ASSERT_EQ(track.warnings.size(), 2u);
    EXPECT_HAS(track.warnings[1],
               "a.gltf: animation 'take 3' moves what one before it moves and is left out");
}

TEST_F(Gltf, PointersMoveLensesAndNodes) {
    const auto pointer = [](const std::string& to) {
        return R"({"path":"pointer","extensions":{"KHR_animation_pointer":{"pointer":")" + to + "\"}}}";
    };
    const CameraTrack track = read(animated({{pointer("/cameras/0/perspective/yfov"), {0.5f, 0.25f}},
                                             {pointer("/nodes/0/translation"), {0, 0, 0, 0, 4, 0}},
                                             {pointer("/materials/0/alphaCutoff"), {0, 1}}}));
    ASSERT_EQ(track.samples.size(), 11u);
    EXPECT_NEAR(track.samples[0].fov_deg, 28.6478897565, 1e-9);
    EXPECT_NEAR(track.samples[4].fov_deg, 0.4 * 180.0 / 3.14159265358979324, 1e-9);
    EXPECT_NEAR(track.samples[5].eye.y, 2.0, 1e-6);
    EXPECT_EQ(
        refusal("a.gltf", animated({{pointer("/cameras/0/perspective/yfov"), {0.5f, 4.0f}}}), read_gltf),
        "a.gltf: expected a yfov between 0 and pi, found 3.271");
}

TEST_F(Gltf, TheSceneThatIsShownChoosesTheCamera) {
    const auto chosen = [&](const std::string& more) {
        const CameraTrack track = read(animated({}, more));
        EXPECT_EQ(track.warnings.size(), 1u);
        return without_folder(track.warnings.at(0));
    };
    EXPECT_EQ(chosen(R"(,"scene":1,"scenes":[{"nodes":[0]},{"nodes":[2]}])"),
              "a.gltf: of 2 cameras 'spare' is read, not 'hero'");
    EXPECT_EQ(chosen(R"(,"scene":0,"scenes":[{"nodes":[0]},{"nodes":[2]}])"),
              "a.gltf: of 2 cameras 'hero' is read, not 'spare'");
    EXPECT_EQ(chosen(""), "a.gltf: of 2 cameras 'hero' is read, not 'spare'");
    EXPECT_EQ(refusal("a.gltf", animated({}, R"(,"scene":3,"scenes":[])"), read_gltf),
              "a.gltf: expected a number of one of its scenes, found 3");
}

TEST_F(Gltf, AMirroredParentKeepsTheCameraUpright) {
    const CameraTrack track =
        read(test::replaced(animated({}), R"({"children":[1]})", R"({"children":[1],"scale":[-2,2,2]})"));
    EXPECT_LT(glm::distance(track.samples[0].rotation, glm::dvec4(0, 0, 0, 1)), 1e-12);
    ASSERT_EQ(track.warnings.size(), 2u);
    EXPECT_HAS(track.warnings[1], "a.gltf: the camera is mirrored");
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
    for (const char* uri : {"../secret.bin", "/etc/passwd", "file:///etc/passwd", "a/../../b.bin",
                            "%2e%2e/secret.bin", "%2Fetc/passwd", "a%00.bin"})
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

TEST_F(Gltf, RequiredExtensionsAreThoseThatLeaveCamerasAlone) {
    const auto with = [](const std::string& names) {
        return test::replaced(moving("STEP", {0, 0, 0, 8, 0, 4}), "\"nodes\"",
                              "\"extensionsRequired\":[" + names + "],\"nodes\"");
    };
    EXPECT_TRUE(read(with(R"("KHR_animation_pointer","KHR_materials_unlit","KHR_texture_basisu")")).has_fov);
    const std::string message = refusal("a.gltf", with(R"("KHR_lights_punctual","FOO_bar")"), read_gltf);
    EXPECT_HAS(message, "a.gltf: expected no required extensions but KHR_animation_pointer, ");
    EXPECT_HAS(message, ", found FOO_bar");
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

// USD's cameras: its transforms and lenses in closed form, our own there and back, files as Blender and
// Houdini write them, and what odd files end with.

class Usda : public test::CameraFileTest {
  protected:
    CameraTrack read(const std::string& text, const FrameRate& rate = {}) {
        return read_usda(put("shot.usda", text), rate);
    }
    static std::string camera(const std::string& body, const std::string& head = "") {
        return "#usda 1.0\n(\n" + head + ")\ndef Camera \"cam\"\n{\n" + body + "}\n";
    }
    /// With one operation.
    static std::string moved(const std::string& type, const std::string& op, const std::string& value) {
        return camera(type + " xformOp:" + op + " = " + value +
                      "\nuniform token[] xformOpOrder = [\"xformOp:" + op + "\"]\n");
    }
    glm::dmat3 axes(const std::string& text) {
        return rotation_from_quaternion(read(text).samples.at(0).rotation);
    }
};

TEST_F(Usda, OwnFilesComeBack) {
    CameraTrack track = test::wild_track();
    track.fps = 24.0;
    const CameraTrack back = read(usda_text(track, {1.5, 0.01, 0.0}));
    test::expect_same_way(track, back);
    EXPECT_EQ(back.up, FileUp::y);
    EXPECT_EQ(back.fps, 24.0);
    EXPECT_TRUE(back.warnings.empty());
    track.has_shift = true;
    for (TrackSample& sample : track.samples) sample.shift = {0.01 * sample.frame, -0.25};
    const CameraTrack shifted = read(usda_text(track, {1.5, 0.01, 0.0}));
    EXPECT_TRUE(shifted.has_shift);
    for (std::size_t i = 0; i < track.samples.size(); ++i)
        EXPECT_LT(glm::distance(shifted.samples.at(i).shift, track.samples[i].shift), 1e-9);
    track.projection = Projection::orthographic;
    for (TrackSample& sample : track.samples) sample.height = 3.0 + 0.1 * sample.frame;
    const CameraTrack parallel = read(usda_text(track, {1.5, 0.01, 0.0}));
    EXPECT_TRUE(parallel.orthographic());
    for (std::size_t i = 0; i < track.samples.size(); ++i)
        EXPECT_NEAR(parallel.samples.at(i).height, track.samples[i].height, 1e-9);
}

TEST_F(Usda, TurnsInTheOrderOfTheirNames) {
    // A quarter turn about x, then one about y: the view along -z goes up, and stays there.
    EXPECT_LT(glm::distance(-axes(moved("double3", "rotateXYZ", "(90, 90, 0)"))[2], glm::dvec3(0, 1, 0)),
              1e-12);
    // The other way round it goes to -x, about which x turns nothing.
    EXPECT_LT(glm::distance(-axes(moved("double3", "rotateYXZ", "(90, 90, 0)"))[2], glm::dvec3(-1, 0, 0)),
              1e-12);
    EXPECT_LT(glm::distance(-axes(moved("float", "rotateY", "90"))[2], glm::dvec3(-1, 0, 0)), 1e-12);
    const double h = std::sqrt(0.5);
    EXPECT_LT(glm::distance(-axes(moved("quatf", "orient",
                                        "(" + std::to_string(h) + ", 0, " + std::to_string(h) + ", 0)"))[2],
                            glm::dvec3(-1, 0, 0)),
              1e-6);
    // Rows of a matrix are the axes; the last is the place.
    const CameraTrack track =
        read(moved("matrix4d", "transform", "( (0, 0, -1, 0), (0, 1, 0, 0), (1, 0, 0, 0), (7, 8, 9, 1) )"));
    EXPECT_EQ(track.samples.at(0).eye, glm::dvec3(7, 8, 9));
    EXPECT_LT(glm::distance(rotation_from_quaternion(track.samples[0].rotation)[2], glm::dvec3(1, 0, 0)),
              1e-12);
}

TEST_F(Usda, ParentsPivotsAndResets) {
    const std::string text = R"(#usda 1.0
def Xform "world"
{
    double3 xformOp:translate = (10, 0, 0)
    double3 xformOp:scale = (2, 2, 2)
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"]
    def Xform "arm"
    {
        float3 xformOp:translate:pivot = (1, 0, 0)
        float xformOp:rotateZ = 90
        uniform token[] xformOpOrder = ["xformOp:translate:pivot", "xformOp:rotateZ", "!invert!xformOp:translate:pivot"]
        def Camera "cam"
        {
            double3 xformOp:translate = (3, 0, 0)
            uniform token[] xformOpOrder = [ORDER"xformOp:translate"]
        }
    }
}
)";
    const auto with = [&](const std::string& order) {
        std::string changed = text;
        return changed.replace(changed.find("ORDER"), 5, order);
    };
    // (3, 0, 0) about (1, 0, 0) by a quarter turn is (1, 2, 0); twice that and 10 to the right.
    EXPECT_LT(glm::distance(read(with("")).samples.at(0).eye, glm::dvec3(12, 4, 0)), 1e-12);
    EXPECT_EQ(read(with("\"!resetXformStack!\", ")).samples.at(0).eye, glm::dvec3(3, 0, 0));
}

TEST_F(Usda, SamplesAreLinearAndHeldOutside) {
    const CameraTrack track = read(camera(R"(
        float verticalAperture = 24
        float focalLength.timeSamples = { 2: 12, 6: 24, }
        double3 xformOp:translate.timeSamples = { 4: (0, 0, 0), 0: (8, 0, 0), 5: None }
        uniform token[] xformOpOrder = ["xformOp:translate"]
)"));
    ASSERT_EQ(track.samples.size(), 7u);  // 0 to 6
    EXPECT_EQ(track.samples[1].eye, glm::dvec3(6, 0, 0));
    EXPECT_EQ(track.samples[6].eye, glm::dvec3(0, 0, 0));
    EXPECT_NEAR(track.samples[0].fov_deg, 90.0, 1e-12);
    EXPECT_NEAR(track.samples[4].fov_deg, 2.0 * std::atan(12.0 / 18.0) * 180.0 / 3.14159265358979324, 1e-9);
    EXPECT_EQ(track.samples[4].frame, 4.0);
}

// USD interpolates quaternions along the arc: 40 degrees are a quarter of 160.
TEST_F(Usda, TurnsGoAtEvenSpeed) {
    const CameraTrack track = read(camera(R"(
        quatf xformOp:orient.timeSamples = { 0: (1, 0, 0, 0), 4: (-0.17364818, 0, -0.98480775, 0) }
        uniform token[] xformOpOrder = ["xformOp:orient"]
)"));
    EXPECT_NEAR(track.samples.at(1).rotation.y, 0.3420201433, 1e-7);
    EXPECT_NEAR(track.samples.at(1).rotation.w, 0.9396926208, 1e-7);
}

TEST_F(Usda, CurvesAndConnectionsAreSaid) {
    const CameraTrack track =
        read(camera("float focalLength.spline = { bezier, 1: 30; pre (0, 0) }\n"
                    "float verticalAperture.connect = </rig.a>\n"));
    ASSERT_EQ(track.warnings.size(), 1u);
    EXPECT_HAS(track.warnings[0], "focalLength.spline, verticalAperture.connect of 'cam' are not followed");
}

TEST_F(Usda, SamplesThatAreNoneAreSaid) {
    const CameraTrack track = read(camera(R"(
        double3 xformOp:translate.timeSamples = { 0: (0, 0, 0), 1: None, 2: (2, 0, 0) }
        uniform token[] xformOpOrder = ["xformOp:translate"]
        float focalLength.timeSamples = { 0: 50, 2: None }
)"));
    ASSERT_EQ(track.warnings.size(), 1u);
    EXPECT_HAS(track.warnings[0], "shot.usda: None in xformOp:translate.timeSamples, None in focalLength");
}

// UsdGeomCamera: focalLength 50, apertures 20.955 x 15.2908, offsets as parts of the apertures.
TEST_F(Usda, LensesAreThoseOfTheSchemaWhereTheFileSaysNone) {
    const CameraTrack none = read(camera(""));
    EXPECT_TRUE(none.has_fov);
    EXPECT_NEAR(none.samples.at(0).fov_deg, 2.0 * std::atan(0.152908) * 180.0 / 3.14159265358979324, 1e-9);
    EXPECT_FALSE(none.has_shift);
    const std::string film =
        "float horizontalAperture = 36\nfloat verticalAperture = 20\n"
        "float horizontalApertureOffset = 9\nfloat verticalApertureOffset = -4\n";
    const CameraTrack shifted = read(camera(film));
    EXPECT_TRUE(shifted.has_shift);
    EXPECT_LT(glm::distance(shifted.samples.at(0).shift, glm::dvec2(0.45, -0.2)), 1e-12) << "in heights";
    const CameraTrack flat = read(camera(film + "token projection = \"orthographic\"\n"));
    EXPECT_FALSE(flat.has_shift);
    EXPECT_LT(glm::distance(flat.samples.at(0).eye, glm::dvec3(0.9, -0.4, 0.0)), 1e-12) << "a step aside";
    EXPECT_EQ(refusal("shot.usda", camera("float verticalApertureOffset = inf\n"), read_usda),
              "shot.usda: expected a finite verticalApertureOffset at time code 0, found inf");
}

TEST_F(Usda, AMirroredParentKeepsTheCameraUpright) {
    const CameraTrack track = read(moved("float3", "scale", "(-1, 1, 1)"));
    EXPECT_LT(glm::distance(track.samples.at(0).rotation, glm::dvec4(0, 0, 0, 1)), 1e-12);
    ASSERT_EQ(track.warnings.size(), 1u);
    EXPECT_HAS(track.warnings[0], "shot.usda: the camera is mirrored");
}

TEST_F(Usda, WhatIsNotFollowedIsSaidInOneLine) {
    const CameraTrack track =
        read(camera("float fStop = 2.8\nfloat focusDistance.timeSamples = { 0: 1, 9: 2 }\n"
                    "double shutter:open = -0.25\nuniform token stereoRole = \"left\"\n"
                    "matrix4d xformOp:transform = ( (1, 0, 0, 0), (0.5, 1, 0, 0), "
                    "(0, 0, 1, 0), (0, 0, 0, 1) )\n"
                    "uniform token[] xformOpOrder = [\"xformOp:transform\"]\n",
                    "subLayers = [@a.usd@]\n"));
    EXPECT_EQ(track.samples.size(), 1u) << "what is not followed moves nothing";
    ASSERT_EQ(track.warnings.size(), 2u);
    EXPECT_HAS(track.warnings[0], "shot.usda: the camera is sheared, which no frame is");
    EXPECT_HAS(track.warnings[1],
               "shot.usda: subLayers, fStop, focusDistance, shutter:open, stereoRole of 'cam' "
               "are not followed");
    const CameraTrack usual = read(camera("float fStop = 0\ntoken stereoRole = \"mono\"\n"));
    EXPECT_TRUE(usual.warnings.empty()) << "as the schema has them";
}

TEST_F(Usda, TheSelectedVariantIsReadAndIsWeakerThanThePrim) {
    const auto rig = [](const std::string& head) {
        return "#usda 1.0\ndef Xform \"rig\" (" + head + R"()
{
    variantSet "lens" = {
        "wide" ( doc = "x" ) {
            over "cam" { float focalLength = 20
                         float verticalAperture.timeSamples = { 0: 99, 1: 98 } }
            variantSet "place" = { "far" { def Camera "far" { } } "near" { } }
        }
        "long" { over "cam" { float focalLength = 100 } }
    }
    variantSet "which" = { "a" { def Camera "a" { } } "b" { } }
    def Camera "cam" { float verticalAperture = 20 }
}
)";
    };
    const auto fov = [&](const std::string& head) { return read(rig(head)).samples.at(0).fov_deg; };
    const auto expected = [](double focal) {
        return 2.0 * std::atan(10.0 / focal) * 180.0 / 3.14159265358979324;
    };
    EXPECT_NEAR(fov("variants = { string lens = \"long\" }"), expected(100), 1e-9);
    EXPECT_NEAR(fov("variants = { string lens = \"none\" }"), expected(50), 1e-9);
    EXPECT_NEAR(fov("prepend variantSets = \"lens\""), expected(50), 1e-9);
    const CameraTrack wide =
        read(rig("variants = {\n string lens = \"wide\"\n string place = \"far\" string which = \"b\" }"));
    ASSERT_EQ(wide.samples.size(), 1u) << "the prim's own aperture stands still";
    EXPECT_NEAR(wide.samples[0].fov_deg, expected(20), 1e-9);
    ASSERT_EQ(wide.warnings.size(), 1u);
    EXPECT_HAS(wide.warnings[0], "of 2 cameras 'cam' is read");
    EXPECT_EQ(
        refusal("shot.usda",
                "#usda 1.0\ndef \"r\" { variantSet \"v\" = { \"a\" { def Camera \"c\" { } } } }\n",
                read_usda),
        "shot.usda: expected a camera, found none but what variants may hold of which the file selects none");
}

TEST_F(Usda, TimeCodesBecomeFrames) {
    const std::string body =
        "double3 xformOp:translate.timeSamples = { 0: (0, 0, 0), 4: (4, 0, 0) }\n"
        "uniform token[] xformOpOrder = [\"xformOp:translate\"]\n";
    EXPECT_EQ(read(camera(body, "timeCodesPerSecond = 48\n"), {24.0, 0.0}).samples.back().frame, 2.0);
    EXPECT_EQ(read(camera(body, "timeCodesPerSecond = 48\n"), {24.0, 12.0}).samples.back().frame, 8.0);
    EXPECT_EQ(read(camera(body), {30.0, 0.0}).samples.back().frame, 4.0) << "the file says nothing";
}

// As Blender's exporter and Houdini's write them: comments, metadata, dictionaries, materials and meshes.
TEST_F(Usda, FilesOfOtherProgramsAreRead) {
    const CameraTrack blender = read(R"usd(#usda 1.0
(
    customLayerData = {
        dictionary Blender = {
            string version = "4.2.0 (\"x\")"
}
}
defaultPrim = "root" doc =
    ""
    "Blender v4.2.0
    (unsaved) {"""
    endTimeCode = 3
    metersPerUnit = 1
    startTimeCode = 1
    timeCodesPerSecond = 24
    upAxis = "Z"
)

def Xform "root" (
    customData = { dictionary Blender = { bool generated = 1 } }
)
{
    def Mesh "Cube" (
        active = true
        prepend apiSchemas = ["MaterialBindingAPI"]
    )
    {
        uniform bool doubleSided = 1
        float3[] extent = [(-1, -1, -1), (1, 1, 1)]
        int[] faceVertexCounts = [4, 4]
        rel material:binding = </scene/_materials/Material>
        normal3f[] normals = [(0, 0, 1)] (
            interpolation = "faceVarying"
        )
        token outputs:surface.connect = </scene/x.outputs:surface>
        float noValue
    }

    def Xform "Camera"
    {
        custom string userProperties:blender:object_name = "Camera"
        matrix4d xformOp:transform.timeSamples = {
            1: ( (1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, -7, 1, 1) ),
            2: ( (1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, -6, 1, 1) ),
            3: ( (1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, -5, 1, 1) ),
        }
        uniform token[] xformOpOrder = ["xformOp:transform"]

        def Camera "Camera"
        {
            float2 clippingRange = (0.1, 100)
            float focalLength = 50
            float horizontalAperture = 36
            token projection = "perspective"
            float verticalAperture = 20.25
        }
    }
}
)usd");
    ASSERT_EQ(blender.samples.size(), 3u);
    EXPECT_EQ(blender.up, FileUp::z);
    EXPECT_EQ(blender.samples[2].eye, glm::dvec3(0, -5, 1));
    EXPECT_LT(glm::distance(-rotation_from_quaternion(blender.samples[0].rotation)[2], glm::dvec3(0, 1, 0)),
              1e-12);
    EXPECT_NEAR(blender.samples[0].fov_deg, 22.89519, 1e-4);
    const CameraTrack houdini = read(R"(#usda 1.0
( timeCodesPerSecond = 24
  upAxis = "Y" )
over "elsewhere" { def Camera "no" { } }
def "cameras" ( prepend references = @./base.usda@</cameras> (offset = 1) )
{
    variantSet "look" = {
        "a" { def Camera "inside" { } }
    }
    def Camera "camera1" ( customData = { } )
    {
        float focalLength = 50
        float horizontalAperture = 41.4214
        float2 clippingRange = (1, 1000000)
        asset file = @tex/<UDIM>.exr@
        float3 xformOp:rotateXYZ.timeSamples = { 1: (0, 0, 0), 3: (0, 90, 0) }
        double3 xformOp:translate = (0, 1, 5)
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateXYZ"]
    }
    def Camera "second" { }
}
)");
    ASSERT_EQ(houdini.samples.size(), 3u);
    EXPECT_LT(glm::distance(-rotation_from_quaternion(houdini.samples[1].rotation)[2],
                            glm::dvec3(-std::sqrt(0.5), 0.0, -std::sqrt(0.5))),
              1e-9);
    ASSERT_EQ(houdini.warnings.size(), 3u);
    EXPECT_HAS(houdini.warnings[0], "has no verticalAperture");
    EXPECT_HAS(houdini.warnings[1], "references of 'cameras' are not followed");
    EXPECT_HAS(houdini.warnings[2], "of 2 cameras 'camera1' is read");
}

TEST_F(Usda, OddFilesEndInOneLine) {
    const auto message = [&](const std::string& text) { return refusal("shot.usda", text, read_usda); };
    EXPECT_EQ(message("hello"), "shot.usda:1: expected #usda and a version, found 'hello'");
    EXPECT_EQ(message(std::string("PXR-USDC\0\1", 10)),
              "shot.usda: expected USD as text (usdcat FILE -o FILE.usda makes it), found a binary file");
    EXPECT_EQ(message("#usda 1.0\ndef Xform \"a\"\n{\n}\n"), "shot.usda: expected a camera, found none");
    EXPECT_EQ(message("#usda 1.0\n( subLayers = [@a.usd@] )\n"),
              "shot.usda: expected a camera, found none but what other files may hold, which are not opened");
    EXPECT_EQ(message("#usda 1.0\ndef Camera \"a\"\n{\n"),
              "shot.usda:4: expected '}', found the end of the file");
    EXPECT_EQ(message("#usda 1.0\ndef Camera \"a\n"),
              "shot.usda:3: expected a closing \", found the end of the file");
    EXPECT_EQ(message(camera("float focalLength.timeSamples = { x: 1 }\n")),
              "shot.usda:6: expected a time code, found 'x: 1 }'");
    EXPECT_EQ(message(moved("double3", "shear", "(1, 2, 3)")),
              "shot.usda: expected a transform operation of USD in 'cam', found 'xformOp:shear'");
    EXPECT_EQ(message(moved("double3", "translate", "(1, 2)")),
              "shot.usda: expected 3 finite numbers as xformOp:translate of 'cam', found 2");
    EXPECT_EQ(message(moved("double3", "scale", "(0, 0, 0)")),
              "shot.usda: expected a place and axes of 'cam' at time code 0, found none");
    EXPECT_EQ(message(camera("float focalLength = 0\n")),
              "shot.usda: expected focalLength above 0 at time code 0, found 0");
    EXPECT_EQ(message(camera("float focalLength.timeSamples = { 0: 1, 1e9: 2 }\n")),
              "shot.usda: expected at most 6000000 frames, near 0, found time codes from 0 to 1e+09");
    EXPECT_NE(message(camera("int[] a = " + std::string(100, '[') + "\n")).find("at most 64 brackets"),
              std::string::npos);
}

}  // namespace
}  // namespace astrosplat
