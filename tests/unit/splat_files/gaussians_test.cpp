// Gaussians of captures: 3D Gaussian Splatting's PLY and glTF's KHR_gaussian_splatting, built byte by byte,
// and one test for each error.
#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/log.h"
#include "splat_files/formats.h"
#include "splat_files/gaussian_rows.h"
#include "splat_files/native.h"
#include "unit/splat_files/gaussian_files.h"

namespace astrosplat {
namespace {

using namespace astrosplat::test;

/// As `replaced`, in the JSON of a .glb, whose length changes with it.
std::string replaced_json(const std::string& glb, const std::string& from, const std::string& to) {
    const std::size_t binary = glb.find(std::string("BIN\0", 4)) - 4;
    std::string json = replaced(glb.substr(20, binary - 20), from, to);
    while (json.size() % 4) json += ' ';
    return "glTF" + little_endian(2) + little_endian(20 + json.size() + glb.size() - binary) +
           little_endian(json.size()) + "JSON" + json + glb.substr(binary);
}

TEST_F(GaussianFiles, PlyOfEveryDegree) {
    for (const int degree : {0, 1, 2, 3}) {
        const std::vector<Trained> all = capture(20, degree);
        const SplatSet set = read(ply_of(all, degree));
        expect_near(set, all, degree);
        EXPECT_TRUE(set.display_harmonics);
    }
    EXPECT_EQ(
        splat_attributes(path("a.ply")),
        (std::vector<std::string>{"position", "color", "alpha", "radius", "scale", "rotation", "harmonics"}));
}

TEST_F(GaussianFiles, PlyInAnyOrderAsTextAndWithStrangers) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float rot_3\nproperty float rot_2\nproperty float "
        "rot_1\n"
        "property float rot_0\nproperty uchar red\nproperty float scale_2\nproperty double scale_1\n"
        "property float scale_0\nproperty float opacity\n";
    for (int i = 8; i >= 0; --i) text += fmt::format("property float f_rest_{}\n", i);
    text +=
        "property float f_dc_2\nproperty float f_dc_1\nproperty float f_dc_0\nproperty list uchar int other\n"
        "property float z\nproperty float y\nproperty float x\nproperty int label\nend_header\n"
        "0 0 2 2 255 0.5 -1 -2 0 9 8 7 6 5 4 3 2 1 0.3 0.2 0.1 2 7 7 3 2 1 42\n";
    const SplatSet set = read(text);
    ASSERT_EQ(set.size(), 1);
    EXPECT_EQ(set.position[0], glm::vec3(1.0f, 2.0f, 3.0f));
    EXPECT_EQ(set.alpha[0], 0.5f);
    EXPECT_NEAR(set.scale[0].x, std::exp(-2.0), 1e-7);
    EXPECT_NEAR(set.scale[0].z, std::exp(0.5), 1e-6);
    EXPECT_NEAR(set.rotation[0].x, std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(set.rotation[0].w, std::sqrt(0.5), 1e-6);
    EXPECT_EQ(set.harmonics[0].c[0], glm::vec3(0.1f, 0.2f, 0.3f));
    // Three of red, then of green, then of blue; f_rest_0 is 1.
    EXPECT_EQ(set.harmonics[0].c[1], glm::vec3(1.0f, 4.0f, 7.0f));
    EXPECT_EQ(set.harmonics[0].c[3], glm::vec3(3.0f, 6.0f, 9.0f));
    EXPECT_EQ(set.harmonics[0].c[4], glm::vec3(0.0f));
}

TEST_F(GaussianFiles, RadiusIsThatOfTheShadow) {
    EXPECT_FLOAT_EQ(gaussian_radius({2.0f, 2.0f, 2.0f}), 6.0f);
    EXPECT_FLOAT_EQ(gaussian_radius({1.0f, 1.0f, 0.0f}), 3.0f * std::pow(3.0f, -0.25f));
    EXPECT_EQ(gaussian_radius({1.0f, 0.0f, 0.0f}), 0.0f);
}

TEST_F(GaussianFiles, NumbersThatAreNotFiniteAreLeftOut) {
    std::vector<Trained> all = capture(6, 1);
    all[1].position.y = std::numeric_limits<double>::quiet_NaN();
    all[2].harmonics[2].x = std::numeric_limits<double>::infinity();
    all[3].rotation = glm::dvec4(0.0);
    all[4].opacity = 1.0;  // a logit of infinity is an opacity of 1
    std::string said;
    set_log_sink([&](LogLevel, const std::string& line) { said += line; });
    const SplatSet set = read(ply_of(all, 1));
    set_log_sink(nullptr);
    EXPECT_NE(
        said.find(
            "3 of 6 Gaussians have numbers that are not finite and are left out, the first is number 1"),
        std::string::npos)
        << said;
    ASSERT_EQ(set.size(), 3);
    EXPECT_EQ(set.id[1], 4u);
    EXPECT_EQ(set.alpha[1], 1.0f);
    EXPECT_EQ(set.radius.size(), 3u);
}

TEST_F(GaussianFiles, WrongPly) {
    const std::string good = ply_of(capture(2, 1), 1);
    EXPECT_EQ(
        error(replaced(good, "rot_2", "rat_2")),
        "a.ply: expected Gaussians with x y z, f_dc_0 to 2, opacity, scale_0 to 2 and rot_0 to 3, found no "
        "rot_2");
    EXPECT_EQ(error(replaced(good, "f_rest_8", "g_rest_8")),
              "a.ply: expected 0, 9, 24 or 45 properties f_rest_*, found 8");
    EXPECT_EQ(error(replaced(good, "f_rest_8", "f_rest_9")),
              "a.ply: expected properties f_rest_0 to f_rest_8, found no f_rest_8");
    EXPECT_EQ(error(good.substr(0, good.size() - 1)),
              "a.ply: expected 2 vertex elements, as the header says, found the end of the file");
    EXPECT_EQ(error("ply\nformat ascii 1.0\nelement vertex 0\nproperty uint packed_position\nend_header\n"),
              "a.ply: expected Gaussians that are not compressed, found packed_position and others");
}

TEST_F(GaussianFiles, GlbOfEveryDegree) {
    for (const int degree : {0, 1, 2, 3}) {
        const std::vector<Trained> all = capture(20, degree);
        expect_near(read(glb_of(all, degree), "a.glb"), all, degree);
    }
    EXPECT_EQ(
        splat_attributes(path("a.glb")),
        (std::vector<std::string>{"position", "color", "alpha", "radius", "scale", "rotation", "harmonics"}));
    EXPECT_TRUE(may_hold_splats(path("a.glb")));
    EXPECT_FALSE(may_hold_splats(write("b.gltf", "{}")));
    const SplatSet linear = read(glb_of(capture(3, 0), 0, "", "lin_rec709_display"), "a.glb");
    EXPECT_FALSE(linear.display_harmonics);
    EXPECT_NEAR(linear.color[0].x, std::max(0.0, 0.5 + 0.28209479177387814 * capture(1, 0)[0].harmonics[0].x),
                1e-6);
}

TEST_F(GaussianFiles, WrongGlb) {
    const std::string good = glb_of(capture(2, 1), 1);
    EXPECT_EQ(error_glb("glTF"), "a.glb: expected glTF 2.0, JSON or binary, found something else");
    EXPECT_EQ(error_glb(replaced_json(good, "\"ellipse\"", "\"box\"")),
              "a.glb: expected the kernel ellipse, found 'box'");
    EXPECT_EQ(error_glb(replaced_json(good, "srgb_rec709_display", "acescg")),
              "a.glb: expected the colorSpace srgb_rec709_display or lin_rec709_display, found 'acescg'");
    EXPECT_EQ(error_glb(replaced_json(good, "splatting:SCALE", "splatting:SIZE")),
              "a.glb: expected an attribute KHR_gaussian_splatting:SCALE, found none");
    EXPECT_EQ(error_glb(replaced_json(good, "SH_DEGREE_1_COEF_1", "SH_DEGREE_2_COEF_1")),
              "a.glb: expected all coefficients up to degree 1, found some of them");
    EXPECT_EQ(error_glb(replaced_json(good, "\"VEC4\"", "\"VEC3\"")),
              "a.glb: expected KHR_gaussian_splatting:ROTATION as VEC4, found 'VEC3'");
    EXPECT_EQ(error_glb(replaced_json(good, "\"extensions\"", "\"extras\"")),
              "a.glb: expected Gaussians (KHR_gaussian_splatting) in a node of its scene, found none");
    EXPECT_EQ(
        error_glb(replaced_json(good, "\"kernel\":\"ellipse\"",
                                "\"extensions\":{\"KHR_gaussian_splatting_compression_spz_2\":{}}")),
        "a.glb: expected Gaussians that are not compressed, found KHR_gaussian_splatting_compression_spz_2");
    EXPECT_EQ(error_glb(glb_of(capture(2, 0), 0, R"(,"scale":[1,2,1])")),
              "a.glb: expected nodes that scale Gaussians alike along all axes, found others");
    EXPECT_EQ(error_glb(glb_of(capture(2, 0), 0, R"(,"children":[0])")),
              "a.glb: expected nodes that are trees, found node 0 twice");
    EXPECT_EQ(error_glb(glb_of(capture(2, 0), 0, R"(,"rotation":["a",0,0,1])")).substr(0, 51),
              "a.glb: expected glTF as its specification says, fou");
    EXPECT_EQ(
        error_glb(replaced_json(good, "{\"asset\"",
                                "{\"extensionsRequired\":[\"EXT_meshopt_compression\"],\"asset\"")),
        "a.glb: expected no required extensions but KHR_gaussian_splatting and KHR_mesh_quantization, found "
        "EXT_meshopt_compression");
    EXPECT_EQ(error_glb(good.substr(0, good.size() - 8)).substr(0, 40),
              "a.glb: expected chunks within the file, ");
}

TEST_F(GaussianFiles, NativeFilesKeepAll) {
    const SplatSet set = read(ply_of(capture(300, 2), 2));
    write_native(path("b.splats"), set, {});
    SplatSet got = read_native(path("b.splats"));
    sort_by_id(got);
    expect_same_splats(got, set);
    EXPECT_TRUE(got.display_harmonics);
    EXPECT_EQ(splat_attributes(path("b.splats")),
              (std::vector<std::string>{"position", "color", "alpha", "distance", "radius", "scale",
                                        "rotation", "harmonics", "id"}));
}

TEST_F(GaussianFiles, OthersSayWhatTheyLose) {
    const SplatSet set = read(ply_of(capture(3, 0), 0));
    std::string said;
    set_log_sink([&](LogLevel, const std::string& line) { said += line; });
    write_splats(path("b.pda"), set);
    set_log_sink(nullptr);
    EXPECT_NE(said.find("they become round; .splats keeps them"), std::string::npos) << said;
    EXPECT_EQ(error_of(path("b.glb"), [&](const auto& file) { write_splats(file, set); }),
              "b.glb: expected one of the endings .pda .ply .splats, found .glb");
}

}  // namespace
}  // namespace astrosplat
