// Gaussians of captures in PLY, glTF and USD text.

#include "core/color.h"
#include "core/log.h"
#include "core/rotation.h"
#include "splat_files/gaussian_rows.h"
#include "splat_files/native.h"
#include "splat_files/splat_file.h"
#include "support/capture.h"
#include "unit/splat_files/file_support.h"

namespace astrosplat {
namespace {

using namespace astrosplat::test;

// Gaussians of captures: 3D Gaussian Splatting's PLY and glTF's KHR_gaussian_splatting, built byte by byte,
// and one test for each error.

class GaussianFiles : public SplatFileTest {
  protected:
    SplatSet read(const std::string& bytes, const char* name = "a.ply") {
        return read_splats(write(name, bytes));
    }
    std::string error(const std::string& bytes, const char* name = "a.ply") {
        return error_of(write(name, bytes), [](const auto& file) { read_splats(file); });
    }
    std::string error_glb(const std::string& bytes) { return error(bytes, "a.glb"); }
    std::string error_usda(const std::string& bytes) { return error(bytes, "a.usda"); }
};

const std::vector<std::string> columns = {"position", "color",    "alpha",    "radius",
                                          "scale",    "rotation", "harmonics"};

void expect_near(const SplatSet& set, const std::vector<Trained>& all, int degree) {
    ASSERT_EQ(set.size(), std::int64_t(all.size()));
    EXPECT_NO_THROW(check_consistent(set));
    ASSERT_EQ(set.harmonics.empty(), degree == 0);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Trained& g = all[i];
        EXPECT_EQ(set.id[i], i);
        EXPECT_NEAR(set.alpha[i], g.opacity, 1e-6);
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(set.position[i][k], g.position[k], 1e-6);
            EXPECT_NEAR(set.scale[i][k] / g.scale[k], 1.0, 1e-6);
            const double color = std::max(0.0, 0.5 + 0.28209479177387814 * g.harmonics[0][k]);
            EXPECT_NEAR(set.color[i][k], real::srgb_to_linear(color), 1e-5);
            for (std::size_t j = 0; j < 16 && degree > 0; ++j)
                EXPECT_NEAR(set.harmonics[i].c[j][k], g.harmonics[j][k], 1e-6) << j;
        }
        EXPECT_NEAR(std::fabs(glm::dot(glm::dvec4(set.rotation[i]), g.rotation)), 1.0, 1e-6);
    }
}

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
    EXPECT_EQ(splat_attributes(path("a.ply")), columns);
}

