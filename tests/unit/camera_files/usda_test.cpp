// USD's cameras: its transforms and lenses in closed form, our own there and back, files as Blender and
// Houdini write them, and what odd files end with.
#include "camera_files/formats.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "camera/camera.h"
#include "support/camera_tracks.h"

namespace astrosplat {
namespace {

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
    track.has_fov = false;
    test::expect_same_way(track, read(usda_text(track, {})));
    track.orthographic = true;
    for (TrackSample& sample : track.samples) sample.height = 3.0 + 0.1 * sample.frame;
    const CameraTrack parallel = read(usda_text(track, {1.5, 0.01, 0.0}));
    EXPECT_TRUE(parallel.orthographic);
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
    ASSERT_EQ(houdini.warnings.size(), 2u);
    EXPECT_NE(houdini.warnings[0].find("has no verticalAperture"), std::string::npos);
    EXPECT_NE(houdini.warnings[1].find("of 2 cameras 'camera1' is read"), std::string::npos);
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