/// One Gaussian as text: some properties before those that all have, with their values.
std::string one_gaussian(const std::string& properties, const std::string& values) {
    std::string text = "ply\ncomment made by hand\n\nformat ascii 1.0\nelement vertex 1\n";
    std::istringstream types(properties);
    for (std::string type, name; types >> type >> name;) text += "property " + type + " " + name + "\n";
    for (const char* name :
         {"x", "y", "z", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
        text += std::string("property float ") + name + "\n";
    return text + "end_header\n" + values + " 1 2 3 0 0 -1 1 1 0 0 0\n";
}

// nerfstudio's ns-export --ply-color-mode rgb, and others that write colours.
TEST_F(GaussianFiles, PlyWithColoursInsteadOfHarmonics) {
    for (const auto& [type, values] : std::vector<std::pair<std::string, std::string>>{
             {"uchar", "255 51 0"}, {"ushort", "65535 13107 0"}, {"float", "1 0.2 0"}}) {
        SCOPED_TRACE(type);
        const SplatSet set = read(one_gaussian(type + " red " + type + " green " + type + " blue", values));
        ASSERT_EQ(set.size(), 1);
        EXPECT_NEAR(set.color[0].x, 1.0, 1e-6);
        EXPECT_NEAR(set.color[0].y, real::srgb_to_linear(0.2), 1e-6);
        EXPECT_NEAR(set.color[0].z, 0.0, 1e-6);
        EXPECT_EQ(set.alpha[0], 0.5f);
        EXPECT_NEAR(set.scale[0].y, std::exp(-1.0), 1e-7);
        EXPECT_TRUE(set.harmonics.empty());
        std::vector<std::string> without = columns;
        without.pop_back();
        EXPECT_EQ(splat_attributes(path("a.ply")), without);
    }
    EXPECT_HAS(error(one_gaussian("", "")), "rot_0 to 3, found no f_dc_0");
    EXPECT_HAS(error(one_gaussian("uchar red uchar green", "1 2")), "rot_0 to 3, found no f_dc_0");
}

// scale'^2 = scale^2 + filter^2; opacity' = opacity sqrt(det / det').
TEST_F(GaussianFiles, PlyOfMipSplattingIsWidened) {
    const std::string dc = "float f_dc_0 float f_dc_1 float f_dc_2 float filter_3D";
    const SplatSet set = read(one_gaussian(dc, "0 0 0 0.75"));
    ASSERT_EQ(set.size(), 1);
    double kept = 1.0;
    for (int k = 0; k < 3; ++k) {
        const double own = std::exp(std::array{0.0, -1.0, 1.0}[std::size_t(k)]), wide = std::hypot(own, 0.75);
        EXPECT_NEAR(set.scale[0][k], wide, 1e-6) << k;
        kept *= own / wide;
    }
    EXPECT_NEAR(set.alpha[0], 0.5 * kept, 1e-6);
    EXPECT_EQ(set.radius[0], gaussian_radius(set.scale[0]));
    const SplatSet same = read(one_gaussian(dc, "0 0 0 0"));
    EXPECT_NEAR(same.scale[0].y, std::exp(-1.0), 1e-7);
    EXPECT_EQ(same.alpha[0], 0.5f);
}

TEST_F(GaussianFiles, PlyWithoutSplatsIsTold) {
    const Said said;
    const std::string text = replaced(one_gaussian("", ""), "vertex 1", "vertex 0");
    read(text.substr(0, text.find("end_header")) +
         "property float f_dc_0\nproperty float f_dc_1\nproperty "
         "float f_dc_2\nend_header\n");
    EXPECT_HAS(said.one_warning(), "a.ply: holds no splats");
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
    const Said said;
    const SplatSet set = read(text);
    EXPECT_HAS(said.one_warning(), "a.ply: its red, other, label are not followed");
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
    const Said said;
    const SplatSet set = read(ply_of(all, 1));
    EXPECT_HAS(said.text(),
               "3 of 6 Gaussians have numbers that are not finite and are left out, the first "
               "is number 1");
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
}

TEST_F(GaussianFiles, GlbOfEveryDegree) {
    for (const int degree : {0, 1, 2, 3}) {
        const std::vector<Trained> all = capture(20, degree);
        expect_near(read(glb_of(all, degree), "a.glb"), all, degree);
    }
    EXPECT_EQ(splat_attributes(path("a.glb")), columns);
    EXPECT_TRUE(may_hold_splats(path("a.glb")));
    EXPECT_FALSE(may_hold_splats(write("b.gltf", "{}")));
    const SplatSet linear = read(glb_of(capture(3, 0), 0, "", "lin_rec709_display"), "a.glb");
    EXPECT_FALSE(linear.display_harmonics);
    EXPECT_NEAR(linear.color[0].x, std::max(0.0, 0.5 + 0.28209479177387814 * capture(1, 0)[0].harmonics[0].x),
                1e-6);
}

TEST_F(GaussianFiles, WrongGlb) {
    const std::string good = glb_of(capture(2, 1), 1);
    const auto json_error = [&](const std::string& from, const std::string& to) {
        return error_glb(replaced_json(good, from, to));
    };
    EXPECT_EQ(error_glb("glTF"), "a.glb: expected glTF 2.0, JSON or binary, found something else");
    EXPECT_EQ(json_error("\"ellipse\"", "\"box\""), "a.glb: expected the kernel ellipse, found 'box'");
    EXPECT_EQ(json_error("srgb_rec709_display", "acescg"),
              "a.glb: expected the colorSpace srgb_rec709_display or lin_rec709_display, found 'acescg'");
    EXPECT_EQ(json_error("splatting:SCALE", "splatting:SIZE"),
              "a.glb: expected an attribute KHR_gaussian_splatting:SCALE, found none");
    EXPECT_EQ(json_error("SH_DEGREE_1_COEF_1", "SH_DEGREE_2_COEF_1"),
              "a.glb: expected all coefficients up to degree 1, found some of them");
    EXPECT_EQ(json_error("\"VEC4\"", "\"VEC3\""),
              "a.glb: expected KHR_gaussian_splatting:ROTATION as VEC4, found 'VEC3'");
    EXPECT_EQ(json_error("\"extensions\"", "\"extras\""),
              "a.glb: expected Gaussians (KHR_gaussian_splatting) in a node of its scene, found none");
    EXPECT_EQ(
        json_error("\"kernel\":\"ellipse\"",
                   "\"extensions\":{\"KHR_gaussian_splatting_compression_spz_2\":{}}"),
        "a.glb: expected Gaussians that are not compressed, found KHR_gaussian_splatting_compression_spz_2");
    EXPECT_EQ(error_glb(glb_of(capture(2, 0), 0, R"(,"scale":[1,2,1])")),
              "a.glb: expected nodes that scale Gaussians alike along all axes, found others");
    EXPECT_EQ(error_glb(glb_of(capture(2, 0), 0, R"(,"children":[0])")),
              "a.glb: expected nodes that are trees, found node 0 twice");
    EXPECT_EQ(error_glb(glb_of(capture(2, 0), 0, R"(,"rotation":["a",0,0,1])")).substr(0, 51),
              "a.glb: expected glTF as its specification says, fou");
    EXPECT_EQ(
        json_error("{\"asset\"", "{\"extensionsRequired\":[\"EXT_meshopt_compression\"],\"asset\""),
        "a.glb: expected no required extensions but KHR_gaussian_splatting, KHR_mesh_quantization, found "
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
    const Said said;
    write_splats(path("b.pda"), set);
    EXPECT_HAS(said.text(), "they become round; .splats keeps them");
    EXPECT_EQ(error_of(path("b.glb"), [&](const auto& file) { write_splats(file, set); }),
              "b.glb: expected one of the endings " + known_endings(FileUse::written) + ", found .glb");
}

// Gaussians of USD as text, ParticleField3DGaussianSplat: as we, the schema and others write them, and one
// test for each error. What glTF's nodes and USD's prims do with them is one test.

TEST_F(GaussianFiles, UsdaOfEveryDegree) {
    for (const int degree : {0, 1, 2, 3}) {
        const std::vector<Trained> all = capture(20, degree);
        const SplatSet set = read(usda_of(all, degree), "a.usda");
        expect_near(set, all, degree);
        EXPECT_TRUE(set.display_harmonics);
        // Without a degree it is what there are numbers for.
        expect_near(read(replaced(usda_of(all, degree), "HarmonicsDegree", "HarmonicsRank"), "a.usda"), all,
                    degree);
    }
    EXPECT_EQ(splat_attributes(path("a.usda")), columns);
    EXPECT_EQ(splat_count(path("a.usda")), 20);
    EXPECT_TRUE(may_hold_splats(path("a.usda")));
    EXPECT_FALSE(may_hold_splats(write("b.usda", "#usda 1.0\ndef Camera \"shot\"\n{\n}\n")));
}

// Halves, what the schema says of lists that are not there, z up, and two prims after each other.
TEST_F(GaussianFiles, UsdaAsOthersWriteIt) {
    const Said said;
    const SplatSet set = read(R"(#usda 1.0
(
    upAxis = "Z"
)
def ParticleField3DGaussianSplat "A"
{
    point3h[] positionsh = [(1, 2, 3)]
    point3f[] positions.timeSamples = {
        1: [(7, 7, 7)],
    }
}
class ParticleField3DGaussianSplat "no"
{
}
def Scope "B" ( references = @more.usda@ )
{
    def ParticleField3DGaussianSplat "C"
    {
        double3 xformOp:translate.timeSamples = { 1: (0, 0, 10), 2: (0, 0, 20) }
        uniform token[] xformOpOrder = ["xformOp:translate"]
        point3f[] positions = [(4, 5, 6), (0, 0, 0)]
        half[] opacitiesh = [0.25, 0.5, 0.75]
        float3[] radiance:sphericalHarmonicsCoefficients = [(1, 0, 0), (0, 1, 0)]
    }
}
)",
                              "a.usda");
    ASSERT_EQ(said.warnings.size(), 3u);
    EXPECT_HAS(said.warnings[0], "a.usda: positions.timeSamples of 'A' are not followed");
    EXPECT_HAS(said.warnings[1], "a.usda: references of 'B' are not followed");
    EXPECT_HAS(said.warnings[2], "a.usda: the motion of 'C' is not followed: it stands as at time code 0");
    ASSERT_EQ(set.size(), 3);
    EXPECT_EQ(set.position[0], glm::vec3(1.0f, 3.0f, -2.0f));
    EXPECT_EQ(set.position[1], glm::vec3(4.0f, 16.0f, -5.0f));
    EXPECT_EQ(set.alpha[0], 1.0f);
    EXPECT_EQ(set.alpha[2], 0.5f);
    EXPECT_NEAR(set.color[0].y, real::srgb_to_linear(0.5), 1e-6);
    EXPECT_NEAR(set.color[1].x, real::srgb_to_linear(0.5 + 0.28209479177387814), 1e-6);
    EXPECT_NEAR(set.color[2].x, real::srgb_to_linear(0.5), 1e-6);
    EXPECT_EQ(set.scale[2], glm::vec3(1.0f));
}

// UsdGeomImageable: what is invisible hides all below it.
TEST_F(GaussianFiles, UsdaThatIsInvisibleIsNotShown) {
    const auto usda = [](const std::string& above, const std::string& own) {
        return "#usda 1.0\ndef Xform \"up\"\n{\n" + above + "\ndef ParticleField3DGaussianSplat \"A\"\n{\n" +
               own + "\npoint3f[] positions = [(1, 2, 3)]\n}\n}\n" +
               "def ParticleField3DGaussianSplat \"B\"\n{\npoint3f[] positions = [(4, 5, 6)]\n" +
               "token visibility = \"inherited\"\n}\n";
    };
    const std::string hidden = "token visibility = \"invisible\"";
    {
        const Said said;
        EXPECT_EQ(read(usda("", ""), "a.usda").size(), 2);
        for (const std::string& text : {usda(hidden, ""), usda("", hidden)}) {
            const SplatSet set = read(text, "a.usda");
            ASSERT_EQ(set.size(), 1);
            EXPECT_EQ(set.position[0], glm::vec3(4, 5, 6));
        }
        EXPECT_TRUE(said.warnings.empty());
    }
    EXPECT_EQ(error_usda(replaced(usda(hidden, ""), "inherited", "invisible")),
              "a.usda: expected visible Gaussians (ParticleField3DGaussianSplat), found none");
    const Said said;
    EXPECT_EQ(read(usda("", "token visibility.timeSamples = { 1: \"invisible\" }"), "a.usda").size(), 2);
    EXPECT_HAS(said.one_warning(), "a.usda: visibility.timeSamples of 'A' are not followed");
}

TEST_F(GaussianFiles, WrongUsda) {
    const std::string good = usda_of(capture(2, 1), 1);
    EXPECT_EQ(error_usda("#usda 1.0\ndef Xform \"World\"\n{\n}\n"),
              "a.usda: expected visible Gaussians (ParticleField3DGaussianSplat), found none");
    EXPECT_EQ(error_usda("PXR-USDC\1"),
              "a.usda: expected USD as text (usdcat FILE -o FILE.usda makes it), found a binary file");
    EXPECT_EQ(
        error_usda(replaced(good, "positions =", "positions.timeSamples = {0: [(1, 2, 3)]}\nint[] other =")),
        "a.usda: expected positions of 'Splats' (no time samples), found none");
    EXPECT_EQ(error_usda(replaced(good, "Degree = 1", "Degree = 4")),
              "a.usda:27: expected harmonics of degree 0 to 3, found 4");
    EXPECT_EQ(error_usda(replaced(good, "Degree = 1", "Degree = 2")),
              "a.usda:27: expected 9 harmonics of each of 2 Gaussians, found 8");
    EXPECT_EQ(error_usda(replaced(good, "opacities = [ # by rows\n", "opacities = [ #")),
              "a.usda:22: expected 2 of opacities, found 1");
    EXPECT_EQ(error_usda(replaced(good, "opacities = [ # by rows\n", "opacities = [ many")).substr(0, 39),
              "a.usda:22: expected a number, found 'ma");
    EXPECT_EQ(error_usda(replaced(good, "positions = [ # by rows\n", "positions = [ 1")),
              "a.usda:10: expected tuples of 3 numbers, found 7 numbers");
    EXPECT_EQ(error_usda(good.substr(0, good.find("scales") + 20)),
              "a.usda:14: expected ']', found the end of the file");
    EXPECT_EQ(
        error_usda(usda_of(
            capture(2, 0), 0,
            "float3 xformOp:scale = (1, 2, 1)\nuniform token[] xformOpOrder = [\"xformOp:scale\"]\n")),
        "a.usda: expected prims that scale Gaussians alike along all axes, found others above 'Splats'");
}

// A node's turn moves places, shapes and colours together; mirrors too.
TEST_F(GaussianFiles, NodesPlaceTheirGaussians) {
    const std::vector<Trained> all = capture(12, 3);
    const glm::dmat3 turn = rotation_from_degrees({30.0, -50.0, 200.0});
    for (const auto& [usd, sign] :
         {std::pair{false, 1.0}, std::pair{false, -1.0}, std::pair{true, 1.0}, std::pair{true, -1.0}}) {
        std::string matrix;
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) {
                const double value = column == 3 ? (row == 3 ? 1.0 : row + 4.0)
                                     : row == 3  ? 0.0
                                                 : 2.0 * turn[column][row] * (column == 0 ? sign : 1.0);
                matrix += fmt::format("{}{}", matrix.empty() ? "" : ",", value);
            }
        const SplatSet set =
            usd ? read(usda_of(all, 3,
                               "matrix4d xformOp:transform = (" + matrix +
                                   ")\nuniform token[] xformOpOrder = [\"xformOp:transform\"]\n"),
                       "a.usda")
                : read(glb_of(all, 3, R"(,"matrix":[)" + matrix + "]"), "a.glb");
        const glm::dmat3 whole(sign * turn[0], turn[1], turn[2]);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const glm::dvec3 p = 2.0 * (whole * all[i].position) + glm::dvec3(4.0, 5.0, 6.0);
            EXPECT_LT(glm::distance(glm::dvec3(set.position[i]), p), 1e-5);
            // The covariance, entry by entry.
            const auto spread = [](const glm::dmat3& axes, const glm::dvec3& scale, int a, int b) {
                double sum = 0.0;
                for (int k = 0; k < 3; ++k) sum += axes[k][a] * axes[k][b] * scale[k] * scale[k];
                return sum;
            };
            const glm::dmat3 wanted = whole * matrix_of_quaternion(all[i].rotation),
                             found = matrix_of_quaternion(glm::dvec4(set.rotation[i]));
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b)
                    EXPECT_NEAR(spread(found, glm::dvec3(set.scale[i]), a, b),
                                4.0 * spread(wanted, all[i].scale, a, b), 1e-5);
            // Seen from the turned direction the colour is that of the file from the first.
            Harmonics own;
            for (std::size_t j = 0; j < 16; ++j) own.c[j] = glm::vec3(all[i].harmonics[j]);
            const glm::vec3 d = glm::normalize(glm::vec3(0.3f, -0.7f, 0.2f + float(i)));
            const glm::vec3 then = color_towards(own, d),
                            now = color_towards(set.harmonics[i], glm::vec3(whole * glm::dvec3(d)));
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(now[k], then[k], 1e-5);
        }
    }
}

}  // namespace
}  // namespace astrosplat
